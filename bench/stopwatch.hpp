// Elapsed time, and processor time, which load from outside does not change.
#ifndef TEXTPLANE_BENCH_STOPWATCH_HPP
#define TEXTPLANE_BENCH_STOPWATCH_HPP

#include <chrono>
#include <ctime>

namespace textplane_bench {

class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }
  double cpu_ms() const { return 1e3 * static_cast<double>(std::clock() - cpu_start_) / CLOCKS_PER_SEC; }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::clock_t cpu_start_ = std::clock();
};

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_STOPWATCH_HPP
