// Questions about paths that have an answer for any path: what cannot be looked at is not there.
#ifndef TEXTSLAM_IO_PATHS_HPP
#define TEXTSLAM_IO_PATHS_HPP

#include <filesystem>

namespace textslam {

inline bool is_there(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

inline bool is_folder(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_directory(path, error);
}

}  // namespace textslam

#endif  // TEXTSLAM_IO_PATHS_HPP
