// Random numbers for tests and benchmarks: the same on every platform for a seed.
#ifndef TEXTPLANE_TEST_SUPPORT_RANDOM_HPP
#define TEXTPLANE_TEST_SUPPORT_RANDOM_HPP

#include <cmath>
#include <cstdint>
#include <random>

#include "textplane/core/se3.hpp"

namespace textplane_test {

/// std::mt19937 with own mappings: the standard's distributions differ between libraries.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) + 0.5) / 4294967296.0;
  }
  /// Standard normal, by Box and Muller.
  double normal() {
    const double r = std::sqrt(-2 * std::log(uniform(0, 1))), phi = uniform(0, 6.283185307179586);
    return r * std::cos(phi);
  }
  int integer(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint32_t>(high - low + 1));
  }
  template <int N>
  Eigen::Matrix<double, N, 1> vector(double scale) {
    Eigen::Matrix<double, N, 1> v;
    for (int i = 0; i < N; ++i) v[i] = uniform(-scale, scale);
    return v;
  }
  textplane::Vector6<double> twist(double translation, double rotation) {
    textplane::Vector6<double> xi;
    xi.head<3>() =
        vector<3>(translation);  // one draw a statement: compilers order the parts of an expression differently
    xi.tail<3>() = vector<3>(rotation);
    return xi;
  }
  textplane::SE3d pose(double translation, double rotation) {
    return textplane::se3_exp<double>(twist(translation, rotation));
  }

 private:
  std::mt19937 engine_;
};

}  // namespace textplane_test

#endif  // TEXTPLANE_TEST_SUPPORT_RANDOM_HPP
