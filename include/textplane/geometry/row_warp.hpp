// The warp of a plane between two images whose rows are taken one after the other (core/row_motion.hpp).
//
// Over a patch the time of a row is nearly linear in the ray, so the motion between its first and its last row bends
// the warp by a matrix of rank one on either side:
//
//   q = M (R + t theta_c^T) B m~,   B = I - b_h l_h^T,   M = I + b_t l_t^T / (1 - l_t . b_t)
//
// (R, t) = E_t T_t_h E_h is the motion from the host at the row of the patch's centre to the target at the row that
// shows it, E the motion of each from there to its time stamp or back, theta_c the plane in the host at that row. l .
// m~ is the time of the ray m~ after that of the centre, and b = omega x m_c + rho_c v the motion of the centre's ray.
// What is left out is the change of b over the patch: at .5 m/s and .5 rad/s, 640 x 480 pixels and a readout of 30 ms
// .02 px on average at the worst place of a sign of 100 x 30 px. Without M and B it is .35 px.
#ifndef TEXTPLANE_GEOMETRY_ROW_WARP_HPP
#define TEXTPLANE_GEOMETRY_ROW_WARP_HPP

#include "textplane/core/cameras/camera_view.hpp"
#include "textplane/core/row_motion.hpp"
#include "textplane/geometry/plane.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// The rows of a patch in its host: when each of its rays was taken, and how the host moved meanwhile.
struct PatchRows {
  Vector6<double> velocity = Vector6<double>::Zero();  ///< Of RowMotion.
  Vector3<double> time = Vector3<double>::Zero();      ///< time . m~ is when m~ was taken: s after the time stamp.

  /// Whether rows differ in pose.
  bool active() const noexcept {
    bool moves = false, rolls = false;
    for (int i = 0; i < 6; ++i) moves = moves || velocity[i] != 0;
    for (int i = 0; i < 3; ++i) rolls = rolls || time[i] != 0;
    return moves && rolls;
  }
};

namespace detail {
// time . q / q_z is the time (s after the time stamp) of the row that shows the ray q. It is linear in q: behind a lens
// about m_c = (x, y, 1), without one everywhere. The camera is of level 0.
TEXTPLANE_DEFERRED
inline Vector3<double> row_time(const RollingShutter& shutter, const CameraView& camera,
                                const Vector3<double>& m_c) noexcept {
  const Pinhole<double>& c = camera.pinhole;
  double gx = 0, gy = c.fy, row = c.fy * m_c[1] + c.cy;
  if (camera.lens) {
    FixedMatrix<double, 2, 2> D;
    const Vector2<double> m = camera.lens->distort({m_c[0], m_c[1]}, &D);
    gx = c.fy * D(1, 0);
    gy = c.fy * D(1, 1);
    row = c.fy * m[1] + c.cy;
  }
  const double line = shutter.line();
  return {line * gx, line * gy, line * (row - shutter.row0 - gx * m_c[0] - gy * m_c[1])};
}

// omega x m + rho v.
TEXTPLANE_DEFERRED
inline Vector3<double> ray_motion(const Vector6<double>& velocity, const Vector3<double>& m, double rho) noexcept {
  Vector3<double> b;
  for (int i = 0; i < 3; ++i) {
    const int j = i < 2 ? i + 1 : 0, k = i > 0 ? i - 1 : 2;
    b[i] = velocity[3 + j] * m[k] - velocity[3 + k] * m[j] + rho * velocity[i];
  }
  return b;
}

// I + factor b l^T.
TEXTPLANE_DEFERRED
inline Matrix3<double> rank_one(double factor, const Vector3<double>& b, const Vector3<double>& l) noexcept {
  Matrix3<double> m;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) m(r, c) = (r == c ? 1 : 0) + factor * b[r] * l[c];
  return m;
}

TEXTPLANE_DEFERRED
inline double dot(const Vector3<double>& a, const Vector3<double>& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
}  // namespace detail

/// The rows of a patch about the ray `centre` (third entry 1), in an image with this motion and this camera (level 0).
TEXTPLANE_DEFERRED
inline PatchRows patch_rows(const RowMotion& motion, const CameraView& camera, const Vector3<double>& centre) noexcept {
  PatchRows rows;
  if (!motion.active()) return rows;
  rows.velocity = motion.velocity;
  rows.time = detail::row_time(motion.shutter, camera, centre);
  return rows;
}

namespace detail {
// The host's side at the row of the patch's centre, of which `centre` is the ray.
TEXTPLANE_DEFERRED
struct HostRows {
  SE3<Real> E_h;                                       ///< From that row to the time stamp.
  Vector3<Real> theta_c;                               ///< The plane at that row.
  Matrix3<Real> by_theta = Matrix3<Real>::Identity();  ///< d theta_c / d theta.
  Matrix3<Real> B = Matrix3<Real>::Identity();
};
TEXTPLANE_DEFERRED
inline HostRows<Real> host_rows(const PatchRows& rows, const Vector3<double>& theta,
                                const Vector3<double>& centre) noexcept {
  HostRows<Real> out;
  out.theta_c = theta;
  if (!rows.active()) return out;
  const double tau = dot(rows.time, centre);
  const SE3d to_row = se3_exp<double>(scaled(tau, rows.velocity));
  if (!is_ok(reanchor_plane(theta, to_row, &out.theta_c, &out.by_theta))) return out;
  out.E_h = to_row.inverse();
  const Vector3<double> l(rows.time[0], rows.time[1], rows.time[2] - tau);
  out.B = rank_one(-1, ray_motion(rows.velocity, centre, dot(out.theta_c, centre)), l);
  return out;
}
}  // namespace detail

/// C with C m~ the ray of the host at its time stamp, up to its length, to the place that the ray m~ of a patch about
/// `centre` shows, through the plane `theta` (host frame at the time stamp): theta . C m~ is the inverse depth per unit
/// of C m~. The identity where the rows are not active() or the plane passes through the camera.
TEXTPLANE_DEFERRED
inline Matrix3<double> host_row_warp(const PatchRows& rows, const Vector3<double>& theta,
                                     const Vector3<double>& centre) noexcept {
  if (!rows.active()) return Matrix3<double>::Identity();
  const detail::HostRows<Real> host = detail::host_rows(rows, theta, centre);
  Matrix3<double> G;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) G(r, c) = host.E_h.R(r, c) + host.E_h.t[r] * host.theta_c[c];
  return product(G, host.B);
}

/// The warp as the photometric kernels take it: H = R + t theta^T with an R that is no rotation. For a left increment
/// xi of T_t_h and an additive one of the plane, those of the kernels are xi' = pose xi and dtheta' = plane dtheta, to
/// first order in the motion between the patch's centre row and its other rows.
TEXTPLANE_DEFERRED
struct BasicRowWarp {
  SE3d T_t_h;                                                          ///< M R B and M t of the head of this file.
  Vector3<Real> theta;                                                 ///< B^T theta_c.
  FixedMatrix<Real, 6, 6> pose = FixedMatrix<Real, 6, 6>::Identity();  ///< Ad(E_t).
  Matrix3<Real> plane;                                                 ///< B^T d theta_c / d theta.
};
using RowWarp = BasicRowWarp<>;  ///< It is compiled only where it is used.

/// The warp of a patch about the ray `centre` of the host through the plane `theta` (host frame at the time stamp) by
/// T_t_h, which is between the time stamps. `host`: the patch's rows; `target`: the motion of the target, whose camera
/// (level 0) is `camera`. Where no row of the target shows the centre, or the plane passes through the host's camera,
/// the target's motion counts as none.
TEXTPLANE_DEFERRED
inline RowWarp row_warp(const Vector3<double>& theta, const SE3d& T_t_h, const Vector3<double>& centre,
                        const PatchRows& host, const RowMotion& target, const CameraView& camera) noexcept {
  const detail::HostRows<Real> from = detail::host_rows(host, theta, centre);
  RowWarp out;
  out.theta = transposed_product(from.B, from.theta_c);
  out.plane = transposed_product(from.B, from.by_theta);
  SE3d T = host.active() ? T_t_h * from.E_h : T_t_h;
  const double along = detail::dot(from.theta_c, centre);
  if (target.active() && along != 0) {
    const Vector3<double> p = T * Vector3<double>(centre[0] / along, centre[1] / along, centre[2] / along);
    const RowProjection seen = project_rows(target, camera, p);
    if (is_ok(seen.status)) {
      const SE3d E = target.at(seen.px[1]);
      const double rho = 1 / seen.p[2];
      const Vector3<double> m_t(seen.p[0] * rho, seen.p[1] * rho, 1);
      Vector3<double> l = detail::row_time(target.shutter, camera, m_t);
      l[2] -= detail::dot(l, m_t);
      const Vector3<double> b = detail::ray_motion(target.velocity, m_t, rho);
      const Matrix3<double> M = detail::rank_one(1 / (1 - detail::dot(l, b)), b, l);
      out.pose = adjoint(E);
      T = E * T;
      T = {product(M, T.R), product(M, T.t)};
    }
  }
  out.T_t_h = {product(T.R, from.B), T.t};
  return out;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_GEOMETRY_ROW_WARP_HPP
