// Window: the data of a windowed bundle adjustment over key-frame poses, world points and text planes, its options and
// its summary.
//
// The cost that solve_window() (window.hpp) lowers is
//   E = sum_points rho(|px - pi(T_w_c^-1 p_w)|^2 / sigma^2)  +  sum_text weight lambda_w sum_pixels rho(r^2),
// the paper's joint cost of section V, with T_w_c <- T_w_c Exp(xi) (right perturbation, xi = (v, omega)), p_w in the
// world and theta in the text's host frame. r is the normalised photometric residual of photometry/residual.hpp through
// T_t_h = T_w_t^-1 T_w_h, and lambda_w is text_weight() of solver/weighting.hpp.
//
// Structs hold inputs first, then what the solver writes back ("out"). Nothing here owns pixels: images and patches
// must outlive the call. Indices refer to the vectors of the same Window.
#ifndef TEXTPLANE_SOLVER_WINDOW_PROBLEM_HPP
#define TEXTPLANE_SOLVER_WINDOW_PROBLEM_HPP

#include <cmath>
#include <vector>

#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/core/robust.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/core/status.hpp"
#include "textplane/photometry/patch.hpp"
#include "textplane/photometry/pyramid.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/solver/weighting.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A key frame. A frame that is not fixed needs observations that determine its pose: at least six equations from
/// points that are seen elsewhere too and from text (two a point, six a text observation). Otherwise it is left where
/// it is, its observations are left out, and `status` says too_few.
struct WindowFrame {
  SE3<double> T_w_c;   ///< Camera to world.
  bool fixed = false;  ///< Constant: part of the gauge.
  PyramidView image;   ///< May stay empty where no text observation has this frame as its target.

  /// Out. ok: adjusted, or fixed. too_few: see above. rank_deficient: adjusted, but the system at the final state
  /// leaves a direction of this pose undetermined (it moved by damping alone).
  Status status = Status::ok;
};

/// A point feature; needs at least two usable observations.
struct WindowPoint {
  Vector3<double> p_w = Vector3<double>::Zero();  ///< World.
  bool fixed = false;                             ///< Constant: its observations act on the frames alone.

  /// Out. ok; too_few: fewer than two usable observations (of a point that is not fixed), left alone; non_finite: p_w
  /// is, left alone; rank_deficient: its observations have no parallax, so that its depth moved by damping alone.
  Status status = Status::ok;
};

/// A point seen in a frame.
struct WindowPointObservation {
  int frame = -1;                                ///< Index into Window::frames: the one that sees it.
  int point = -1;                                ///< Index into Window::points.
  Vector2<double> px = Vector2<double>::Zero();  ///< Undistorted px of level 0.
  /// Standard deviation, px (1.2^octave or 2^level for points from coarser levels); see valid_sigma().
  double sigma = 1;

  /// Out: |e|^2 / sigma^2 at the final state, without the robust function, for observations that were left out too.
  /// The largest double where there is no projection.
  double chi2 = 0;
  /// Out. ok; behind_camera: at the start (left out of the solve) or at the end; non_finite or invalid_argument (sigma
  /// <= 0): left out; too_few: left out because its point or frame was.
  Status status = Status::ok;
};

/// A text object. Needs at least one usable observation in a frame other than its host.
struct WindowText {
  int host = -1;                                    ///< Frame in which theta and the patch live.
  Vector3<double> theta = Vector3<double>::Zero();  ///< -n/d in the host frame.
  const TextPatch* patch = nullptr;                 ///< Null counts as invalid_argument.
  bool fixed = false;                               ///< Constant: its observations act on the frames alone.

  /// Out: 3 x 3 covariance of theta with every free pose and point uncertain too, under the gauge of the solve.
  /// Proportional to the truth only where the weights are inverse variances (Weighting::variance). Zero for fixed and
  /// left-out texts, or where it does not exist.
  Matrix3<double> covariance = Matrix3<double>::Zero();
  /// Out: theta's own 3 x 3 block of J^T W J, that is the information with all poses held.
  Matrix3<double> information = Matrix3<double>::Zero();
  double zncc = 0;            ///< Out: mean over the observations that could be evaluated at the final state.
  int used_observations = 0;  ///< Out: how many took part to the end.
  /// Out. ok; too_few: no usable observation, left alone; non_finite, invalid_argument (patch or its camera), left
  /// alone; rank_deficient: its observations do not determine theta.
  Status status = Status::ok;
};

/// A text seen in a frame other than its host.
struct WindowTextObservation {
  int text = -1;        ///< Index into Window::texts.
  int frame = -1;       ///< Target frame, other than the host.
  double weight = 1;    ///< Of this observation, on top of lambda_w.
  int scale_shift = 0;  ///< Of photometric_input(): where the target sees the text at another size than its host.

  double zncc = 0;  ///< Out: at the final state; 0 if it could not be evaluated.
  int visible = 0;  ///< Out: visible pixels at the final state.
  /// Out. ok; the status of linearise() at the start, or where the observation dropped out later (too_few,
  /// no_contrast, behind_camera, ...); degenerate: target is host; invalid_argument: no image or no patch on this
  /// level, weight not positive; too_few also where its text or a frame was left out.
  Status status = Status::ok;
};

/// The whole problem. One pinhole camera for all frames (level 0).
struct Window {
  Pinhole<double> camera;                                  ///< Of all frames, level 0.
  std::vector<WindowFrame> frames;                         ///< Poses, the unknown ones and those held.
  std::vector<WindowPoint> points;                         ///< Points in the world.
  std::vector<WindowPointObservation> point_observations;  ///< Who sees which point where.
  std::vector<WindowText> texts;                           ///< Text objects, by host and plane.
  std::vector<WindowTextObservation> text_observations;    ///< Who sees which text.
};

/// Settings of solve_window().
struct WindowOptions {
  PhotometricOptions photometric;  ///< Of every pixel of the texts.
  Robust point_robust{RobustKind::huber,
                      std::sqrt(5.99)};  ///< On |e| / sigma: the 95 % bound of chi-square with 2 degrees of freedom.
  Weighting weighting = Weighting::variance;  ///< How texts weigh against points: lambda_w.
  double sigma_rep = 1;                       ///< px.
  double sigma_photo = 0.3;                   ///< Per pixel, in units of 1/sqrt(N).
  /// Pyramid level of patches and images; for coarse to fine call solve_window() once a level, same workspace.
  int text_level = 0;

  int max_iterations = 10;  ///< Steps tried, rejected ones included.
  /// Converged where a step lowers (or is predicted to lower) the cost by no more than this fraction.
  double cost_tolerance = 1e-6;
  /// Converged where no parameter moves by more than this fraction of its scale (rotation: rad; others: relative to
  /// distances).
  double step_tolerance = 1e-9;
  double initial_lambda = 1e-5;    ///< Marquardt damping, relative to the diagonal.
  double max_lambda = 1e10;        ///< diverged beyond.
  double max_lost_fraction = 0.1;  ///< A step that loses more of the visible text pixels is rejected.
  double min_depth = 1e-6;         ///< A point with less z than this is behind the camera (world units).

  /// Scale gauge: hold the distance between the centres of these two frames at its initial value, exactly. Needed where
  /// just one frame is fixed; allowed with more (a known baseline). Ignored where both frames are fixed; -1: no such
  /// constraint.
  int scale_frame_a = -1;
  int scale_frame_b = -1;  ///< Index into Window::frames of the other frame of that distance; -1: none.

  bool covariance = true;  ///< Compute WindowText::covariance and information, and the rank_deficient statuses.
};

/// What solve_window() did. `status`:
/// - converged, iteration_limit: the window holds the best state.
/// - too_few: nothing to adjust (no frame, or no usable observation that acts on anything free); window unchanged.
/// - rank_deficient: the gauge is missing (`gauge_freedom` > 0); window unchanged.
/// - degenerate: the two scale frames coincide; window unchanged.
/// - non_finite: camera, an option or a frame's pose; invalid_argument: index out of range, option out of its domain;
/// window unchanged.
/// - diverged: no step lowered the cost although the gradient does not vanish; window holds the best state (the start,
/// perhaps).
struct WindowSummary {
  Status status = Status::too_few;  ///< Why it ended: see above.
  double initial_cost = 0;          ///< E over what took part at the start.
  /// E at the final state. It can exceed the initial cost only where patches gained visible pixels meanwhile.
  double final_cost = 0;
  int iterations = 0;  ///< Steps tried.
  /// Steps taken; none raised the cost on the visible set of its linearisation, lost pixels charged.
  int accepted = 0;
  double last_step = 0;  ///< Scaled size of the last step taken, as step_tolerance measures it.

  /// Degrees of freedom that no fixed frame or scale takes away: 7 a free-floating component, 1 a missing scale.
  int gauge_freedom = 0;
  int free_frames = 0;         ///< Frames adjusted.
  int free_points = 0;         ///< Points solved for.
  int free_texts = 0;          ///< Texts solved for.
  int point_observations = 0;  ///< Took part.
  int text_observations = 0;   ///< Took part to the end.
  int undetermined = 0;        ///< Frames, points and texts with status rank_deficient.
  Path path = Path::kernel;    ///< Path::reference where any evaluation of a text ran on the slow reference.
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_PROBLEM_HPP
