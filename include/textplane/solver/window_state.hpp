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

/// Poses and landmarks. They are apart from the Window so that a rejected trial costs nothing.
struct WindowState {
  std::vector<SE3<double>> T_w_c;
  std::vector<Vector3<double>> landmark;

  void read(const Window& w) {
    T_w_c.clear();
    landmark.clear();
    for (const WindowFrame& f : w.frames) T_w_c.push_back(f.T_w_c);
    for (const WindowPoint& p : w.points) landmark.push_back(p.p_w);
    for (const WindowText& t : w.texts) landmark.push_back(t.theta);
  }
  void write(Window& w) const {
    for (std::size_t i = 0; i < w.frames.size(); ++i) w.frames[i].T_w_c = T_w_c[i];
    for (std::size_t i = 0; i < w.points.size(); ++i) w.points[i].p_w = landmark[i];
    for (std::size_t i = 0; i < w.texts.size(); ++i) w.texts[i].theta = landmark[w.points.size() + i];
  }
};

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_STATE_HPP
