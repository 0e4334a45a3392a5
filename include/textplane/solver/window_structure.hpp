// The parts of a Window that a solve uses: observations, free frames and landmarks, gauge, and block pattern.
#ifndef TEXTPLANE_SOLVER_WINDOW_STRUCTURE_HPP
#define TEXTPLANE_SOLVER_WINDOW_STRUCTURE_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/solver/window_check.hpp"
#include "textplane/solver/window_problem.hpp"
#include "textplane/solver/window_state.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace detail {

/// S is double, see BasicWindowSchur.
template <class S>
class BasicWindowStructure {
 public:
  std::vector<std::uint8_t> point_active;   ///< A flag each point observation.
  std::vector<std::uint8_t> text_active;    ///< A flag each text observation.
  std::vector<std::uint8_t> landmark_used;  ///< Has active observations (fixed ones too).
  std::vector<std::uint8_t> landmark_free;  ///< Used and not fixed.
  std::vector<int> camera_of_frame;         ///< Index among the free cameras, or -1.
  std::vector<int> frame_of_camera;
  std::vector<int> velocity_of_frame;  ///< Block of the velocity, or -1 where it is no unknown.
  std::vector<int> frame_of_velocity;
  /// Landmark l couples to the blocks slot_camera[slot_begin[l] .. slot_begin[l + 1]), ascending.
  std::vector<int> slot_begin;
  std::vector<int> slot_camera;
  std::vector<int> point_slot;  ///< A slot each point observation, -1 where landmark or camera is not free.
  std::vector<int> host_slot;   ///< A slot each text observation, as above.
  std::vector<int> target_slot;
  std::vector<int> point_velocity_slot;  ///< The same for the velocities of the frames.
  std::vector<int> host_velocity_slot;
  std::vector<int> target_velocity_slot;
  int scale_a = -1, scale_b = -1;  ///< Frames whose distance is held, or -1.
  double scale_distance = 0;
  int gauge_freedom = 0;
  CalibrationUnknowns calibration;

  int cameras() const noexcept { return count(frame_of_camera); }
  /// Of six unknowns: the free cameras' poses, the velocities of their rows, then the parameters of the camera, which
  /// all free points couple to.
  int blocks() const noexcept { return parameter_block() + calibration.blocks(); }
  int parameter_block() const noexcept { return cameras() + count(frame_of_velocity); }  ///< The first of them.
  /// The slot of a landmark's coupling to block b of the camera's parameters.
  int calibration_slot(int landmark, int b) const noexcept {
    return at(slot_begin, landmark + 1) - calibration.blocks() + b;
  }
  int landmarks() const noexcept { return count(landmark_free); }

  /// Leaves out what the observations with status ok do not determine (and writes statuses), measures the gauge and
  /// lays out the blocks. Allocates where the window exceeds every earlier one.
  Status build(Window& w, const WindowOptions& o) {
    landmark_used.assign(w.points.size() + w.texts.size(), 0);
    camera_of_frame.assign(w.frames.size(), -1);
    frame_of_camera.clear();
    point_active.assign(w.point_observations.size(), 0);
    text_active.assign(w.text_observations.size(), 0);
    for (std::size_t k = 0; k < point_active.size(); ++k)
      point_active[k] = w.point_observations[k].status == Status::ok;
    for (std::size_t k = 0; k < text_active.size(); ++k) text_active[k] = w.text_observations[k].status == Status::ok;
    while (prune(w)) {
    }
    landmark_free = landmark_used;
    for (int p = 0; p < count(w.points); ++p)
      if (at(w.points, p).fixed) at(landmark_free, p) = 0;
    for (int t = 0; t < count(w.texts); ++t)
      if (at(w.texts, t).fixed) at(landmark_free, count(w.points) + t) = 0;
    for (int f = 0; f < count(w.frames); ++f)
      if (base_of(w, f) == f && !at(w.frames, f).fixed && at(w.frames, f).status == Status::ok) {
        at(camera_of_frame, f) = cameras();
        frame_of_camera.push_back(f);
      }
    for (int f = 0; f < count(w.frames); ++f) at(camera_of_frame, f) = at(camera_of_frame, base_of(w, f));
    velocity_of_frame.assign(w.frames.size(), -1);
    frame_of_velocity.clear();
    for (int f : frame_of_camera)
      if (has_unknown_velocity(at(w.frames, f))) {
        at(velocity_of_frame, f) = parameter_block();
        frame_of_velocity.push_back(f);
      }
    calibration.set(w.calibration);
    measure_gauge(w, o);
    lay_out(w);
    if (scale_a >= 0 && !(scale_distance > 0)) return Status::degenerate;
    if (gauge_freedom > 0) return Status::rank_deficient;
    const bool any_free = std::find(landmark_free.begin(), landmark_free.end(), 1) != landmark_free.end();
    return blocks() > 0 || any_free ? Status::ok : Status::too_few;
  }

 private:
  // One pass of leaving out what the rest does not determine. Whether it left out anything.
  bool prune(Window& w) {
    observations_.assign(landmark_used.size(), 0);
    equations_.assign(w.frames.size(), 0);
    const int points = count(w.points);
    for (int k = 0; k < count(point_active); ++k) {
      if (!at(point_active, k)) continue;
      const WindowPointObservation& o = at(w.point_observations, k);
      ++at(observations_, o.point);
      count_equations(w, o.frame, 2);
    }
    for (int k = 0; k < count(text_active); ++k) {
      if (!at(text_active, k)) continue;
      const WindowTextObservation& o = at(w.text_observations, k);
      ++at(observations_, points + o.text);
      if (base_of(w, o.frame) == base_of(w, at(w.texts, o.text).host)) continue;
      count_equations(w, o.frame, 6);
      count_equations(w, at(w.texts, o.text).host, 6);
    }
    for (int f = 0; f < count(w.frames); ++f) {
      WindowFrame& frame = at(w.frames, f);
      if (base_of(w, f) == f && !frame.fixed && at(equations_, f) < 6) frame.status = Status::too_few;
    }
    for (int f = 0; f < count(w.frames); ++f) at(w.frames, f).status = at(w.frames, base_of(w, f)).status;
    for (int p = 0; p < points; ++p) {
      WindowPoint& point = at(w.points, p);
      if (!point.fixed && at(observations_, p) < 2 && point.status == Status::ok) point.status = Status::too_few;
      at(landmark_used, p) = point.status == Status::ok && at(observations_, p) > 0;
    }
    for (int t = 0; t < count(w.texts); ++t) {
      WindowText& text = at(w.texts, t);
      if (at(observations_, points + t) == 0 && text.status == Status::ok) text.status = Status::too_few;
      at(landmark_used, points + t) = text.status == Status::ok;
    }
    bool changed = false;
    for (int k = 0; k < count(point_active); ++k) {
      WindowPointObservation& o = at(w.point_observations, k);
      if (!at(point_active, k) || (at(w.frames, o.frame).status == Status::ok && at(landmark_used, o.point))) continue;
      at(point_active, k) = 0;
      o.status = Status::too_few;
      changed = true;
    }
    for (int k = 0; k < count(text_active); ++k) {
      WindowTextObservation& o = at(w.text_observations, k);
      if (!at(text_active, k)) continue;
      const int host = at(w.texts, o.text).host;
      if (at(w.frames, o.frame).status == Status::ok && at(w.frames, host).status == Status::ok &&
          at(landmark_used, points + o.text))
        continue;
      at(text_active, k) = 0;
      o.status = Status::too_few;
      changed = true;
    }
    return changed;
  }

  // Of a frame, and of what it is fixed to.
  void count_equations(const Window& w, int frame, int n) noexcept {
    at(equations_, frame) += n;
    if (base_of(w, frame) != frame) at(equations_, base_of(w, frame)) += n;
  }

  int root(int i) noexcept {
    while (at(parent_, i) != i) i = at(parent_, i) = at(parent_, at(parent_, i));
    return i;
  }
  void join(int a, int b) noexcept {
    const int ra = root(a), rb = root(b);
    at(parent_, (std::max)(ra, rb)) = (std::min)(ra, rb);
  }

  // Counts the degrees of freedom that nothing fixes, for each set of frames that landmarks connect.
  void measure_gauge(const Window& w, const WindowOptions& o) {
    const int frames = count(w.frames), points = count(w.points);
    parent_.resize(static_cast<std::size_t>(frames) + landmark_used.size());
    for (int i = 0; i < count(parent_); ++i) at(parent_, i) = i;
    anchors_.assign(static_cast<std::size_t>(frames), WindowAnchor());
    for (int k = 0; k < count(point_active); ++k)
      if (at(point_active, k) && at(landmark_free, at(w.point_observations, k).point))
        join(at(w.point_observations, k).frame, frames + at(w.point_observations, k).point);
    for (int k = 0; k < count(text_active); ++k)
      if (at(text_active, k)) join(at(w.text_observations, k).frame, at(w.texts, at(w.text_observations, k).text).host);

    for (int f = 0; f < frames; ++f) join(f, base_of(w, f));

    // A root is the smallest index of its set. Every set of interest holds a frame, so roots index frames.
    for (int f = 0; f < frames; ++f) {
      WindowAnchor& anchor = at(anchors_, root(f));
      if (at(camera_of_frame, f) >= 0) anchor.free = true;
      // Two cameras of a rig that are apart know the scale.
      if (base_of(w, f) != f) {
        anchor.scale = anchor.scale || (at(equations_, f) > 0 && at(w.frames, f).T_b_c.t.norm() > 0);
        continue;
      }
      if (!at(w.frames, f).fixed || at(equations_, f) == 0) continue;
      if (anchor.fixed_frame >= 0) {
        const Vector3<S>& a = at(w.frames, anchor.fixed_frame).T_w_c.t;
        const Vector3<S>& b = at(w.frames, f).T_w_c.t;
        if ((a - b).norm() > 1e-9 * (a.norm() + b.norm())) anchor.scale = true;
      } else {
        anchor.fixed_frame = f;
      }
    }
    for (int t = 0; t < count(w.texts); ++t)
      if (at(w.texts, t).fixed && at(landmark_used, points + t)) at(anchors_, root(at(w.texts, t).host)).scale = true;
    // Fixed points anchor each set that sees them. Three leave no freedom; the factorisation finds collinear ones.
    for (int k = 0; k < count(point_active); ++k)
      if (at(point_active, k) && at(w.points, at(w.point_observations, k).point).fixed)
        at(anchors_, root(at(w.point_observations, k).frame)).note_fixed_point(at(w.point_observations, k).point);

    scale_a = scale_b = -1;
    const int a = o.scale_frame_a, b = o.scale_frame_b;
    if (a >= 0 && (at(camera_of_frame, a) >= 0 || at(camera_of_frame, b) >= 0) && root(a) == root(b)) {
      scale_a = a;
      scale_b = b;
      const Vector3<S>&from = at(w.frames, a).T_w_c.t, &to = at(w.frames, b).T_w_c.t;
      scale_distance = (to - from).norm();
      at(anchors_, root(a)).scale = true;
    }
    gauge_freedom = 0;
    for (const WindowAnchor& anchor : anchors_) {
      if (!anchor.free || anchor.fixed_points >= 3) continue;
      if (anchor.fixed_frame >= 0)
        gauge_freedom += anchor.scale || anchor.fixed_points > 0 ? 0 : 1;
      else
        gauge_freedom += (std::max)(7 - 3 * anchor.fixed_points - (anchor.scale ? 1 : 0), 1);
    }
  }

  // Slots of the free landmarks, and each observation's own.
  void lay_out(const Window& w) {
    const int points = count(w.points);
    slot_begin.assign(landmark_used.size() + 1, 0);
    point_slot.assign(point_active.size(), -1);
    host_slot.assign(text_active.size(), -1);
    target_slot.assign(text_active.size(), -1);
    point_velocity_slot.assign(point_active.size(), -1);
    host_velocity_slot.assign(text_active.size(), -1);
    target_velocity_slot.assign(text_active.size(), -1);

    // Counts and fills the ranges with duplicates, then sorts each, removes duplicates and closes the gaps.
    for_each_coupling(w, points, [&](int landmark, int, int&) { ++at(slot_begin, landmark + 1); });
    for (std::size_t l = 1; l < slot_begin.size(); ++l) slot_begin[l] += slot_begin[l - 1];
    slot_camera.assign(static_cast<std::size_t>(slot_begin.back()), -1);
    slot_unique_.assign(slot_camera.size(), -1);
    cursor_.assign(slot_begin.begin(), slot_begin.end() - 1);
    for_each_coupling(w, points,
                      [&](int landmark, int camera, int&) { at(slot_camera, at(cursor_, landmark)++) = camera; });
    int out = 0;
    for (std::size_t l = 0; l + 1 < slot_begin.size(); ++l) {
      const int first = slot_begin[l], last = slot_begin[l + 1];
      std::sort(slot_camera.begin() + first, slot_camera.begin() + last);
      slot_begin[l] = out;
      for (int s = first; s < last; ++s)
        if (s == first || at(slot_camera, s) != at(slot_camera, s - 1)) at(slot_unique_, out++) = at(slot_camera, s);
    }
    slot_begin.back() = out;
    slot_unique_.resize(static_cast<std::size_t>(out));
    slot_camera.swap(slot_unique_);
    for_each_coupling(w, points, [&](int landmark, int camera, int& slot) {
      slot = at(slot_begin, landmark);
      while (at(slot_camera, slot) != camera) ++slot;
    });
  }

  // Calls f(landmark, block, its slot) for each active observation of a free landmark by a free camera, for the
  // velocity of its rows, and for the blocks of the camera's parameters, whose slots are calibration_slot().
  template <class F>
  void for_each_coupling(const Window& w, int points, F f) {
    for (int k = 0; k < count(point_active); ++k) {
      const WindowPointObservation& o = at(w.point_observations, k);
      const int camera = at(camera_of_frame, o.frame);
      if (!at(point_active, k) || !at(landmark_free, o.point)) continue;
      if (camera >= 0) f(o.point, camera, at(point_slot, k));
      const int velocity = at(velocity_of_frame, o.frame);
      if (velocity >= 0) f(o.point, velocity, at(point_velocity_slot, k));
      for (int b = parameter_block(), known = 0; b < blocks(); ++b) f(o.point, b, known);
    }
    for (int k = 0; k < count(text_active); ++k) {
      const WindowTextObservation& o = at(w.text_observations, k);
      const int landmark = points + o.text;
      if (!at(text_active, k) || !at(landmark_free, landmark)) continue;
      const int host = at(camera_of_frame, at(w.texts, o.text).host), target = at(camera_of_frame, o.frame);
      if (host >= 0) f(landmark, host, at(host_slot, k));
      if (target >= 0) f(landmark, target, at(target_slot, k));
      const int of_host = at(velocity_of_frame, at(w.texts, o.text).host), of_target = at(velocity_of_frame, o.frame);
      if (of_host >= 0) f(landmark, of_host, at(host_velocity_slot, k));
      if (of_target >= 0) f(landmark, of_target, at(target_velocity_slot, k));
    }
  }

  std::vector<int> observations_, equations_, parent_, cursor_, slot_unique_;
  std::vector<WindowAnchor> anchors_;
};

using WindowStructure = BasicWindowStructure<double>;

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_STRUCTURE_HPP
