// Queries of paths that never fail: a path that cannot be examined does not exist.
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
