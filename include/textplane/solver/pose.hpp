// Camera pose from text objects and points: refine_pose() for a tracker's frame, also of a rig of several cameras,
// align_pose() for one object.
//
// The cost is in pose_problem.hpp, the iteration in gauss_newton.hpp. It runs once a pyramid level, coarse to fine.
// Points count on every level, in px of level 0. Points alone and text alone both work.
#ifndef TEXTPLANE_SOLVER_POSE_HPP
#define TEXTPLANE_SOLVER_POSE_HPP

#include <algorithm>
#include <cmath>
#include <limits>

#include "textplane/geometry/quad_projection.hpp"
#include "textplane/solver/pose_problem.hpp"
#include "textplane/solver/pose_rig.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// The result of a pose solve without the pose. All numbers belong to the finest level and the returned pose.
///
/// status: converged or iteration_limit; diverged where no step lowered the cost on the finest level; rank_deficient
/// where the terms do not determine the pose (one or two points); non_finite for a NaN pose or camera; invalid_argument
/// for null pointers, bad options, a camera that is not valid() or a workspace without room. Where no term can be used,
/// it is too_few, or the status of the first text that failed (out_of_view, behind_camera, no_contrast, ...).
struct PoseResult {
  /// Of xi = (v, omega), left: H / sigma_rep^2. Its inverse is the covariance under Weighting::variance.
  FixedMatrix<double, 6, 6> information = FixedMatrix<double, 6, 6>::Zero();
  double cost = 0;           ///< C(T_t_w) of the finest level.
  double zncc = 0;           ///< Mean over the texts that took part.
  int texts = 0;             ///< Texts that took part.
  int visible_pixels = 0;    ///< Of these texts.
  int inlier_points = 0;     ///< Points within the 95 % bound of chi-square: |e|^2 <= 5.991 (sigma sigma_rep)^2.
  int iterations = 0;        ///< Trials over all levels.
  Path path = Path::kernel;  ///< Path::reference where the slow reference evaluated any text.
  Status status = Status::invalid_argument;  ///< Why it ended: see above.
};

/// Standard deviation of the camera's position by PoseResult::information: the square root of the covariance's trace.
/// Infinite where the information leaves a direction open.
TEXTPLANE_DEFERRED
inline double position_sigma(const FixedMatrix<double, 6, 6>& information) noexcept {
  const Ldlt<double, 6> ldlt(information);
  if (!ldlt.ok()) return std::numeric_limits<double>::infinity();
  const FixedMatrix<double, 6, 6> covariance = ldlt.inverse();
  return std::sqrt(covariance(0, 0) + covariance(1, 1) + covariance(2, 2));
}

/// Result of refine_pose().
struct PoseFit : PoseResult {
  SE3d T_t_w;  ///< World to target: the best pose found, or the initial one after a failure. Finite if that one is.
};

/// Result of align_pose(). status: as above, and diverged where the target does not show the object at the pose found,
/// by PoseOptions::min_zncc; all else is then as found.
struct PoseAlignment : PoseResult {
  SE3d T_t_h;           ///< Host to target.
  int scale_shift = 0;  ///< Of photometric_input(), as chosen by the object's sizes in host and target.
};

namespace detail {
constexpr double kChiSquare95TwoDof = 5.991464547107979;

TEXTPLANE_DEFERRED
inline bool valid(const PoseOptions& o) noexcept {
  return o.photometric.valid() && o.point_robust.valid() && valid_sigma(o.sigma_photo) && valid_sigma(o.sigma_rep) &&
         o.coarsest_level >= o.finest_level && o.finest_level >= 0 &&
         (o.weighting == Weighting::paper || o.weighting == Weighting::variance) &&
         o.policy <= LinearisePolicy::automatic && is_finite(o.min_zncc) && valid(o.solve);
}

// The levels that the target and any text have. Without any, one pass on the finest level, for the points.
TEXTPLANE_DEFERRED
inline LevelRange pose_levels(const PoseTextTerm* texts, int text_count, int target_levels,
                              const PoseOptions& options) noexcept {
  int patch_levels = 0;
  for (int i = 0; i < text_count; ++i)
    if (texts[i].patch) patch_levels = (std::max)(patch_levels, texts[i].patch->level_count());
  const LevelRange range =
      level_range(options.coarsest_level, options.finest_level, (std::min)(patch_levels, target_levels));
  return range.coarsest >= range.finest ? range : LevelRange{options.finest_level, options.finest_level};
}

// What there is to check of a rig's cameras and of the terms that name them.
template <class View>
Status check_rig(const BasicPoseCamera<View>* cameras, int camera_count) noexcept {
  if (!cameras || camera_count <= 0) return Status::invalid_argument;
  for (int c = 0; c < camera_count; ++c) {
    const Status status = check_camera(cameras[c].camera);
    if (!is_ok(status)) return status;
    if (!all_finite(cameras[c].T_r_c)) return Status::non_finite;
  }
  return Status::ok;
}
template <class Term>
bool cameras_known(const Term* terms, int count, int camera_count) noexcept {
  for (int i = 0; i < count; ++i)
    if (terms[i].camera < 0 || terms[i].camera >= camera_count) return false;
  return true;
}

// The inputs of refine_pose() that one camera and a rig have in common, and its results for a problem of either.
struct PoseRequest {
  const PoseTextTerm* texts;
  int text_count;
  const PosePointTerm* points;
  int point_count;
  const PoseOptions& options;
  float *text_zncc, *point_chi2;

  bool valid(const PoseWorkspace& workspace, int camera_count) const noexcept {
    if (text_count < 0 || point_count < 0 || (text_count > 0 && !texts) || (point_count > 0 && !points)) return false;
    for (int i = 0; text_zncc && i < text_count; ++i) text_zncc[i] = -1.0F;
    for (int i = 0; point_chi2 && i < point_count; ++i) point_chi2[i] = -1.0F;
    return detail::valid(options) && workspace.fits(texts, text_count, point_count) &&
           cameras_known(texts, text_count, camera_count) && cameras_known(points, point_count, camera_count);
  }

  template <class Problem>
  void solve(Problem& problem, int target_levels, PoseFit& fit) const noexcept {
    const LevelRange range = pose_levels(texts, text_count, target_levels, options);
    PoseSystem system;
    minimise_levels(problem, fit.T_t_w, range, options.solve, &system, &fit);

    const double scale = 1.0 / (options.sigma_rep * options.sigma_rep);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) fit.information(i, j) = scale * system.H(i, j);
    if (is_ok(system.status)) {
      fit.texts = problem.active_texts();
      fit.visible_pixels = problem.visible_pixels();
      for (int i = 0; i < text_count; ++i) {
        const PoseTextState& state = problem.text_state(i);
        if (state.visible == 0) continue;
        fit.zncc += state.zncc / fit.texts;
        if (text_zncc) text_zncc[i] = static_cast<float>(state.zncc);
      }
    }
    problem.for_each_error(fit.T_t_w, [&](int i, const Vector2<double>& e) {
      const double chi2 = e.squaredNorm() * scale / (points[i].sigma * points[i].sigma);
      fit.inlier_points += chi2 <= kChiSquare95TwoDof;
      if (point_chi2) point_chi2[i] = static_cast<float>((std::min)(chi2, 1e30));
    });
  }
};

template <class View>
PoseFit refine_pose(const PoseTextTerm* texts, int text_count, const PosePointTerm* points, int point_count,
                    const View& target, const CameraView& camera, const SE3d& T_t_w, const PoseOptions& options,
                    PoseWorkspace& workspace, float* text_zncc, float* point_chi2) noexcept {
  PoseFit fit;
  fit.T_t_w = T_t_w;
  const PoseRequest request{texts, text_count, points, point_count, options, text_zncc, point_chi2};
  if (!request.valid(workspace, 1)) return fit;
  fit.status = check_camera(camera);
  if (is_ok(fit.status) && !all_finite(T_t_w)) fit.status = Status::non_finite;
  if (!is_ok(fit.status)) return fit;
  PoseProblem<View> problem(texts, text_count, points, point_count, target, camera, options, workspace);
  request.solve(problem, target.levels, fit);
  return fit;
}

template <class View>
PoseFit refine_pose(const PoseTextTerm* texts, int text_count, const PosePointTerm* points, int point_count,
                    const BasicPoseCamera<View>* cameras, int camera_count, const SE3d& T_r_w,
                    const PoseOptions& options, PoseWorkspace& workspace, float* text_zncc,
                    float* point_chi2) noexcept {
  PoseFit fit;
  fit.T_t_w = T_r_w;
  const PoseRequest request{texts, text_count, points, point_count, options, text_zncc, point_chi2};
  if (!request.valid(workspace, camera_count)) return fit;
  fit.status = check_rig(cameras, camera_count);
  if (is_ok(fit.status) && !all_finite(T_r_w)) fit.status = Status::non_finite;
  if (!is_ok(fit.status)) return fit;
  int levels = 0;
  for (int c = 0; c < camera_count; ++c) levels = (std::max)(levels, cameras[c].target.levels);
  PoseProblem<View> problem(texts, text_count, points, point_count, cameras, camera_count, options, workspace);
  request.solve(problem, levels, fit);
  return fit;
}

// The shift of the levels for the size at which the target shows the object at this pose, as far as both have levels.
template <class View>
int pose_scale_shift(const TextPatch& patch, const Vector3<double>& theta, const SE3d& T_t_h, const View& target,
                     const CameraView& camera, int finest_level) noexcept {
  Quad<double> seen;
  if (finest_level < 0 || !is_ok(project_quad(patch.quad, patch.camera, theta, T_t_h, camera, &seen))) return 0;
  const double area_in_host = patch.area > 0 ? patch.area : std::abs(area(patch.quad));
  const int shift = scale_shift(area_in_host, std::abs(area(seen)), kMaxPyramidLevels);
  const auto room = [finest_level](int levels) { return (std::max)(levels - 1 - finest_level, 0); };
  return (std::min)((std::max)(shift, -room(patch.level_count())), room(target.levels));
}

template <class View>
PoseAlignment align_pose(const TextPatch& patch, const Vector3<double>& theta, const SE3d& T_t_h, const View& target,
                         const CameraView& camera, const PoseOptions& options) {
  const int shift = pose_scale_shift(patch, theta, T_t_h, target, camera, options.finest_level);
  const PoseTextTerm term{&patch, theta, SE3d(), 1, shift};
  PoseWorkspace workspace;
  workspace.reserve(&term, 1, 0);
  const PoseFit fit =
      refine_pose<View>(&term, 1, nullptr, 0, target, camera, T_t_h, options, workspace, nullptr, nullptr);
  PoseAlignment out;
  static_cast<PoseResult&>(out) = fit;
  out.T_t_h = fit.T_t_w;
  out.scale_shift = shift;
  if (is_ok(out.status) && out.zncc < options.min_zncc) out.status = Status::diverged;
  return out;
}
}  // namespace detail

/// Refines the pose T_t_w (world to target) of one image from text objects and points, coarse to fine.
///
/// `texts`, `points`: may be null where their count is 0. `target`: pyramid of the image; may have no level where
/// there are no texts. `camera`: of the target, level 0, with its lens where the image is not undistorted, and its rows
/// where they are not taken at once (those of hosts are in their patches). `text_zncc`
/// (text_count values) and `point_chi2` (point_count values, |e|^2 / (sigma sigma_rep)^2) may be null; they receive the
/// final values, -1 for skipped terms. Every linearisation skips texts that are out of view, behind a camera, without
/// contrast, on a missing level or not finite, and points that are behind the camera or not finite. No allocation:
/// reserve `workspace` for these terms. Thread-safe for distinct workspaces.
TEXTPLANE_DEFERRED
PoseFit refine_pose(const PoseTextTerm* texts, int text_count, const PosePointTerm* points, int point_count,
                    const PyramidView& target, const CameraView& camera, const SE3d& T_t_w, const PoseOptions& options,
                    PoseWorkspace& workspace, float* text_zncc = nullptr, float* point_chi2 = nullptr) noexcept {
  return detail::refine_pose(texts, text_count, points, point_count, target, camera, T_t_w, options, workspace,
                             text_zncc, point_chi2);
}

/// The same on float images.
TEXTPLANE_DEFERRED
PoseFit refine_pose(const PoseTextTerm* texts, int text_count, const PosePointTerm* points, int point_count,
                    const PyramidViewF& target, const CameraView& camera, const SE3d& T_t_w, const PoseOptions& options,
                    PoseWorkspace& workspace, float* text_zncc = nullptr, float* point_chi2 = nullptr) noexcept {
  return detail::refine_pose(texts, text_count, points, point_count, target, camera, T_t_w, options, workspace,
                             text_zncc, point_chi2);
}

/// Refines the pose T_r_w (world to rig) of `camera_count` cameras that took their images at the same time, from the
/// terms of all of them; each term names its camera. The result's T_t_w is T_r_w, and its information is by xi of
/// T_r_w <- Exp(xi) T_r_w. Extrinsics are held. Status::invalid_argument also where there is no camera, or a term names
/// none of them; non_finite also for NaN extrinsics. All else is as for one camera, with the levels of the camera that
/// has most.
TEXTPLANE_DEFERRED
PoseFit refine_pose(const PoseTextTerm* texts, int text_count, const PosePointTerm* points, int point_count,
                    const PoseCamera* cameras, int camera_count, const SE3d& T_r_w, const PoseOptions& options,
                    PoseWorkspace& workspace, float* text_zncc = nullptr, float* point_chi2 = nullptr) noexcept {
  return detail::refine_pose<PyramidView>(texts, text_count, points, point_count, cameras, camera_count, T_r_w, options,
                                          workspace, text_zncc, point_chi2);
}

/// The same on float images.
TEXTPLANE_DEFERRED
PoseFit refine_pose(const PoseTextTerm* texts, int text_count, const PosePointTerm* points, int point_count,
                    const PoseCameraF* cameras, int camera_count, const SE3d& T_r_w, const PoseOptions& options,
                    PoseWorkspace& workspace, float* text_zncc = nullptr, float* point_chi2 = nullptr) noexcept {
  return detail::refine_pose<PyramidViewF>(texts, text_count, points, point_count, cameras, camera_count, T_r_w,
                                           options, workspace, text_zncc, point_chi2);
}

/// Pose T_t_h (host to target) of one text object with the plane `theta` (host frame), from the guess T_t_h. As
/// refine_pose() with this object alone, on levels of one scale: the sizes of patch.quad in the host and, by the guess,
/// in the target choose `scale_shift`. Status::diverged where the final ZNCC is below options.min_zncc: the iteration
/// found a minimum, but not this object. Allocates its own workspace.
TEXTPLANE_DEFERRED
PoseAlignment align_pose(const TextPatch& patch, const Vector3<double>& theta, const SE3d& T_t_h,
                         const PyramidView& target, const CameraView& camera, const PoseOptions& options = {}) {
  return detail::align_pose(patch, theta, T_t_h, target, camera, options);
}

/// The same on a float image.
TEXTPLANE_DEFERRED
PoseAlignment align_pose(const TextPatch& patch, const Vector3<double>& theta, const SE3d& T_t_h,
                         const PyramidViewF& target, const CameraView& camera, const PoseOptions& options = {}) {
  return detail::align_pose(patch, theta, T_t_h, target, camera, options);
}

TEXTPLANE_INSTANCE(PoseFit refine_pose<>(const PoseTextTerm*, int, const PosePointTerm*, int, const PyramidView&,
                                         const CameraView&, const SE3d&, const PoseOptions&, PoseWorkspace&, float*,
                                         float*) noexcept);
TEXTPLANE_INSTANCE(PoseFit refine_pose<>(const PoseTextTerm*, int, const PosePointTerm*, int, const PyramidViewF&,
                                         const CameraView&, const SE3d&, const PoseOptions&, PoseWorkspace&, float*,
                                         float*) noexcept);
TEXTPLANE_INSTANCE(PoseFit refine_pose<>(const PoseTextTerm*, int, const PosePointTerm*, int, const PoseCamera*, int,
                                         const SE3d&, const PoseOptions&, PoseWorkspace&, float*, float*) noexcept);
TEXTPLANE_INSTANCE(PoseFit refine_pose<>(const PoseTextTerm*, int, const PosePointTerm*, int, const PoseCameraF*, int,
                                         const SE3d&, const PoseOptions&, PoseWorkspace&, float*, float*) noexcept);
TEXTPLANE_INSTANCE(PoseAlignment align_pose<>(const TextPatch&, const Vector3<double>&, const SE3d&, const PyramidView&,
                                              const CameraView&, const PoseOptions&));
TEXTPLANE_INSTANCE(PoseAlignment align_pose<>(const TextPatch&, const Vector3<double>&, const SE3d&,
                                              const PyramidViewF&, const CameraView&, const PoseOptions&));

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_POSE_HPP
