#include "io/output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace textslam {

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw std::runtime_error(path + ": cannot write: " + reason);
}

// 0, or the errno of the step that failed. A full disk may show only when the buffer is flushed or the file closed.
int write_all(const std::string& path, std::string_view bytes) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) return errno;
  int error = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size() || std::fflush(file) != 0) error = errno;
  if (std::fclose(file) != 0 && error == 0) error = errno;
  return error;
}

}  // namespace

void write_file(const std::string& path, std::string_view bytes) {
  const std::string part = path + ".part";
  if (const int error = write_all(part, bytes)) {
    std::remove(part.c_str());
    fail(path, std::strerror(error));
  }
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) {
    std::remove(part.c_str());
    fail(path, error.message());
  }
}

void create_output_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw std::runtime_error(path + ": cannot make the folder: " + error.message());
  if (!std::filesystem::is_directory(path, error))
    throw std::runtime_error(path + ": cannot make the folder: not a folder");
}

}  // namespace textslam
