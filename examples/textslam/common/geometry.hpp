// Vectors, and angles in degrees.
#ifndef TEXTSLAM_COMMON_GEOMETRY_HPP
#define TEXTSLAM_COMMON_GEOMETRY_HPP

#include <cmath>

#include "io/names.hpp"
#include "textplane/core/se3.hpp"

namespace textslam {

using Vec2 = Eigen::Vector2d;
using Vec2f = Eigen::Vector2f;
using Vec3 = Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

inline double radians(double degrees) { return degrees * M_PI / 180; }

/// Angle of a rotation, degrees.
inline double degrees(const Eigen::Matrix3d& R) { return textplane::so3_log<double>(R).norm() * 180 / M_PI; }

/// Between two directions of any length, degrees.
inline double degrees_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
}

}  // namespace textslam

#endif  // TEXTSLAM_COMMON_GEOMETRY_HPP
