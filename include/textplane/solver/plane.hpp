// refine_plane() and align_plane(): theta of a text object from targets with known poses, coarse to fine. The cost is
// in plane_problem.hpp.
#ifndef TEXTPLANE_SOLVER_PLANE_HPP
#define TEXTPLANE_SOLVER_PLANE_HPP

#include <algorithm>

#include "textplane/solver/plane_problem.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Result of refine_plane(). All numbers belong to the finest level and the returned theta.
///
/// status: converged or iteration_limit; diverged where no step lowered the cost; rank_deficient where the targets do
/// not determine theta (no parallax: covariance stays zero); non_finite for a NaN theta or camera; invalid_argument for
/// no targets, null pointers, bad options, a camera that is not valid() or a workspace without room. Where no target
/// can be used, it is the status of the first one (too_few, out_of_view, behind_camera, no_contrast, ...). A target
/// with a non-finite pose cannot be used.
struct PlaneRefinement {
  Vector3<double> theta = Vector3<double>::Zero();  ///< The best one found; the initial one after a failure.
  /// residual_variance times the inverse of sum N J^T W J. It covers the noise of the targets, but not errors that all
  /// targets share: noise of the host pixels and errors of the poses.
  Matrix3<double> covariance = Matrix3<double>::Zero();
  Matrix3<double> information = Matrix3<double>::Zero();  ///< Inverse of `covariance`.
  /// Of a pixel on patches of unit variance: C / (sum N - 2 targets - 3). A target's mean and norm take two degrees.
  double residual_variance = 0;
  double cost = 0;                           ///< C(theta).
  double zncc = 0;                           ///< Mean over the targets used.
  int targets_used = 0;                      ///< Targets that took part.
  int visible_pixels = 0;                    ///< Over the targets used.
  int iterations = 0;                        ///< Trials over all levels.
  Path path = Path::kernel;                  ///< Path::reference where any evaluation ran on the slow reference.
  Status status = Status::invalid_argument;  ///< Why it ended: see above.
};

namespace detail {
template <class View>
PlaneRefinement refine_plane(const TextPatch& patch, const Vector3<double>& theta,
                             const BasicPlaneTarget<View>* targets, int count, const CameraView& camera,
                             const PlaneOptions& options, PlaneWorkspace& workspace) noexcept {
  PlaneRefinement fit;
  fit.theta = theta;
  if (count < 1 || !targets || !options.photometric.valid() || !valid(options.solve)) return fit;
  if (options.finest_level < 0 || options.coarsest_level < options.finest_level || !workspace.fits(patch, count))
    return fit;
  fit.status = check_camera(camera);
  if (is_ok(fit.status) && !all_finite(theta)) fit.status = Status::non_finite;
  if (!is_ok(fit.status)) return fit;

  int levels = 0;
  for (int i = 0; i < count; ++i) levels = (std::max)(levels, targets[i].image.levels);
  const LevelRange range =
      level_range(options.coarsest_level, options.finest_level, (std::min)(levels, patch.level_count()));
  PlaneProblem<View> problem(patch, targets, count, camera, options, workspace);
  PlaneSystem system;
  fit.status = Status::invalid_argument;
  minimise_levels(problem, fit.theta, range, options.solve, &system, &fit);
  if (!is_ok(system.status)) return fit;

  fit.zncc = problem.mean_zncc();
  fit.targets_used = problem.targets_used();
  fit.visible_pixels = problem.visible_pixels();
  const int freedom = (std::max)(1, fit.visible_pixels - 2 * fit.targets_used - 3);
  // A perfect match would have no uncertainty. The floor is below the rounding error of two 8-bit images (1/6 of a grey
  // level squared) on a patch of any contrast.
  fit.residual_variance = (std::max)(fit.cost / freedom, 1e-6);
  const Ldlt<double, 3> factor(system.H, options.solve.rank_tolerance);
  if (!factor.ok()) return fit;
  const Matrix3<double> inverse = factor.inverse();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      fit.covariance(i, j) = fit.residual_variance * 0.5 * (inverse(i, j) + inverse(j, i));
      fit.information(i, j) = system.H(i, j) / fit.residual_variance;
    }
  return fit;
}
}  // namespace detail

/// Refines theta (plane in the host frame) of a text object on `count` targets with known poses, coarse to fine.
///
/// `camera`: of the targets, level 0; the patch holds the host's. Every linearisation skips the targets that see too
/// little of the patch. No allocation: reserve `workspace` for this patch and count. Thread-safe for distinct
/// workspaces.
TEXTPLANE_DEFERRED
PlaneRefinement refine_plane(const TextPatch& patch, const Vector3<double>& theta, const PlaneTarget* targets,
                             int count, const CameraView& camera, const PlaneOptions& options,
                             PlaneWorkspace& workspace) noexcept {
  return detail::refine_plane(patch, theta, targets, count, camera, options, workspace);
}

/// The same on float images.
TEXTPLANE_DEFERRED
PlaneRefinement refine_plane(const TextPatch& patch, const Vector3<double>& theta, const PlaneTargetF* targets,
                             int count, const CameraView& camera, const PlaneOptions& options,
                             PlaneWorkspace& workspace) noexcept {
  return detail::refine_plane(patch, theta, targets, count, camera, options, workspace);
}

/// refine_plane() with one target and a workspace of its own (allocates).
TEXTPLANE_DEFERRED
PlaneRefinement align_plane(const TextPatch& patch, const Vector3<double>& theta, const SE3d& T_t_h,
                            const PyramidView& target, const CameraView& camera, const PlaneOptions& options = {}) {
  const PlaneTarget one{target, T_t_h};
  PlaneWorkspace workspace;
  workspace.reserve(patch, 1);
  return detail::refine_plane(patch, theta, &one, 1, camera, options, workspace);
}

TEXTPLANE_INSTANCE(PlaneRefinement refine_plane<>(const TextPatch&, const Vector3<double>&, const PlaneTarget*, int,
                                                  const CameraView&, const PlaneOptions&, PlaneWorkspace&) noexcept);
TEXTPLANE_INSTANCE(PlaneRefinement refine_plane<>(const TextPatch&, const Vector3<double>&, const PlaneTargetF*, int,
                                                  const CameraView&, const PlaneOptions&, PlaneWorkspace&) noexcept);
TEXTPLANE_INSTANCE(PlaneRefinement align_plane<>(const TextPatch&, const Vector3<double>&, const SE3d&,
                                                 const PyramidView&, const CameraView&, const PlaneOptions&));

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_PLANE_HPP
