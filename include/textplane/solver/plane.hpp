// Plane parameters theta of a text object from one or many target images with known poses: refine_plane() and
// align_plane().
//
// Minimises the paper's text object refinement, C(theta) = sum_targets N c with c the robust photometric cost
// (residual.hpp) and N its visible pixels: the cost of a pixel is then of unit scale on a patch of unit variance.
// Coarse to fine over pyramid levels.
#ifndef TEXTPLANE_SOLVER_PLANE_HPP
#define TEXTPLANE_SOLVER_PLANE_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/photometry/residual.hpp"
#include "textplane/solver/gauss_newton.hpp"
#include "textplane/solver/levels.hpp"
#include "textplane/solver/pose.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A target image and its pose relative to the host. View: PyramidView, or PyramidViewF for float images.
template <class View>
struct BasicPlaneTarget {
  /// Pyramid of the undistorted image.
  View image;
  /// Host to target.
  SE3d T_t_h;
  int scale_shift = 0;  ///< Of photometric_input(): where the target sees the object at another size than the host.
  /// The host's patch as this target is to be compared with it (blur.hpp), if other than the patch given to refine_plane(), whose
  /// levels and numbers of pixels it must have: a target with another is not used.
  const TextPatch* patch = nullptr;
};
using PlaneTarget = BasicPlaneTarget<PyramidView>;    ///< Of 8-bit images.
using PlaneTargetF = BasicPlaneTarget<PyramidViewF>;  ///< Of float images.

/// Settings of refine_plane() and align_plane().
struct PlaneOptions {
  /// Of every pixel.
  PhotometricOptions photometric;
  SolveOptions solve;      ///< Of the finest level; coarser ones stop at a relative gain of 1e-3 or a step of 1e-5 at
                           ///< the latest.
  int coarsest_level = 2;  ///< Levels that the images or the patch lack are left out.
  /// Where it ends; 0 is the image itself.
  int finest_level = 0;
};

/// Memory of refine_plane(). Not to be shared by two threads at a time.
class PlaneWorkspace;

/// Result of refine_plane(); the numbers are those of the finest level and of the returned theta.
///
/// status: converged or iteration_limit; diverged where no step lowered the cost; rank_deficient where the targets do
/// not determine theta (no parallax: covariance stays zero); where no target could be used, the status of the first
/// that failed (too_few, out_of_view, behind_camera, no_contrast, ...); non_finite for a NaN theta or camera;
/// invalid_argument for no targets, null pointers, bad options, a camera that is not valid() or a workspace without
/// room. Poses that are not finite make their target unusable.
struct PlaneRefinement {
  Vector3<double> theta = Vector3<double>::Zero();  ///< The best seen; the initial one if nothing could be improved.
  /// residual_variance times the inverse of sum N J^T W J. It knows the noise of the targets, not what all of them
  /// share: the noise of the host pixels and errors of the poses.
  Matrix3<double> covariance = Matrix3<double>::Zero();
  Matrix3<double> information = Matrix3<double>::Zero();  ///< Inverse of `covariance`.
  double residual_variance = 0;  ///< Of a pixel, on patches of unit variance: C / (sum N - 2 targets - 3), mean and
                                 ///< norm costing two.
  /// C(theta).
  double cost = 0;
  double zncc = 0;  ///< Mean over the targets used.
  /// Targets that took part.
  int targets_used = 0;
  int visible_pixels = 0;  ///< Over the targets used.
  int iterations = 0;      ///< Trials over all levels.
  /// Why it ended: see above.
  Status status = Status::invalid_argument;
};

namespace detail {
struct PlaneSystem {
  Matrix3<double> H = Matrix3<double>::Zero();
  Vector3<double> b = Vector3<double>::Zero();
  double cost = 0;
  Status status = Status::too_few;
};

template <class View>
class PlaneProblem;
}  // namespace detail

/// Memory of refine_plane(). Not to be shared by two threads at a time.
class PlaneWorkspace {
 public:
  /// Makes room for a patch (every level) seen in `targets` images. The only member that allocates; never shrinks.
  void reserve(const TextPatch& patch, int targets) {
    const int n = patch.max_pixels();
    photometric_.reserve(n);
    const std::size_t count = targets > 0 ? static_cast<std::size_t>(targets) : 0;
    if (visible_.size() < count * static_cast<std::size_t>(n)) visible_.resize(count * static_cast<std::size_t>(n));
    if (counts_.size() < count) counts_.resize(count);
  }

  /// reserve() was called for at least this.
  bool fits(const TextPatch& patch, int targets) const noexcept {
    const int n = patch.max_pixels();
    const auto count = static_cast<std::size_t>(targets);
    return n <= photometric_.capacity() && count <= counts_.size() &&
           count * static_cast<std::size_t>(n) <= visible_.size();
  }

 private:
  template <class View>
  friend class detail::PlaneProblem;

  PhotometricWorkspace photometric_;
  std::vector<std::uint8_t> visible_;  // Visible sets of the last linearisation, target after target.
  std::vector<int> counts_;            // Visible pixels of each; 0: the target took no part.
};

namespace detail {
template <class View>
class PlaneProblem {
 public:
  using State = Vector3<double>;
  static constexpr int kParameters = 3;

  PlaneProblem(const TextPatch& patch, const BasicPlaneTarget<View>* targets, int count, const Pinhole<double>& camera,
               const PlaneOptions& options, PlaneWorkspace& workspace) noexcept
      : patch_(patch), targets_(targets), count_(count), camera_(camera), options_(options), memory_(workspace) {}

  void set_level(int level) noexcept { level_ = level; }

  PlaneSystem linearise(const Vector3<double>& theta) noexcept {
    PlaneSystem system;
    Status trouble = Status::too_few;
    visible_ = used_ = 0;
    zncc_ = 0;
    for (int i = 0; i < count_; ++i) {
      int& visible = memory_.counts_[static_cast<std::size_t>(i)];
      visible = 0;
      if (!fits(i)) continue;
      const auto input = level_input(patch_of(i), level_, targets_[i].image, camera_, targets_[i].scale_shift);
      const NormalEquations<3> n =
          textplane::linearise_plane(input, theta, targets_[i].T_t_h, options_.photometric, memory_.photometric_);
      visible = is_ok(n.status) ? n.visible : 0;
      if (visible == 0) {
        if (trouble == Status::too_few) trouble = n.status;
        continue;
      }
      std::copy_n(memory_.photometric_.visible(), input.patch.n, visible_set(i));
      for (int c = 0; c < 3; ++c) {
        system.b[c] += visible * n.b[c];
        for (int r = 0; r < 3; ++r) system.H(r, c) += visible * n.H(r, c);
      }
      system.cost += visible * n.cost;
      visible_ += visible;
      zncc_ += n.zncc;
      ++used_;
    }
    system.status = used_ > 0 ? Status::ok : trouble;
    return system;
  }

  Evaluation evaluate(const Vector3<double>& theta) noexcept {
    Evaluation e;
    int lost = 0;
    for (int i = 0; i < count_; ++i) {
      const int visible = memory_.counts_[static_cast<std::size_t>(i)];
      if (visible == 0) continue;
      const PhotometricCost c =
          textplane::evaluate(level_input(patch_of(i), level_, targets_[i].image, camera_, targets_[i].scale_shift),
                              theta, targets_[i].T_t_h, options_.photometric, memory_.photometric_, visible_set(i));
      // A target that is lost as a whole costs what an uncorrelated patch would.
      e.cost += visible * (is_ok(c.status) ? c.cost : options_.photometric.robust.rho(2.0));
      lost += is_ok(c.status) ? c.lost : visible;
    }
    e.lost_fraction = visible_ > 0 ? static_cast<double>(lost) / visible_ : 0.0;
    return e;
  }

  Vector3<double> retract(const Vector3<double>& theta, const Vector3<double>& step) const noexcept {
    return {theta[0] + step[0], theta[1] + step[1], theta[2] + step[2]};
  }

  /// Of the last linearisation.
  int visible_pixels() const noexcept { return visible_; }
  int targets_used() const noexcept { return used_; }
  double mean_zncc() const noexcept { return used_ > 0 ? zncc_ / used_ : 0.0; }

 private:
  const TextPatch& patch_of(int i) const noexcept { return targets_[i].patch ? *targets_[i].patch : patch_; }

  bool fits(int i) const noexcept {
    const TextPatch* own = targets_[i].patch;
    if (!own) return true;
    if (own->level_count() != patch_.level_count()) return false;
    for (std::size_t l = 0; l < patch_.levels.size(); ++l)
      if (own->levels[l].x.size() != patch_.levels[l].x.size()) return false;
    return true;
  }

  std::uint8_t* visible_set(int i) noexcept {
    return memory_.visible_.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(patch_.max_pixels());
  }

  const TextPatch& patch_;
  const BasicPlaneTarget<View>* targets_;
  int count_;
  const Pinhole<double>& camera_;
  const PlaneOptions& options_;
  PlaneWorkspace& memory_;
  int level_ = 0;
  int visible_ = 0, used_ = 0;
  double zncc_ = 0;
};

template <class View>
PlaneRefinement refine_plane(const TextPatch& patch, const Vector3<double>& theta,
                             const BasicPlaneTarget<View>* targets, int count, const Pinhole<double>& camera,
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
  for (int i = 0; i < count; ++i) levels = std::max(levels, targets[i].image.levels);
  const LevelRange range =
      level_range(options.coarsest_level, options.finest_level, std::min(levels, patch.level_count()));
  PlaneProblem<View> problem(patch, targets, count, camera, options, workspace);
  PlaneSystem system;
  fit.status = Status::invalid_argument;
  for (int level = range.coarsest; level >= range.finest; --level) {
    problem.set_level(level);
    system = PlaneSystem();
    const SolveOptions solve = level == range.finest ? options.solve : coarse_options(options.solve);
    const SolveSummary summary = minimise(problem, fit.theta, solve, &system);
    fit.iterations += summary.iterations;
    fit.status = summary.status;
    fit.cost = summary.final_cost;
  }
  if (!is_ok(system.status)) return fit;

  fit.zncc = problem.mean_zncc();
  fit.targets_used = problem.targets_used();
  fit.visible_pixels = problem.visible_pixels();
  const int freedom = std::max(1, fit.visible_pixels - 2 * fit.targets_used - 3);
  // A perfect match would claim no uncertainty at all. The floor lies below what the rounding of 8-bit images leaves
  // (1/6 of a grey level squared for both sides) on a patch of any contrast.
  fit.residual_variance = std::max(fit.cost / freedom, 1e-6);
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

/// Refine theta (plane in the host frame) of a text object against `count` target images with known poses, coarse to
/// fine.
///
/// `camera`: of the targets, level 0; the host's is in the patch. Targets that do not see enough of the patch are
/// skipped, decided anew at every linearisation. No allocation: `workspace` must have been reserved for this patch and
/// count. Thread-safe for distinct workspaces.
template <class = void>  // instantiated where it is called: including the header costs little
PlaneRefinement refine_plane(const TextPatch& patch, const Vector3<double>& theta, const PlaneTarget* targets,
                             int count, const Pinhole<double>& camera, const PlaneOptions& options,
                             PlaneWorkspace& workspace) noexcept {
  return detail::refine_plane(patch, theta, targets, count, camera, options, workspace);
}

/// The same on float images.
template <class = void>  // instantiated where it is called: including the header costs little
PlaneRefinement refine_plane(const TextPatch& patch, const Vector3<double>& theta, const PlaneTargetF* targets,
                             int count, const Pinhole<double>& camera, const PlaneOptions& options,
                             PlaneWorkspace& workspace) noexcept {
  return detail::refine_plane(patch, theta, targets, count, camera, options, workspace);
}

/// refine_plane() with one target and a workspace of its own (allocates).
template <class = void>  // instantiated where it is called: including the header costs little
PlaneRefinement align_plane(const TextPatch& patch, const Vector3<double>& theta, const SE3d& T_t_h,
                            const PyramidView& target, const Pinhole<double>& camera,
                            const PlaneOptions& options = {}) {
  const PlaneTarget one{target, T_t_h};
  PlaneWorkspace workspace;
  workspace.reserve(patch, 1);
  return detail::refine_plane(patch, theta, &one, 1, camera, options, workspace);
}

#if defined(TEXTPLANE_EXTERN_KERNELS)
TEXTPLANE_INSTANCE PlaneRefinement refine_plane<void>(const TextPatch&, const Vector3<double>&, const PlaneTarget*, int,
                                                      const Pinhole<double>&, const PlaneOptions&,
                                                      PlaneWorkspace&) noexcept;
TEXTPLANE_INSTANCE PlaneRefinement refine_plane<void>(const TextPatch&, const Vector3<double>&, const PlaneTargetF*,
                                                      int, const Pinhole<double>&, const PlaneOptions&,
                                                      PlaneWorkspace&) noexcept;
TEXTPLANE_INSTANCE PlaneRefinement align_plane<void>(const TextPatch&, const Vector3<double>&, const SE3d&,
                                                     const PyramidView&, const Pinhole<double>&, const PlaneOptions&);
#endif

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_PLANE_HPP
