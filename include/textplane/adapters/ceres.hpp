// Ceres: cost functions with analytic derivatives for text objects (photometric) and points (reprojection error).
// adapters/ceres_pose.hpp has pose blocks and their manifold; adapters/ceres_window.hpp turns a Window into a
// ceres::Problem.
//
// Blocks: a pose is seven numbers, camera to world; a plane is theta in its host frame; a point is in the world.
// Derivatives are by these numbers, so any manifold of unit quaternions works: PoseManifold, Sophus's, or
// ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>. A parameterisation that reads
// the first six of the seven columns as the tangent space (VINS-Mono) does not.
//
// Residuals of a text observation, TextRows (docs/equations.md; c is the robust cost, H and b its normal equations):
//   sums    P + 1 numbers, P = 3, 6 or 9 parameters: with H = L L^T the rows are J = L^T and r = L^-1 b, so that
//           J^T J = H and J^T r = b. A last residual without derivatives makes r^T r the cost. Ceres gets the sums of
//           the SIMD kernel, a hundredth of the rows of `pixels`. J belongs to the cost, not to r: give
//           ceres::GradientChecker r^T r / 2.
//   pixels  one number a pixel of the patch, +-sqrt(rho(e^2) / N), e = r sqrt(N), 0 for an invisible pixel; computed by
//           the slow double reference.
// Both have the same cost and gradient.
//
// Robust costs: PhotometricOptions::robust acts on every pixel. A ceres loss acts on a whole residual block, so pass
// nullptr as the loss of a text. Points take an ordinary loss (ceres::HuberLoss).
//
// Evaluate() returns false where the kernels have no result (the object left the image or is behind a camera). Ceres
// then rejects the step, or refuses to start. Thread-safe. Tested with Ceres 2.1.
#ifndef TEXTPLANE_ADAPTERS_CERES_HPP
#define TEXTPLANE_ADAPTERS_CERES_HPP

#include <ceres/sized_cost_function.h>

#include <memory>
#include <utility>

#include "ceres_pose.hpp"
#include "ceres_text_rows.hpp"

#ifndef TEXTPLANE_SINGLE_HEADER
#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/core/se3.hpp"
#endif

TEXTPLANE_BEGIN_NAMESPACE

namespace adapters {

namespace detail {

// d xi(T_t_h) / d block of the two camera-to-world poses.
template <PoseOrder Order>
FixedMatrix<double, 6, 7> host_by_block(const SE3d& T_t_h, const double* block) {
  return adjoint(T_t_h).lazyProduct(perturbation_by_block<Order>(block));
}
template <PoseOrder Order>
FixedMatrix<double, 6, 7> target_by_block(const double* block) {
  return -perturbation_by_block<Order>(block);
}

// Writes rows times factor to a Jacobian block, unless null.
template <class Rows, int Inner, int Columns>
void write_block(const Rows& rows, const FixedMatrix<double, Inner, Columns>& factor, double* out) {
  if (!out) return;
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Columns, Eigen::RowMajor>>(out, rows.rows(), Columns) =
      rows.lazyProduct(factor);
}
template <class Rows>
void write_plane(const Rows& rows, double* out) {
  if (out) Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(out, rows.rows(), 3) = rows;
}

}  // namespace detail

/// A text object seen by a camera whose pose is unknown: block T_w_t. Patch and image of `input` must outlive the
/// problem; see photometric_input().
template <PoseOrder Order = PoseOrder::quaternion_translation>
class TextPoseCost : public detail::TextRowsCost<Parameters::pose> {
 public:
  /// T_w_h: pose of the host, camera to world; theta in its frame. Without a pool it makes its own.
  TextPoseCost(const PhotometricInput& input, const SE3d& T_w_h, const Vector3<double>& theta,
               const TextCostOptions& options = {}, std::shared_ptr<WorkspacePool> pool = nullptr)
      : TextRowsCost(input, options, std::move(pool)), T_w_h_(T_w_h), theta_(theta) {
    mutable_parameter_block_sizes()->push_back(kPoseSize);
  }

  /// As ceres::CostFunction; false where the kernels have no result.
  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    const SE3d T_t_h = pose_from_block<Order>(blocks[0]).inverse() * T_w_h_;
    const bool wanted = jacobians && jacobians[0];
    return evaluate(theta_, T_t_h, residuals, wanted, [&](const auto& rows) {
      detail::write_block(rows, detail::target_by_block<Order>(blocks[0]), jacobians[0]);
    });
  }

 private:
  const SE3d T_w_h_;
  const Vector3<double> theta_;
};

/// A text object whose plane is unknown, seen from a known pose: block theta. `input` as in TextPoseCost.
class TextPlaneCost : public detail::TextRowsCost<Parameters::plane> {
 public:
  /// T_t_h: host to target. Without a pool it makes its own.
  TextPlaneCost(const PhotometricInput& input, const SE3d& T_t_h, const TextCostOptions& options = {},
                std::shared_ptr<WorkspacePool> pool = nullptr)
      : TextRowsCost(input, options, std::move(pool)), T_t_h_(T_t_h) {
    mutable_parameter_block_sizes()->push_back(3);
  }

  /// As ceres::CostFunction; false where the kernels have no result.
  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    const bool wanted = jacobians && jacobians[0];
    return evaluate(Eigen::Map<const Vector3<double>>(blocks[0]), T_t_h_, residuals, wanted,
                    [&](const auto& rows) { detail::write_plane(rows, jacobians[0]); });
  }

 private:
  const SE3d T_t_h_;
};

/// A text object in bundle adjustment: blocks T_w_h, T_w_t, theta. `input` as in TextPoseCost.
template <PoseOrder Order = PoseOrder::quaternion_translation>
class TextCost : public detail::TextRowsCost<Parameters::pose_plane> {
 public:
  /// Without a pool it makes its own.
  explicit TextCost(const PhotometricInput& input, const TextCostOptions& options = {},
                    std::shared_ptr<WorkspacePool> pool = nullptr)
      : detail::TextRowsCost<Parameters::pose_plane>(input, options, std::move(pool)) {
    *mutable_parameter_block_sizes() = {kPoseSize, kPoseSize, 3};
  }

  /// As ceres::CostFunction; false where the kernels have no result.
  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    const SE3d T_t_h = pose_from_block<Order>(blocks[1]).inverse() * pose_from_block<Order>(blocks[0]);
    const bool wanted = jacobians && (jacobians[0] || jacobians[1] || jacobians[2]);
    return evaluate(Eigen::Map<const Vector3<double>>(blocks[2]), T_t_h, residuals, wanted, [&](const auto& rows) {
      const auto by_pose = rows.template leftCols<6>();
      detail::write_block(by_pose, detail::host_by_block<Order>(T_t_h, blocks[0]), jacobians[0]);
      detail::write_block(by_pose, detail::target_by_block<Order>(blocks[1]), jacobians[1]);
      detail::write_plane(rows.template rightCols<3>(), jacobians[2]);
    });
  }
};

/// The reprojection error of a point, (pi(T_w_c^-1 p_w) - px) / sigma: blocks T_w_c and p_w.
template <PoseOrder Order = PoseOrder::quaternion_translation>
class PointCost : public ceres::SizedCostFunction<2, kPoseSize, 3> {
 public:
  /// px: level 0, of the image as the camera sees it; sigma: its standard deviation in px; min_depth in the unit of the
  /// world.
  PointCost(const CameraView& camera, const Vector2<double>& px, double sigma = 1, double min_depth = 1e-6)
      : camera_(camera), px_(px), scale_(1 / sigma), min_depth_(min_depth) {}

  /// As ceres::CostFunction; false where z <= min_depth, or the lens has no pixel.
  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    const SE3d T = pose_from_block<Order>(blocks[0]);
    const Vector3<double> p = T.R.transpose() * (Eigen::Map<const Vector3<double>>(blocks[1]) - T.t);
    if (!(p[2] > min_depth_) || !camera_.in_domain(p)) return false;
    FixedMatrix<double, 2, 3> J;
    Eigen::Map<Vector2<double>>{residuals} = scale_ * (camera_.project(p, &J) - px_);
    if (!jacobians) return true;
    J *= scale_;
    if (jacobians[0]) {
      FixedMatrix<double, 2, 6> by_pose;
      by_pose << -J, J * hat(p);
      detail::write_block(by_pose, perturbation_by_block<Order>(blocks[0]), jacobians[0]);
    }
    if (jacobians[1]) Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>{jacobians[1]} = J * T.R.transpose();
    return true;
  }

 private:
  const CameraView camera_;
  const Vector2<double> px_;
  const double scale_, min_depth_;
};

}  // namespace adapters

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_ADAPTERS_CERES_HPP
