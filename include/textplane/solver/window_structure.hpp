// The parts of a Window that a solve uses: observations, free frames and landmarks, gauge, and block pattern.
#ifndef TEXTPLANE_SOLVER_WINDOW_STRUCTURE_HPP
#define TEXTPLANE_SOLVER_WINDOW_STRUCTURE_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

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
  /// Landmark l couples to the cameras slot_camera[slot_begin[l] .. slot_begin[l + 1]), ascending.
  std::vector<int> slot_begin;
  std::vector<int> slot_camera;
  std::vector<int> point_slot;  ///< A slot each point observation, -1 where landmark or camera is not free.
  std::vector<int> host_slot;   ///< A slot each text observation, as above.
  std::vector<int> target_slot;
  int scale_a = -1, scale_b = -1;  ///< Frames whose distance is held, or -1.
  double scale_distance = 0;
  int gauge_freedom = 0;

  int cameras() const noexcept { return count(frame_of_camera); }
  int landmarks() const noexcept { return count(landmark_free); }

  /// ok, or the status for an index or option outside its domain, or a non-finite camera or pose.
  static Status check(const Window& w, const WindowOptions& o) noexcept {
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
    if (!o.point_robust.valid() || !valid_sigma(o.sigma_rep) || !valid_sigma(o.sigma_photo) ||
        !(o.initial_lambda > 0) || !(o.max_lambda >= o.initial_lambda) || !(o.min_depth > 0) || o.max_iterations < 0 ||
        !(o.cost_tolerance >= 0) || !(o.step_tolerance >= 0) || !(o.max_lost_fraction >= 0) || o.text_level < 0 ||
        o.text_level >= kMaxPyramidLevels)
      return Status::invalid_argument;
    for (const WindowFrame& f : w.frames)
      if (!all_finite(f.T_w_c)) return Status::non_finite;
    if (!all_finite(Vector2<double>(w.camera.fx, w.camera.fy)) ||
        !all_finite(Vector2<double>(w.camera.cx, w.camera.cy)))
      return Status::non_finite;
    return w.camera.valid() ? Status::ok : Status::invalid_argument;
  }

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
      if (!at(w.frames, f).fixed && at(w.frames, f).status == Status::ok) {
        at(camera_of_frame, f) = cameras();
        frame_of_camera.push_back(f);
      }
    measure_gauge(w, o);
    lay_out(w);
    if (scale_a >= 0 && !(scale_distance > 0)) return Status::degenerate;
    if (gauge_freedom > 0) return Status::rank_deficient;
    const bool any_free = std::find(landmark_free.begin(), landmark_free.end(), 1) != landmark_free.end();
    return cameras() > 0 || any_free ? Status::ok : Status::too_few;
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
      at(equations_, o.frame) += 2;
    }
    for (int k = 0; k < count(text_active); ++k) {
      if (!at(text_active, k)) continue;
      const WindowTextObservation& o = at(w.text_observations, k);
      ++at(observations_, points + o.text);
      at(equations_, o.frame) += 6;
      at(equations_, at(w.texts, o.text).host) += 6;
    }
    for (int f = 0; f < count(w.frames); ++f) {
      WindowFrame& frame = at(w.frames, f);
      if (!frame.fixed && at(equations_, f) < 6) frame.status = Status::too_few;
    }
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
    anchors_.assign(static_cast<std::size_t>(frames), Anchor());
    for (int k = 0; k < count(point_active); ++k)
      if (at(point_active, k) && at(landmark_free, at(w.point_observations, k).point))
        join(at(w.point_observations, k).frame, frames + at(w.point_observations, k).point);
    for (int k = 0; k < count(text_active); ++k)
      if (at(text_active, k)) join(at(w.text_observations, k).frame, at(w.texts, at(w.text_observations, k).text).host);

    // A root is the smallest index of its set. Every set of interest holds a frame, so roots index frames.
    for (int f = 0; f < frames; ++f) {
      Anchor& anchor = at(anchors_, root(f));
      if (at(camera_of_frame, f) >= 0) anchor.free = true;
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
    for (const Anchor& anchor : anchors_) {
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

  // Calls f(landmark, camera, its slot) for each active observation of a free landmark by a free camera.
  template <class F>
  void for_each_coupling(const Window& w, int points, F f) {
    for (int k = 0; k < count(point_active); ++k) {
      const WindowPointObservation& o = at(w.point_observations, k);
      const int camera = at(camera_of_frame, o.frame);
      if (at(point_active, k) && at(landmark_free, o.point) && camera >= 0) f(o.point, camera, at(point_slot, k));
    }
    for (int k = 0; k < count(text_active); ++k) {
      const WindowTextObservation& o = at(w.text_observations, k);
      const int landmark = points + o.text;
      if (!at(text_active, k) || !at(landmark_free, landmark)) continue;
      const int host = at(camera_of_frame, at(w.texts, o.text).host), target = at(camera_of_frame, o.frame);
      if (host >= 0) f(landmark, host, at(host_slot, k));
      if (target >= 0) f(landmark, target, at(target_slot, k));
    }
  }

  // What holds one connected set of frames in place.
  struct Anchor {
    bool free = false;
    bool scale = false;
    int fixed_frame = -1;
    int fixed_points = 0;
    int seen[2] = {-1, -1};

    void note_fixed_point(int p) noexcept {
      if (fixed_points >= 3 || p == seen[0] || p == seen[1]) return;
      if (fixed_points < 2) seen[fixed_points] = p;
      ++fixed_points;
    }
  };

  std::vector<int> observations_, equations_, parent_, cursor_, slot_unique_;
  std::vector<Anchor> anchors_;
};

using WindowStructure = BasicWindowStructure<double>;

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_STRUCTURE_HPP
