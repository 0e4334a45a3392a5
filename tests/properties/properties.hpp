// What the property tests draw their states from: RapidCheck's random source, so that a failure prints the RC_PARAMS
// with which the same states are drawn again.
#ifndef TEXTPLANE_TESTS_PROPERTIES_PROPERTIES_HPP
#define TEXTPLANE_TESTS_PROPERTIES_PROPERTIES_HPP

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cstdint>

#include "textplane/core/se3.hpp"

namespace textplane_test {
namespace tp = textplane;

/// An integer in [low, high]. RapidCheck's own ranges grow with the number of cases; here all of it comes from the
/// first on.
inline int integer(int low, int high) { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high + 1)); }

/// Within [low, high]; now and then a bound, or zero where that is inside, since that is where formulas change
/// branches.
inline double number(double low, double high) {
  switch (integer(0, 23)) {
    case 0: return low;
    case 1: return high;
    case 2: return low <= 0 && high >= 0 ? 0.0 : low;
    default: return low + (high - low) * integer(0, 1 << 30) / static_cast<double>(1 << 30);
  }
}

inline std::uint32_t seed() { return static_cast<std::uint32_t>(integer(0, 1 << 30)); }

template <int N>
Eigen::Matrix<double, N, 1> vector(double size) {
  Eigen::Matrix<double, N, 1> v;
  for (int i = 0; i < N; ++i) v[i] = number(-size, size);
  return v;
}

/// A rotation vector of any direction and of length up to `most`, tiny ones as often as large ones.
inline tp::Vector3<double> rotation_vector(double most) {
  tp::Vector3<double> axis = vector<3>(1);
  if (axis.norm() < 1e-3) axis = {0, 0, 1};
  const double size = integer(0, 1) == 0 ? number(0, most) : most * std::pow(10.0, number(-12, 0));
  return size * axis.normalized();
}

inline tp::SE3d pose(double translation, double rotation) {
  tp::SE3d T;
  T.R = tp::so3_exp<double>(rotation_vector(rotation));
  T.t = vector<3>(translation);
  return T;
}

/// A plane at least `nearest` in front of the host camera, and seen from it under no worse than some 70 degrees.
inline tp::Vector3<double> plane(double nearest, double farthest) {
  const tp::Vector3<double> normal(number(-1.8, 1.8), number(-1.8, 1.8), -1);
  return -normal.normalized() / number(nearest, farthest);
}

inline double largest(const Eigen::MatrixXd& m) { return m.cwiseAbs().maxCoeff(); }

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_PROPERTIES_PROPERTIES_HPP
