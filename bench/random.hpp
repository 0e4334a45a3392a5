// Random numbers that are the same everywhere: the distributions of the standard differ between libraries.
#ifndef TEXTPLANE_BENCH_RANDOM_HPP
#define TEXTPLANE_BENCH_RANDOM_HPP

#include <cmath>
#include <random>

namespace textplane_bench {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) + 0.5) / 4294967296.0;
  }
  /// Of mean 0 and variance 1.
  double normal() {
    const double r = std::sqrt(-2 * std::log(uniform(0, 1))), phi = uniform(0, 6.283185307179586);
    return r * std::cos(phi);
  }
  bool chance(double p) { return uniform(0, 1) < p; }

 private:
  std::mt19937 engine_;
};

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_RANDOM_HPP
