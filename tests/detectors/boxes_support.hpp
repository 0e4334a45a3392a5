// Boxes for tests of detectors.
#ifndef TEXTPLANE_TESTS_DETECTORS_BOXES_SUPPORT_HPP
#define TEXTPLANE_TESTS_DETECTORS_BOXES_SUPPORT_HPP

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "io/names.hpp"

namespace textslam {

/// `turn`: radians, clockwise on the screen.
inline Quad<double> turned_box(Vector2<double> centre, double wide, double high, double turn) {
  const Vector2<double> a = wide / 2 * Vector2<double>(std::cos(turn), std::sin(turn)),
                        d = high / 2 * Vector2<double>(-std::sin(turn), std::cos(turn));
  Quad<double> quad;
  quad.corner = {centre - a - d, centre + a - d, centre + a + d, centre - a + d};
  return quad;
}

inline void expect_quad(const Quad<double>& found, const Quad<double>& expected, double tolerance) {
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_LT((found.corner[k] - expected.corner[k]).norm(), tolerance) << "corner " << k << ": " << found.corner[k];
}

}  // namespace textslam

#endif  // TEXTPLANE_TESTS_DETECTORS_BOXES_SUPPORT_HPP
