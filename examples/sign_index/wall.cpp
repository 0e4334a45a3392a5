#include "sign_index/wall.hpp"

#include <algorithm>
#include <cmath>

namespace textslam {
namespace {

constexpr double kFlush = 0.1;                   // of the signs' distance
constexpr double kParallel = 0.984807753012208;  // cosine of 10 degrees
constexpr double kOnWall = 2;                    // signs beside one, on average
constexpr double kAlong = 0.5, kAcross = 0.1;    // of the reach: where on the wall they are
constexpr double kHeights = 2, kWidths = 3;      // ranges of their logarithms

Vec3 centre_of(const SignCorners& corners) { return (corners[0] + corners[1] + corners[2] + corners[3]) / 4; }

}  // namespace

Vec3 sign_normal(const SignCorners& corners) {
  return (corners[3] - corners[0]).cross(corners[1] - corners[0]).normalized();
}

bool on_one_wall(const SignCorners& a, const SignCorners& b) {
  const Vec3 normal = sign_normal(a), apart = centre_of(b) - centre_of(a);
  return normal.dot(sign_normal(b)) > kParallel && std::abs(normal.dot(apart)) < kFlush * apart.norm();
}

double log_wall_peak(const SignCorners& corners, const WallView& view) {
  const Vec3 across = (corners[1] - corners[0] + corners[2] - corners[3]) / 2,
             down = (corners[3] - corners[0] + corners[2] - corners[1]) / 2;
  const double width = across.norm(), height = down.norm();
  const Vec3 along_x = view.T_c_w.R * across / width, along_y = view.T_c_w.R * down / height;
  Eigen::Matrix<double, 8, 4> J;
  for (int k = 0; k < 4; ++k) {
    const Vec3 p = view.T_c_w * corners[static_cast<std::size_t>(k)];
    Eigen::Matrix<double, 2, 3> projection;
    projection << 1, 0, -p.x() / p.z(), 0, 1, -p.y() / p.z();
    const Vec2 x = projection * along_x / p.z(), y = projection * along_y / p.z();
    J.middleRows<2>(2 * k) << x, y, (k == 1 || k == 2 ? 0.5 : -0.5) * x, (k >= 2 ? 0.5 : -0.5) * y;
  }
  const double log_density =
      -std::log(kAlong * view.reach * kAcross * view.reach * kHeights * height * kWidths * width);
  const double squared_area = std::max(0.0, (J.transpose() * J).determinant());  // rounding, seen from the edge
  return std::log((1 - view.missed) / kOnWall) - log_density + 0.5 * std::log(squared_area) -
         2 * std::log(2 * M_PI * view.sigma * view.sigma);
}

}  // namespace textslam
