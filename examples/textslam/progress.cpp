#include "textslam/progress.hpp"

#include <unistd.h>

#include <cstdio>

#include "textslam/tracker.hpp"

namespace textslam {

Progress::Progress(std::string what)
    : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) == 1), start_ms_(now_ms()) {}

Progress::~Progress() {
  if (terminal_ && last_ms_ > 0) std::fputc('\n', stderr);
}

void Progress::show(std::size_t done, std::size_t total, const std::string& detail) {
  const double now = now_ms();
  if (!terminal_ || (done < total && now - last_ms_ < 100)) return;
  last_ms_ = now;
  const double rate = 1000 * static_cast<double>(done) / (now - start_ms_ + 1e-3);
  std::fprintf(stderr, "\r%s %zu/%zu, %.0f frames/s  %s\033[K", what_.c_str(), done, total, rate, detail.c_str());
}

}  // namespace textslam
