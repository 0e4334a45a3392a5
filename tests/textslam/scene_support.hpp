// A known scene for textslam's parts: points in view of a camera, their views, poses and what tells two of them apart.
#ifndef TESTS_TEXTSLAM_SCENE_SUPPORT_HPP
#define TESTS_TEXTSLAM_SCENE_SUPPORT_HPP

#include <cmath>
#include <random>
#include <vector>

#include "textslam/map/map.hpp"

namespace textslam {
namespace scene_support {

constexpr double kFocal = 525;
constexpr double kDegree = M_PI / 180;

inline double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

inline Pinhole<double> camera() { return {kFocal, kFocal, 319.5, 239.5}; }

// World points in view of a camera at the origin that looks along z: in a volume 2 to 6 units away, or on a slanted
// plane.
inline std::vector<Vec3> scene(int n, bool planar, std::mt19937& random) {
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) {
    const double x = uniform(random, -0.5, 0.5), y = uniform(random, -0.4, 0.4);
    const double z = planar ? 3 / (1 - 0.5 * x + 0.3 * y) : uniform(random, 2, 6);
    points.push_back(z * Vec3(x, y, 1));
  }
  return points;
}

// Normalised views of the points, with an even error of up to `noise` px.
inline std::vector<Vec3> views(const std::vector<Vec3>& points, const SE3d& T_c_w, double noise, std::mt19937& random) {
  std::vector<Vec3> rays;
  for (const Vec3& point : points) {
    const Vec3 p = T_c_w * point;
    rays.push_back({p.x() / p.z() + uniform(random, -noise, noise) / kFocal,
                    p.y() / p.z() + uniform(random, -noise, noise) / kFocal, 1});
  }
  return rays;
}

inline double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }
inline double rotation_error(const SE3d& a, const SE3d& b) {
  return textplane::so3_log<double>(a.R * b.R.transpose()).norm();
}

inline SE3d moved(const Vec3& t, const Vec3& w) { return {textplane::so3_exp<double>(w), t}; }

}  // namespace scene_support
}  // namespace textslam

#endif  // TESTS_TEXTSLAM_SCENE_SUPPORT_HPP
