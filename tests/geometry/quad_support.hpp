// Quads, and the scalars that their tests run with.
#ifndef TEXTPLANE_TESTS_GEOMETRY_QUAD_SUPPORT_HPP
#define TEXTPLANE_TESTS_GEOMETRY_QUAD_SUPPORT_HPP

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>

#include "support/calculus.hpp"
#include "support/random.hpp"
#include "textplane/geometry/quad.hpp"

namespace quad_test {
namespace tp = textplane;
using textplane_test::Dual;
using textplane_test::Random;
using textplane_test::tolerance;
using textplane_test::value;
using textplane_test::values;
using Quad = tp::Quad<double>;
using Vector2d = Eigen::Vector2d;
using Vector3d = Eigen::Vector3d;

const double kNan = std::nan(""), kInf = std::numeric_limits<double>::infinity();

template <class S>
class Quads : public testing::Test {};
using Scalars = testing::Types<float, double, Dual<2>>;
TYPED_TEST_SUITE(Quads, Scalars, );

inline Quad make_quad(Vector2d a, Vector2d b, Vector2d c, Vector2d d) {
  Quad q;
  q.corner = {a, b, c, d};
  return q;
}
inline Quad rectangle(double x0, double y0, double x1, double y1) {
  return make_quad({x0, y0}, {x1, y0}, {x1, y1}, {x0, y1});
}

// Four points on an ellipse in clockwise order: always convex.
inline Quad random_convex(Random& random, Vector2d centre, double radius) {
  Quad q;
  const double start = random.uniform(0, 6.28);
  for (std::size_t i = 0; i < 4; ++i) {
    const double angle = start + 1.5707963 * (static_cast<double>(i) + random.uniform(-0.35, 0.35));
    q.corner[i] = centre + radius * Vector2d(std::cos(angle), 0.6 * std::sin(angle));
  }
  return q;
}

inline Quad reversed(const Quad& q) { return make_quad(q.corner[0], q.corner[3], q.corner[2], q.corner[1]); }
inline Quad rotated(const Quad& q, std::size_t by) {
  return make_quad(q.corner[by % 4], q.corner[(by + 1) % 4], q.corner[(by + 2) % 4], q.corner[(by + 3) % 4]);
}

// Whether p lies in q, by the winding of angles: independent of clipping.
inline bool inside_by_angles(const Quad& q, const Vector2d& p) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d a = q.corner[i] - p, b = q.corner[(i + 1) % 4] - p;
    sum += std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
  }
  return std::abs(sum) > 3.14;
}

}  // namespace quad_test

#endif  // TEXTPLANE_TESTS_GEOMETRY_QUAD_SUPPORT_HPP
