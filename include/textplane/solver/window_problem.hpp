// Window: the data of a windowed bundle adjustment over key-frame poses, world points and text planes, its options and
// its summary.
//
// solve_window() (window.hpp) minimises the paper's joint cost of section V:
//   E = sum_points rho(|px - pi(T_w_c^-1 p_w)|^2 / sigma^2)  +  sum_text weight lambda_w sum_pixels rho(r^2)
// p_w is in the world, theta in the text's host frame. Poses move by T_w_c <- T_w_c Exp(xi) (right perturbation,
// xi = (v, omega)). r is the normalised photometric residual of photometry/residual.hpp through T_t_h = T_w_t^-1 T_w_h,
// lambda_w is text_weight() of solver/weighting.hpp.
//
// Structs hold inputs first, then what the solver writes back ("out"). Nothing here owns pixels: images and patches
// must outlive the call. Indices refer to the vectors of the same Window.
#ifndef TEXTPLANE_SOLVER_WINDOW_PROBLEM_HPP
#define TEXTPLANE_SOLVER_WINDOW_PROBLEM_HPP

#include <cmath>
#include <vector>

#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/core/robust.hpp"
#include "textplane/core/row_motion.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/core/status.hpp"
#include "textplane/photometry/patch.hpp"
#include "textplane/photometry/pyramid.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/solver/weighting.hpp"
#include "textplane/solver/window_calibration.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A key frame. A free frame needs at least six equations: two from each point that other frames see too, six from each
/// text observation. With fewer it stays where it is, its observations are left out, and `status` is too_few.
struct WindowFrame {
  SE3<double> T_w_c;   ///< Camera to world.
  bool fixed = false;  ///< Constant: part of the gauge.
  PyramidView image;   ///< May be empty where this frame is no text's target.
  /// How it moves while its rows are taken; null: it takes all at once. Its owner must outlive the call. T_w_c is the
  /// pose at the time stamp. Hosts of texts have the rows of their patches.
  const RowMotion* rows = nullptr;
  /// Standard deviations of the velocity rows->velocity. Where all are positive the velocity of a free frame is an
  /// unknown, and the cost gains sum_i ((velocity_i - rows->velocity_i) / sigma_i)^2; else it is known. Positive ones
  /// are valid_prior_sigma(); all are zero in a window with rigs.
  Vector6<double> velocity_sigma = Vector6<double>::Zero();

  /// Another camera of a rig: index of the frame that this one is fixed to, which has a pose of its own; -1: so has
  /// this. T_w_c is then out, the base's times T_b_c, and `fixed` is the base's; observations act on the base. A text
  /// seen by two cameras of a rig at a time says nothing of their pose.
  int base = -1;
  SE3<double> T_b_c = {};              ///< This camera to the base, held.
  const CameraView* camera = nullptr;  ///< Of this frame; null: Window::camera. Must outlive the call.

  /// Out. ok: adjusted, or fixed. too_few: see above. rank_deficient: adjusted, but a direction of this pose is
  /// undetermined at the final state (damping alone moved it).
  Status status = Status::ok;
  Vector6<double> velocity = Vector6<double>::Zero();  ///< Out: of the rows; zero without.
};

/// A point feature; needs at least two usable observations.
struct WindowPoint {
  Vector3<double> p_w = Vector3<double>::Zero();  ///< World.
  bool fixed = false;                             ///< Constant: its observations act on the frames alone.

  /// Out. ok; too_few: a free point with fewer than two usable observations, unchanged; non_finite: p_w is, unchanged;
  /// rank_deficient: its observations have no parallax (damping alone moved its depth).
  Status status = Status::ok;
};

/// A point seen in a frame.
struct WindowPointObservation {
  int frame = -1;                                ///< Index into Window::frames.
  int point = -1;                                ///< Index into Window::points.
  Vector2<double> px = Vector2<double>::Zero();  ///< px of level 0, as the camera sees it.
  /// Standard deviation, px (1.2^octave or 2^level for points from coarser levels); see valid_sigma().
  double sigma = 1;

  /// Out: |e|^2 / sigma^2 at the final state, without the robust function, also of observations that were left out.
  /// The largest double where there is no projection, or where it is beyond that.
  double chi2 = 0;
  /// Out. ok; behind_camera: at the start (left out) or at the end; non_finite or invalid_argument (sigma <= 0): left
  /// out; too_few: left out with its point or frame.
  Status status = Status::ok;
};

/// A text object. Needs at least one usable observation in a frame other than its host.
struct WindowText {
  int host = -1;                                    ///< Frame in which theta and the patch live.
  Vector3<double> theta = Vector3<double>::Zero();  ///< -n/d in the host frame.
  const TextPatch* patch = nullptr;                 ///< Null counts as invalid_argument.
  bool fixed = false;                               ///< Constant: its observations act on the frames alone.

  /// Out: marginal covariance of theta under the gauge of the solve. Proportional to the truth only where weights are
  /// inverse variances (Weighting::variance). Zero for fixed and left-out texts, or where it does not exist.
  Matrix3<double> covariance = Matrix3<double>::Zero();
  /// Out: theta's own block of J^T W J, the information with all poses held.
  Matrix3<double> information = Matrix3<double>::Zero();
  double zncc = 0;            ///< Out: mean over its used observations.
  int used_observations = 0;  ///< Out: observations used to the end.
  /// Out. ok; too_few: no usable observation, unchanged; non_finite, invalid_argument (patch or its camera): unchanged;
  /// rank_deficient: its observations do not determine theta.
  Status status = Status::ok;
};

/// A text seen in a frame other than its host.
struct WindowTextObservation {
  int text = -1;        ///< Index into Window::texts.
  int frame = -1;       ///< Target frame, other than the host.
  double weight = 1;    ///< Of this observation; multiplies lambda_w.
  int scale_shift = 0;  ///< Of photometric_input(), for targets that see the text at another size.

  double zncc = 0;  ///< Out: at the final state; 0 where it could not be evaluated.
  int visible = 0;  ///< Out: visible pixels at the final state.
  /// Out. ok; the failure of linearise() at the start or where it dropped out later (too_few, no_contrast, ...);
  /// degenerate: target is host; invalid_argument: no image or no patch on this level, weight not positive, or the
  /// camera is an unknown; too_few also where its text or a frame was left out.
  Status status = Status::ok;
};

/// The whole problem. One camera for all frames (level 0) that have none of their own, with its lens where images are
/// not undistorted. With `calibration` no frame may have a base or a camera of its own.
struct Window {
  CameraView camera;                                       ///< Level 0; where `calibration` is null.
  WindowCalibration* calibration = nullptr;                ///< The camera as an unknown; must outlive the call.
  std::vector<WindowFrame> frames;                         ///< Poses, free and fixed.
  std::vector<WindowPoint> points;                         ///< Points in the world.
  std::vector<WindowPointObservation> point_observations;  ///< Pixels of points in frames.
  std::vector<WindowText> texts;                           ///< Text objects.
  std::vector<WindowTextObservation> text_observations;    ///< Frames that see texts.
};

/// Settings of solve_window().
struct WindowOptions {
  PhotometricOptions photometric;  ///< Of every pixel of the texts.
  Robust point_robust{
      RobustKind::huber,
      std::sqrt(5.99)};  ///< On |e| / sigma: root of the 95 % bound of chi-square, 2 degrees of freedom.
  Weighting weighting = Weighting::variance;  ///< How texts weigh against points: lambda_w.
  double sigma_rep = 1;                       ///< px.
  double sigma_photo = 0.3;                   ///< Per pixel, in units of 1/sqrt(N).
  /// Pyramid level of patches and images. Coarse to fine: call solve_window() once a level, with one workspace.
  int text_level = 0;

  int max_iterations = 10;  ///< Steps tried, rejected ones included.
  /// Converged where a step lowers the cost, or is predicted to, by at most this fraction.
  double cost_tolerance = 1e-6;
  /// Converged where all parameters move by at most this fraction of their scale (1 rad; the mean depth; |theta|).
  double step_tolerance = 1e-9;
  double initial_lambda = 1e-5;    ///< Marquardt damping, relative to the diagonal.
  double max_lambda = 1e10;        ///< diverged beyond.
  double max_lost_fraction = 0.1;  ///< A step that loses more of the visible text pixels is rejected.
  double min_depth = 1e-6;         ///< World units: a point with less z is behind the camera.

  /// Scale gauge: the distance between the centres of frames a and b keeps its initial value exactly. Needed where only
  /// one frame is fixed; ignored where both frames are. -1: no such constraint.
  int scale_frame_a = -1;
  int scale_frame_b = -1;  ///< The other frame; -1: none.

  bool covariance = true;  ///< Compute WindowText::covariance and information, and the rank_deficient statuses.
};

/// What solve_window() did. `status`:
/// - converged, iteration_limit: the window holds the best state.
/// - too_few: nothing to adjust (no frame, or no usable observation of anything free); window unchanged.
/// - rank_deficient: the gauge is missing (`gauge_freedom` > 0); window unchanged.
/// - degenerate: the two scale frames coincide; window unchanged.
/// - non_finite: camera, an option, a frame's pose or T_b_c; invalid_argument: index out of range, option, camera or
/// prior out of its domain; window unchanged.
/// - diverged: no step lowered the cost although the gradient does not vanish; window holds the best state.
struct WindowSummary {
  Status status = Status::too_few;  ///< Why it ended: see above.
  double initial_cost = 0;          ///< E of the terms used at the start.
  /// E at the final state. It exceeds initial_cost only where patches gained visible pixels.
  double final_cost = 0;
  int iterations = 0;  ///< Steps tried.
  /// Steps taken; none raised the cost on the visible set of its linearisation, lost pixels charged.
  int accepted = 0;
  double last_step = 0;  ///< Scaled size of the last step taken, as step_tolerance measures it.

  /// Degrees of freedom that nothing fixes: 7 for each set of connected frames without a gauge, 1 for a missing scale.
  int gauge_freedom = 0;
  int free_frames = 0;         ///< Frames adjusted.
  int free_points = 0;         ///< Points solved for.
  int free_texts = 0;          ///< Texts solved for.
  int free_parameters = 0;     ///< Parameters of the camera solved for; fx and fy are one where they keep their ratio.
  int point_observations = 0;  ///< Used.
  int text_observations = 0;   ///< Used to the end.
  int undetermined = 0;        ///< Frames, points, texts and the camera with status rank_deficient.
  Path path = Path::kernel;    ///< Path::reference where the slow reference evaluated any text.
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_PROBLEM_HPP
