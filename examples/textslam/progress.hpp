// Progress: one line on a terminal that is rewritten as frames go by; nothing where standard error is not a terminal.
#ifndef TEXTSLAM_PROGRESS_HPP
#define TEXTSLAM_PROGRESS_HPP

#include <string>

namespace textslam {

class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  void show(std::size_t done, std::size_t total, const std::string& detail);

 private:
  std::string what_;
  bool terminal_;
  double start_ms_, last_ms_ = 0;
};

}  // namespace textslam

#endif  // TEXTSLAM_PROGRESS_HPP
