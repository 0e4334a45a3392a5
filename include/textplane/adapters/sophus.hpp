// Sophus's poses and similar types, to and from SE3. No Sophus header is included. A type needs
//
//   rotationMatrix(), translation()              from_sophus(), and to_se3() of core/se3.hpp
//   or so3().matrix(), translation()             from_sophus()
//   Pose(Eigen::Quaternion, Vector3)             to_sophus()
//   exp(Vector6), operator*                      apply_left(), apply_right()
//
// Both libraries order tangents as (v, omega), translation first (docs/conventions.md). textplane perturbs T_t_h from
// the left. Code that writes T * SE3d::exp(xi) perturbs from the right: convert with relative_pose_jacobians() or
// adjoint(). SE3d::data() is a pose block of adapters/ceres.hpp.
#ifndef TEXTPLANE_ADAPTERS_SOPHUS_HPP
#define TEXTPLANE_ADAPTERS_SOPHUS_HPP

#include <type_traits>
#include <utility>

#ifndef TEXTPLANE_SINGLE_HEADER
#include "textplane/core/se3.hpp"
#endif

TEXTPLANE_BEGIN_NAMESPACE

namespace adapters {

namespace detail {
template <class T, class = void>
struct HasSo3Matrix : std::false_type {};
template <class T>
struct HasSo3Matrix<
    T, std::void_t<decltype(std::declval<const T&>().so3().matrix()), decltype(std::declval<const T&>().translation())>>
    : std::true_type {};
}  // namespace detail

/// The pose as SE3 of its own scalar.
template <class Pose>
SE3<typename Pose::Scalar> from_sophus(const Pose& T) noexcept {
  if constexpr (textplane::detail::HasRotationMatrix<Pose>::value) {
    return {T.rotationMatrix(), T.translation()};
  } else {
    static_assert(detail::HasSo3Matrix<Pose>::value,
                  "textplane: the pose has neither rotationMatrix() nor so3().matrix() beside translation()");
    return {T.so3().matrix(), T.translation()};
  }
}

/// The pose of an SE3, by a normalised quaternion: Sophus aborts on a matrix that is not orthogonal to rounding.
template <class Pose, class S>
Pose to_sophus(const SE3<S>& T) {
  static_assert(std::is_constructible<Pose, const Eigen::Quaternion<S>&, const Vector3<S>&>::value,
                "textplane: the pose cannot be made of a quaternion and a translation of this scalar");
  return Pose(Eigen::Quaternion<S>(T.R).normalized(), T.t);
}

/// Exp(xi) T: applies a step of T_t_h, or of a world-to-camera pose.
template <class Pose, class S>
Pose apply_left(const Pose& T, const Vector6<S>& xi) {
  return Pose::exp(xi) * T;
}
/// T Exp(xi): applies a step of solve_window(), or of a linearisation with PerturbationSide::right.
template <class Pose, class S>
Pose apply_right(const Pose& T, const Vector6<S>& xi) {
  return T * Pose::exp(xi);
}

}  // namespace adapters

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_ADAPTERS_SOPHUS_HPP
