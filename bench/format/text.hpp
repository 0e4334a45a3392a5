// Numbers as the report prints them.
#ifndef TEXTPLANE_BENCH_FORMAT_TEXT_HPP
#define TEXTPLANE_BENCH_FORMAT_TEXT_HPP

#include <cstdio>
#include <string>

namespace textplane_bench {

inline std::string fixed(double v, int digits) {
  char out[64];
  std::snprintf(out, sizeof out, "%.*f", digits, v);
  return out;
}
/// Three significant digits.
inline std::string short_number(double v) {
  char out[64];
  if (v >= 100) {
    std::snprintf(out, sizeof out, "%.0f", v);
  } else if (v >= 10) {
    std::snprintf(out, sizeof out, "%.1f", v);
  } else {
    std::snprintf(out, sizeof out, v >= 0.01 || v == 0 ? "%.2f" : "%.1e", v);
  }
  return out;
}

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_FORMAT_TEXT_HPP
