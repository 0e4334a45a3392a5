// Points from their rays in two or more views of known pose.
//
// The start is the point nearest to all rays (a 3 x 3 linear system), then damped Gauss-Newton on the reprojection
// error in normalised coordinates: the maximum-likelihood point for isotropic noise. float input is solved in double.
#ifndef TEXTPLANE_GEOMETRY_TRIANGULATE_HPP
#define TEXTPLANE_GEOMETRY_TRIANGULATE_HPP

#include <cmath>
#include <limits>

#include "textplane/core/numeric.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/core/status.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {

/// Reprojection error of p in all views: cost, and the normal equations. False where p is not in front of a camera.
template <class W>
struct PointSystem {
  Matrix3<W> A = Matrix3<W>::Zero();
  Vector3<W> b = Vector3<W>::Zero();
  W cost = W(0);
};
template <class W, class View>
bool point_system(const View& view, int n, const Vector3<W>& p, PointSystem<W>* system) noexcept {
  *system = PointSystem<W>();
  for (int i = 0; i < n; ++i) {
    SE3<W> T;
    Vector3<W> m;
    view(i, &T, &m);
    const Vector3<W> q = T * p;
    if (!(q[2] > W(0))) return false;
    const W iz = W(1) / q[2], u = q[0] * iz, v = q[1] * iz;
    for (int k = 0; k < 2; ++k) {
      const W x = k == 0 ? u : v;
      const Vector3<W> J = (T.R.row(k).transpose() - x * T.R.row(2).transpose()) * iz;
      const W r = x - m[k];
      system->A += J * J.transpose();
      system->b -= r * J;
      system->cost += r * r;
    }
  }
  return is_finite(system->cost);
}

/// The point nearest to all rays. degenerate where they are parallel or have one centre, to rounding.
template <class W, class View>
Status nearest_to_rays(const View& view, int n, const W& input_epsilon, Vector3<W>* point) noexcept {
  Matrix3<W> A = Matrix3<W>::Zero();
  Vector3<W> b = Vector3<W>::Zero(), first_centre = b, first_ray = b;
  W sine2 = W(0), baseline2 = W(0), extent2 = W(0);
  for (int i = 0; i < n; ++i) {
    SE3<W> T;
    Vector3<W> m;
    view(i, &T, &m);
    if (!all_finite(T) || !all_finite(m)) return Status::non_finite;
    const W length2 = m.squaredNorm();
    if (!(length2 > W(0))) return Status::invalid_argument;
    const SE3<W> T_w_c = T.inverse();
    const Vector3<W> ray = T_w_c.R * m;
    const Matrix3<W> projector = Matrix3<W>::Identity() - ray * ray.transpose() / length2;
    A += projector;
    b += projector * T_w_c.t;
    if (i == 0) {
      first_centre = T_w_c.t;
      first_ray = ray;
    }
    const W s2 = ray.cross(first_ray).squaredNorm() / (length2 * first_ray.squaredNorm());
    const W b2 = (T_w_c.t - first_centre).squaredNorm(), x2 = T_w_c.t.squaredNorm();
    if (s2 > sine2) sine2 = s2;
    if (b2 > baseline2) baseline2 = b2;
    if (x2 > extent2) extent2 = x2;
  }
  const W tolerance = W(16) * input_epsilon;
  if (!(sine2 > tolerance * tolerance) || !(baseline2 > tolerance * tolerance * extent2)) return Status::degenerate;
  const Ldlt<W, 3> start(A);
  if (!start.ok()) return Status::degenerate;
  *point = start.solve(b);
  return all_finite(*point) ? Status::ok : Status::non_finite;
}

template <class W, class View>
Status triangulate_rays(const View& view, int n, const W& input_epsilon, Vector3<W>* point,
                        Matrix3<W>* covariance) noexcept {
  Vector3<W> p;
  const Status start = nearest_to_rays(view, n, input_epsilon, &p);
  if (!is_ok(start)) return start;
  PointSystem<W> system;
  if (!point_system(view, n, p, &system)) return Status::behind_camera;

  const W epsilon = std::numeric_limits<W>::epsilon();
  W damping = W(0);
  for (int iteration = 0; iteration < 20; ++iteration) {
    Matrix3<W> damped = system.A;
    for (int k = 0; k < 3; ++k) damped(k, k) += damping * system.A(k, k);
    const Ldlt<W, 3> ldlt(damped);
    if (!ldlt.ok()) return Status::degenerate;
    const Vector3<W> step = ldlt.solve(system.b);
    PointSystem<W> trial;
    // Near the optimum the cost is a rounding error: a step may raise it by that much.
    const W rounding = W(64) * epsilon * (system.cost + W(64) * epsilon);
    const bool accepted = point_system<W>(view, n, p + step, &trial) && trial.cost <= system.cost + rounding;
    if (accepted) {
      p += step;
      system = trial;
      damping = damping / W(10);
      if (step.squaredNorm() <= W(16) * epsilon * epsilon * p.squaredNorm()) break;
    } else {
      damping = damping > W(1e-6) ? W(10) * damping : W(1e-4);
    }
  }
  const Ldlt<W, 3> ldlt(system.A);
  if (!ldlt.ok() || !all_finite(p)) return Status::degenerate;
  if (covariance) *covariance = ldlt.inverse();
  *point = p;
  return Status::ok;
}

}  // namespace detail

/// The point of the world seen as m~_i (homogeneous normalised, third entry 1) in n >= 2 views T_c_w (world to camera).
///
/// covariance (optional, 3 x 3): to first order, for noise of standard deviation 1 on each normalised coordinate;
/// multiply by sigma^2. Status: too_few (n < 2), degenerate (rays parallel or camera centres equal, to rounding),
/// behind_camera (the rays meet behind a camera), non_finite, invalid_argument; outputs are then untouched.
template <class S>
Status triangulate_views(const SE3<S>* T_c_w, const Vector3<S>* m, int n, Vector3<S>* p_w,
                         Matrix3<S>* covariance = nullptr) noexcept {
  using W = detail::Wide<S>;
  if (n < 0 || !p_w || (n > 0 && (!T_c_w || !m))) return Status::invalid_argument;
  if (n < 2) return Status::too_few;
  Vector3<W> p;
  Matrix3<W> c;
  const auto view = [&](int i, SE3<W>* T, Vector3<W>* mi) noexcept {
    *T = T_c_w[i].template cast<W>();
    *mi = m[i].template cast<W>();
  };
  const Status status = detail::triangulate_rays<W>(view, n, W(std::numeric_limits<S>::epsilon()), &p, &c);
  if (!is_ok(status)) return status;
  *p_w = p.template cast<S>();
  if (covariance) *covariance = c.template cast<S>();
  return status;
}

/// The point in frame a of one match; the two-view case of triangulate_views(), same status and covariance.
template <class S>
Status triangulate(const Vector3<S>& m_a, const Vector3<S>& m_b, const SE3<S>& T_b_a, Vector3<S>* p_a,
                   Matrix3<S>* covariance = nullptr) noexcept {
  const SE3<S> pose[2] = {SE3<S>(), T_b_a};
  const Vector3<S> m[2] = {m_a, m_b};
  return triangulate_views(pose, m, 2, p_a, covariance);
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_GEOMETRY_TRIANGULATE_HPP
