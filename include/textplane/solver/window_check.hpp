// What a Window and its options must be, before anything is computed of them.
#ifndef TEXTPLANE_SOLVER_WINDOW_CHECK_HPP
#define TEXTPLANE_SOLVER_WINDOW_CHECK_HPP

#include <cstddef>

#include "textplane/solver/window_problem.hpp"
#include "textplane/solver/window_state.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace detail {

/// ok, or the status for an index or option outside its domain, or a non-finite camera or pose.
TEXTPLANE_DEFERRED
inline Status check_window(const Window& w, const WindowOptions& o) noexcept {
  const auto inside = [](int i, std::size_t n) { return i >= 0 && static_cast<std::size_t>(i) < n; };
  for (const WindowPointObservation& k : w.point_observations)
    if (!inside(k.frame, w.frames.size()) || !inside(k.point, w.points.size())) return Status::invalid_argument;
  for (const WindowTextObservation& k : w.text_observations)
    if (!inside(k.frame, w.frames.size()) || !inside(k.text, w.texts.size())) return Status::invalid_argument;
  for (const WindowText& t : w.texts)
    if (!inside(t.host, w.frames.size())) return Status::invalid_argument;
  if (o.scale_frame_a != -1 || o.scale_frame_b != -1)
    if (!inside(o.scale_frame_a, w.frames.size()) || !inside(o.scale_frame_b, w.frames.size()) ||
        o.scale_frame_a == o.scale_frame_b)
      return Status::invalid_argument;
  for (double x : {o.sigma_rep, o.sigma_photo, o.initial_lambda, o.max_lambda, o.min_depth, o.cost_tolerance,
                   o.step_tolerance, o.max_lost_fraction})
    if (!is_finite(x)) return Status::non_finite;
  if (!o.point_robust.valid() || !valid_sigma(o.sigma_rep) || !valid_sigma(o.sigma_photo) || !(o.initial_lambda > 0) ||
      !(o.max_lambda >= o.initial_lambda) || !(o.min_depth > 0) || o.max_iterations < 0 || !(o.cost_tolerance >= 0) ||
      !(o.step_tolerance >= 0) || !(o.max_lost_fraction >= 0) || o.text_level < 0 || o.text_level >= kMaxPyramidLevels)
    return Status::invalid_argument;
  bool has_rig = false, moves = false;
  for (const WindowFrame& f : w.frames) {
    if (!all_finite(f.T_w_c) || !all_finite(f.T_b_c)) return Status::non_finite;
    if (f.base != -1 && (!inside(f.base, w.frames.size()) || at(w.frames, f.base).base != -1))
      return Status::invalid_argument;
    if ((f.camera && !f.camera->valid()) || (w.calibration && (f.camera || f.base != -1)))
      return Status::invalid_argument;
    if (f.rows && !f.rows->valid()) return Status::invalid_argument;
    has_rig = has_rig || f.base != -1 || f.camera;
    for (int i = 0; i < 6; ++i) {
      moves = moves || f.velocity_sigma[i] != 0;
      if (f.velocity_sigma[i] > 0 && !valid_prior_sigma(f.velocity_sigma[i])) return Status::invalid_argument;
    }
  }
  if (has_rig && moves) return Status::invalid_argument;
  for (const int f : {o.scale_frame_a, o.scale_frame_b})
    if (f != -1 && at(w.frames, f).base != -1) return Status::invalid_argument;
  if (w.calibration) return CalibrationUnknowns().set(w.calibration);
  const Pinhole<double>& c = w.camera.pinhole;
  if (!all_finite(Vector2<double>(c.fx, c.fy)) || !all_finite(Vector2<double>(c.cx, c.cy))) return Status::non_finite;
  return w.camera.valid() ? Status::ok : Status::invalid_argument;
}

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_CHECK_HPP
