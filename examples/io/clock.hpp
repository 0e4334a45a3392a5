// A steady clock in milliseconds, for timings.
#ifndef TEXTSLAM_IO_CLOCK_HPP
#define TEXTSLAM_IO_CLOCK_HPP

#include <chrono>

namespace textslam {

inline double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace textslam

#endif  // TEXTSLAM_IO_CLOCK_HPP
