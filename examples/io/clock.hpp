// A steady clock in milliseconds, for timings, and the time of day, for records.
#ifndef TEXTSLAM_IO_CLOCK_HPP
#define TEXTSLAM_IO_CLOCK_HPP

#include <chrono>
#include <ctime>
#include <string>

namespace textslam {

inline double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// "2026-01-31 12:00:00", UTC.
inline std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &parts);
  return text;
}

}  // namespace textslam

#endif  // TEXTSLAM_IO_CLOCK_HPP
