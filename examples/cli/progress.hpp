// Progress: one line on a terminal that is rewritten as frames go by; nothing where standard error is not a terminal.
#ifndef TEXTSLAM_CLI_PROGRESS_HPP
#define TEXTSLAM_CLI_PROGRESS_HPP

#include <string>

namespace textslam {

class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  /// Rewrites the line, at most ten times a second.
  void show(std::size_t done, std::size_t total, const std::string& detail);
  bool on_terminal() const { return terminal_; }

 private:
  std::string what_;
  bool terminal_;
  double start_ms_, last_ms_ = 0;
};

/// `1 text`, `3 texts`.
std::string counted(int count, const std::string& thing);

/// `what 120/240, 45 frames/s, 0:03 left  detail`.
std::string progress_line(const std::string& what, std::size_t done, std::size_t total, double elapsed_ms,
                          const std::string& detail);

}  // namespace textslam

#endif  // TEXTSLAM_CLI_PROGRESS_HPP
