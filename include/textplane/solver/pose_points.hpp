// The points of a pose problem: reprojection errors, and what they add to the normal equations.
#ifndef TEXTPLANE_SOLVER_POSE_POINTS_HPP
#define TEXTPLANE_SOLVER_POSE_POINTS_HPP

#include "textplane/solver/pose_terms.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace detail {

struct PoseSystem {
  FixedMatrix<double, 6, 6> H = FixedMatrix<double, 6, 6>::Zero();
  Vector6<double> b = Vector6<double>::Zero();
  double cost = 0;
  Status status = Status::too_few;
};

/// A rolling shutter's left increment of T_t_w at the row that shows the point; the identity without one.
TEXTPLANE_DEFERRED
inline SE3d row_increment(const PosePointTerm& term, const CameraView& camera) noexcept {
  return camera.rows && is_finite(term.px[1]) ? camera.rows->at(term.px[1]) : SE3d();
}

/// Reprojection error e (px) of p_w. `row`: where rows are not taken at once, the left increment of T_t_w at the row
/// that shows the point, else null. False for a point that is not finite, over 89.9 degrees off the optical axis, or
/// beyond what the lens sees. J as of CameraView::project(). S is double.
template <class S>
bool reproject(const PosePointTerm& term, const SE3<S>& T_t_w, const CameraView& camera, const SE3<S>* row,
               Vector3<S>* p, Vector2<S>* e, FixedMatrix<S, 2, 3>* J = nullptr) noexcept {
  *p = T_t_w * term.p_w;
  if (row) *p = *row * *p;
  const double z = (*p)[2];
  if (!(z > 0) || !(z * z > 1e-6 * p->squaredNorm())) return false;
  if (!camera.lens) {
    *e = camera.pinhole.project(*p) - term.px;
  } else {
    if (!camera.in_domain(*p)) return false;
    *e = camera.project(*p, J) - term.px;
  }
  return is_finite((*e)[0]) && is_finite((*e)[1]) && valid_sigma(term.sigma);
}

/// Adds a point's part to the lower triangle of H, to b and to the cost. False where reproject() is.
TEXTPLANE_DEFERRED
inline bool add_point(const PosePointTerm& term, const SE3d& T_t_w, const CameraView& camera, const SE3d* row,
                      const Robust& robust, PoseSystem& system) noexcept {
  Vector3<double> p;
  Vector2<double> e;
  FixedMatrix<double, 2, 3> J;
  if (!reproject(term, T_t_w, camera, row, &p, &e, camera.lens ? &J : nullptr)) return false;
  const double information = 1.0 / (term.sigma * term.sigma), r2 = e.squaredNorm() * information;
  const double weight = robust.weight(r2) * information;
  // d e / d xi from dp = v + omega x p: the rows of J, and p x J; a pinhole's are written out, many points have one.
  const double iz = 1.0 / p[2], u = p[0] * iz, v = p[1] * iz, fx = camera.pinhole.fx, fy = camera.pinhole.fy;
  double jx[6] = {fx * iz, 0, -fx * u * iz, -fx * u * v, fx * (1 + u * u), -fx * v};
  double jy[6] = {0, fy * iz, -fy * v * iz, -fy * (1 + v * v), fy * u * v, fy * u};
  for (int i = 0; camera.lens && i < 3; ++i) {
    const int j = i < 2 ? i + 1 : 0, k = i > 0 ? i - 1 : 2;
    jx[i] = J(0, i);
    jy[i] = J(1, i);
    jx[3 + i] = p[j] * J(0, k) - p[k] * J(0, j);
    jy[3 + i] = p[j] * J(1, k) - p[k] * J(1, j);
  }
  for (double* j : {jx, jy}) {
    // By an increment before that of the row: j Ad(row).
    if (!row) break;
    const FixedMatrix<double, 6, 6> A = adjoint(*row);
    const Vector6<double> after(j);
    for (int c = 0; c < 6; ++c) {
      j[c] = 0;
      for (int r = 0; r < 6; ++r) j[c] += after[r] * A(r, c);
    }
  }
  for (int i = 0; i < 6; ++i) {
    const double wx = weight * jx[i], wy = weight * jy[i];
    system.b[i] += wx * e[0] + wy * e[1];
    for (int j = 0; j <= i; ++j) system.H(i, j) += wx * jx[j] + wy * jy[j];
  }
  system.cost += robust.rho(r2);
  return true;
}

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_POSE_POINTS_HPP
