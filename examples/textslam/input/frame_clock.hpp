// FrameClock: in real time frames come at their time stamps, counted from the first. A late frame is processed at once,
// none is skipped. Else nothing waits.
#ifndef TEXTSLAM_INPUT_FRAME_CLOCK_HPP
#define TEXTSLAM_INPUT_FRAME_CLOCK_HPP

#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include "io/clock.hpp"

namespace textslam {

class FrameClock {
 public:
  explicit FrameClock(bool real_time) : real_time_(real_time) {}

  void wait_for(double timestamp) {
    if (!real_time_) return;
    if (start_ms_ < 0) {
      start_ms_ = now_ms();
      first_ = timestamp;
    }
    due_ms_ = start_ms_ + 1000 * (timestamp - first_);
    const double early = due_ms_ - now_ms();
    if (early > 0) std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(early));
  }
  void done() {
    if (real_time_) latency_ms_.push_back(now_ms() - due_ms_);
  }
  /// Of each frame: from its arrival to its pose.
  std::vector<double> latency_ms() { return std::move(latency_ms_); }

 private:
  bool real_time_;
  double start_ms_ = -1, due_ms_ = 0, first_ = 0;
  std::vector<double> latency_ms_;
};

}  // namespace textslam

#endif  // TEXTSLAM_INPUT_FRAME_CLOCK_HPP
