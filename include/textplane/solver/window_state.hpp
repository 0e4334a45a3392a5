// WindowState: the parameters of a window. Landmarks are the points, then the texts: three numbers each, which the
// Schur complement eliminates.
#ifndef TEXTPLANE_SOLVER_WINDOW_STATE_HPP
#define TEXTPLANE_SOLVER_WINDOW_STATE_HPP

#include <cstddef>
#include <vector>

#include "textplane/solver/window_problem.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace detail {

// Elements and sizes by int, as Window uses it.
template <class Vector>
auto& at(Vector& v, int i) noexcept {
  return v[static_cast<std::size_t>(i)];
}
template <class Vector>
int count(const Vector& v) noexcept {
  return static_cast<int>(v.size());
}

/// The frame whose pose is the unknown: itself, or what it is fixed to.
TEXTPLANE_DEFERRED
inline int base_of(const Window& w, int frame) noexcept {
  const int base = at(w.frames, frame).base;
  return base >= 0 ? base : frame;
}
TEXTPLANE_DEFERRED
inline const CameraView& camera_of(const Window& w, int frame) noexcept {
  const CameraView* own = at(w.frames, frame).camera;
  return own ? *own : w.camera;
}
/// d xi of a camera / d xi of its base, for T_w_c <- T_w_c Exp(xi): T_w_b Exp(xi) T_b_c = T_w_c Exp(Ad(T_b_c^-1) xi).
TEXTPLANE_DEFERRED
inline FixedMatrix<double, 6, 6> base_jacobian(const WindowFrame& frame) noexcept {
  return adjoint(frame.T_b_c.inverse());
}

/// Poses, landmarks and, where it is an unknown, the camera. They are apart from the Window so that a rejected trial
/// costs nothing.
struct WindowState {
  std::vector<SE3<double>> T_w_c;
  std::vector<Vector3<double>> landmark;
  std::vector<RowMotion> rows;        ///< Of each frame.
  std::vector<PatchRows> patch_rows;  ///< Of each text, in its host.
  AnyCamera<double> camera;           ///< Of Window::calibration.
  bool camera_possible = true;  ///< False where a step led to one that is not valid(); `camera` is then the old one.

  TEXTPLANE_DEFERRED
  void read(const Window& w) {
    if (w.calibration) camera = w.calibration->camera;
    camera_possible = true;
    T_w_c.clear();
    landmark.clear();
    rows.clear();
    patch_rows.clear();
    for (const WindowFrame& f : w.frames) T_w_c.push_back(f.T_w_c);
    for (const WindowFrame& f : w.frames) rows.push_back(f.rows ? *f.rows : RowMotion());
    for (const WindowText& t : w.texts) patch_rows.push_back(t.patch ? t.patch->rows : PatchRows());
    follow_bases(w);
    for (const WindowPoint& p : w.points) landmark.push_back(p.p_w);
    for (const WindowText& t : w.texts) landmark.push_back(t.theta);
  }
  /// Gives cameras of rigs the poses that their bases have.
  TEXTPLANE_DEFERRED
  void follow_bases(const Window& w) {
    for (int f = 0; f < count(w.frames); ++f) {
      const WindowFrame& frame = at(w.frames, f);
      if (frame.base >= 0) at(T_w_c, f) = at(T_w_c, frame.base) * frame.T_b_c;
    }
  }
  TEXTPLANE_DEFERRED
  void write(Window& w) const {
    if (w.calibration) w.calibration->camera = camera;
    for (std::size_t i = 0; i < w.frames.size(); ++i) w.frames[i].T_w_c = T_w_c[i];
    for (std::size_t i = 0; i < w.frames.size(); ++i) w.frames[i].velocity = rows[i].velocity;
    for (std::size_t i = 0; i < w.points.size(); ++i) w.points[i].p_w = landmark[i];
    for (std::size_t i = 0; i < w.texts.size(); ++i) w.texts[i].theta = landmark[w.points.size() + i];
  }
};

/// Whether the velocity of the frame is an unknown, where its pose is.
TEXTPLANE_DEFERRED
inline bool has_unknown_velocity(const WindowFrame& f) noexcept {
  bool unknown = f.rows && f.rows->shutter.active();
  for (int i = 0; i < 6; ++i) unknown = unknown && f.velocity_sigma[i] > 0;
  return unknown;
}

/// What holds one connected set of frames in place.
struct WindowAnchor {
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

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_STATE_HPP
