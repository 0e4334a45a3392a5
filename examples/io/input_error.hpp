// InputError: the one exception for input that cannot be used. Programs catch it in main, print what() and exit with 2.
#ifndef TEXTSLAM_IO_INPUT_ERROR_HPP
#define TEXTSLAM_IO_INPUT_ERROR_HPP

#include <stdexcept>
#include <string>

namespace textslam {

/// Input that is broken: a missing file, a bad number, an image that does not decode.
class InputError : public std::runtime_error {
 public:
  /// what() is "file:line: message", or "file: message" when `line` is 0. Lines count from 1.
  InputError(const std::string& file, int line, const std::string& message)
      : std::runtime_error(file + (line > 0 ? ":" + std::to_string(line) : std::string()) + ": " + message),
        file_(file),
        line_(line > 0 ? line : 0),
        message_(message) {}

  const std::string& file() const noexcept { return file_; }
  int line() const noexcept { return line_; }
  /// The message without file and line.
  const std::string& message() const noexcept { return message_; }

 private:
  std::string file_;
  int line_;
  std::string message_;
};

}  // namespace textslam

#endif  // TEXTSLAM_IO_INPUT_ERROR_HPP
