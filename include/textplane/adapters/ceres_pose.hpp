// Ceres: pose blocks and their manifold.
//
// A pose is a block of seven numbers: unit quaternion x y z w and translation, as in Sophus::SE3d::data(), or
// translation first (PoseOrder). PoseManifold moves it by T <- T Exp(xi), xi = (v, omega), as solve_window() does
// (docs/conventions.md).
//
// Tested with Ceres 2.1 and 2.2. Before 2.1 PoseManifold is a ceres::LocalParameterization.
#ifndef TEXTPLANE_ADAPTERS_CERES_POSE_HPP
#define TEXTPLANE_ADAPTERS_CERES_POSE_HPP

#include <ceres/version.h>
#if CERES_VERSION_MAJOR > 2 || (CERES_VERSION_MAJOR == 2 && CERES_VERSION_MINOR >= 1)
#define TEXTPLANE_CERES_HAS_MANIFOLD 1
#include <ceres/manifold.h>
#else
#define TEXTPLANE_CERES_HAS_MANIFOLD 0
#include <ceres/local_parameterization.h>
#endif

#ifndef TEXTPLANE_SINGLE_HEADER
#include "textplane/core/se3.hpp"
#endif

TEXTPLANE_BEGIN_NAMESPACE

namespace adapters {

/// Order of the parts of a pose block.
enum class PoseOrder {
  quaternion_translation,  ///< qx qy qz qw x y z: Sophus.
  translation_quaternion,  ///< x y z qx qy qz qw: TUM, VINS.
};

constexpr int kPoseSize = 7;  ///< Numbers of a pose block.

namespace detail {
constexpr int quaternion_at(PoseOrder order) noexcept { return order == PoseOrder::quaternion_translation ? 0 : 3; }
constexpr int translation_at(PoseOrder order) noexcept { return order == PoseOrder::quaternion_translation ? 4 : 0; }
}  // namespace detail

/// The pose of a block; its quaternion is normalised.
template <PoseOrder Order = PoseOrder::quaternion_translation>
SE3d pose_from_block(const double* block) noexcept {
  constexpr int q = detail::quaternion_at(Order), t = detail::translation_at(Order);
  const Eigen::Quaterniond rotation(block[q + 3], block[q], block[q + 1], block[q + 2]);
  return {rotation.normalized().toRotationMatrix(), Vector3<double>(block[t], block[t + 1], block[t + 2])};
}

/// The block of a pose.
template <PoseOrder Order = PoseOrder::quaternion_translation>
void pose_to_block(const SE3d& T, double* block) noexcept {
  constexpr int q = detail::quaternion_at(Order), t = detail::translation_at(Order);
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(T.R).normalized();
  for (int i = 0; i < 4; ++i) block[q + i] = rotation.coeffs()[i];
  for (int i = 0; i < 3; ++i) block[t + i] = T.t[i];
}

/// d block / d xi of T Exp(xi) at xi = 0, xi = (v, omega).
template <PoseOrder Order = PoseOrder::quaternion_translation>
FixedMatrix<double, 7, 6> block_by_perturbation(const double* block) noexcept {
  constexpr int q = detail::quaternion_at(Order), t = detail::translation_at(Order);
  const Vector3<double> v(block[q], block[q + 1], block[q + 2]);
  FixedMatrix<double, 7, 6> J = FixedMatrix<double, 7, 6>::Zero();
  J.template block<3, 3>(t, 0) = pose_from_block<Order>(block).R;
  J.template block<3, 3>(q, 3) = 0.5 * (block[q + 3] * Matrix3<double>::Identity() + hat(v));
  J.template block<1, 3>(q + 3, 3) = -0.5 * v.transpose();
  return J;
}

/// Its left inverse, d xi / d block along the unit quaternions.
template <PoseOrder Order = PoseOrder::quaternion_translation>
FixedMatrix<double, 6, 7> perturbation_by_block(const double* block) noexcept {
  constexpr int q = detail::quaternion_at(Order), t = detail::translation_at(Order);
  const FixedMatrix<double, 7, 6> J = block_by_perturbation<Order>(block);
  FixedMatrix<double, 6, 7> out = FixedMatrix<double, 6, 7>::Zero();
  out.template block<3, 3>(0, t) = J.template block<3, 3>(t, 0).transpose();
  out.template block<3, 4>(3, q) = 4.0 * J.template block<4, 3>(q, 3).transpose();
  return out;
}

#if TEXTPLANE_CERES_HAS_MANIFOLD
/// Pose blocks under T <- T Exp(xi), xi = (v, omega): the perturbation of solve_window().
template <PoseOrder Order = PoseOrder::quaternion_translation>
class PoseManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return kPoseSize; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* out) const override {
    const Vector6<double> xi = Eigen::Map<const Vector6<double>>(delta);
    pose_to_block<Order>(pose_from_block<Order>(x) * se3_exp(xi), out);
    return true;
  }
  bool PlusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>{jacobian} = block_by_perturbation<Order>(x);
    return true;
  }
  bool Minus(const double* y, const double* x, double* out) const override {
    Eigen::Map<Vector6<double>>{out} = se3_log(pose_from_block<Order>(x).inverse() * pose_from_block<Order>(y));
    return true;
  }
  bool MinusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>{jacobian} = perturbation_by_block<Order>(x);
    return true;
  }
};
#else
/// Pose blocks under T <- T Exp(xi), xi = (v, omega): the perturbation of solve_window().
template <PoseOrder Order = PoseOrder::quaternion_translation>
class PoseManifold : public ceres::LocalParameterization {
 public:
  int GlobalSize() const override { return kPoseSize; }  ///< Seven.
  int LocalSize() const override { return 6; }           ///< Six.
  /// T Exp(delta).
  bool Plus(const double* x, const double* delta, double* out) const override {
    const Vector6<double> xi = Eigen::Map<const Vector6<double>>(delta);
    pose_to_block<Order>(pose_from_block<Order>(x) * se3_exp(xi), out);
    return true;
  }
  /// d block / d delta at 0, 7 x 6, row-major.
  bool ComputeJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>{jacobian} = block_by_perturbation<Order>(x);
    return true;
  }
};
#endif

}  // namespace adapters

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_ADAPTERS_CERES_POSE_HPP
