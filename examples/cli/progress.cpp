#include "cli/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "io/clock.hpp"

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
  std::fprintf(stderr, "\r%s\033[K", progress_line(what_, done, total, now - start_ms_, detail).c_str());
}

std::string counted(int count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string progress_line(const std::string& what, std::size_t done, std::size_t total, double elapsed_ms,
                          const std::string& detail) {
  const double seconds = std::max(elapsed_ms, 1e-3) / 1000, count = static_cast<double>(done);
  const double rate = count / seconds;
  const auto left = done > 0 ? std::lround(static_cast<double>(total - done) * seconds / count) : 0;
  char numbers[96];
  std::snprintf(numbers, sizeof numbers, " %zu/%zu, %.*f frames/s, %ld:%02ld left  ", done, total, rate < 10 ? 1 : 0,
                rate, left / 60, left % 60);
  return what + numbers + detail;
}

}  // namespace textslam
