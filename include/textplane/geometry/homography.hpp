// The homography that a plane induces between two views, warped points, and their derivatives by pose and plane.
//
// H = R + t theta^T maps host to target: q = H m~ = R m~ + rho t with rho = theta^T m~, m' = q_xy / q_z (paper, eq. 4;
// docs/equations.md). H keeps its scale: q_z / rho is the depth in the target, so a sign test tells front from behind,
// and H_c_b H_b_a = H_c_a exactly when theta_b is theta_a re-anchored.
#ifndef TEXTPLANE_GEOMETRY_HOMOGRAPHY_HPP
#define TEXTPLANE_GEOMETRY_HOMOGRAPHY_HPP

#include <limits>

#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/core/numeric.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/core/status.hpp"
#include "textplane/geometry/plane.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// H = R + t theta^T, normalised host coordinates to normalised target coordinates.
template <class S>
Matrix3<S> plane_homography(const Vector3<S>& theta, const SE3<S>& T_t_h) noexcept {
  Matrix3<S> H;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) H(r, c) = T_t_h.R(r, c) + T_t_h.t[r] * theta[c];
  return H;
}

/// The inverse of plane_homography(), target to host: R^T (I - t theta'^T) with theta' the plane in the target frame.
/// Status and untouched output as reanchor_plane().
template <class S>
Status plane_homography_inverse(const Vector3<S>& theta, const SE3<S>& T_t_h, Matrix3<S>* H_h_t) noexcept {
  Vector3<S> theta_t;
  const Status status = reanchor_plane(theta, T_t_h, &theta_t);
  if (!is_ok(status)) return status;
  Matrix3<S> back;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) back(i, j) = T_t_h.R(j, i);
  const Matrix3<S> shear = Matrix3<S>::Identity() - T_t_h.t * theta_t.transpose();
  const Matrix3<S> inverse = product(back, shear);
  if (!all_finite(inverse)) return Status::non_finite;
  *H_h_t = inverse;
  return status;
}

/// The same map between pixels: K_t H K_h^-1, scale kept.
template <class S>
Matrix3<S> pixel_homography(const Matrix3<S>& H, const Pinhole<S>& host, const Pinhole<S>& target) noexcept {
  Matrix3<S> K_target, K_host_inverse;
  K_target << target.fx, S(0), target.cx, S(0), target.fy, target.cy, S(0), S(0), S(1);
  K_host_inverse << S(1) / host.fx, S(0), -host.cx / host.fx, S(0), S(1) / host.fy, -host.cy / host.fy, S(0), S(0),
      S(1);
  return K_target * H * K_host_inverse;
}

/// Image q_xy / q_z of m~ under H (normalised or px, as H is). behind_camera where q_z <= 0, non_finite for NaN or
/// overflow; *out is then untouched. The host side is not checked: see warp_point().
template <class S>
Status warp(const Matrix3<S>& H, const Vector3<S>& m, Vector2<S>* out) noexcept {
  const Vector3<S> q = product(H, m);
  if (!all_finite(q)) return Status::non_finite;
  if (!(q[2] > S(0))) return Status::behind_camera;
  const Vector2<S> warped(q[0] / q[2], q[1] / q[2]);
  if (!all_finite(warped)) return Status::non_finite;
  *out = warped;
  return Status::ok;
}

/// Derivatives of the warped normalised point m'.
template <class S>
struct WarpJacobians {
  FixedMatrix<S, 2, 6> pose;   ///< By the left perturbation of T_t_h, xi = (v, omega).
  FixedMatrix<S, 2, 3> theta;  ///< By theta.
};

/// m' of m~ through the plane. behind_camera unless both depths are positive (rho > 0, q_z > 0), non_finite for NaN and
/// overflow, of requested derivatives too; then the outputs are untouched.
///
/// dq = omega x q + rho v + t (m~ . dtheta) and dm' = P dq, P = (1/q_z) [I | -m'], so
/// pose = P [rho I, -[q]x] and theta = (P t) m~^T.
template <class S>
Status warp_point(const Vector3<S>& theta, const SE3<S>& T_t_h, const Vector3<S>& m, Vector2<S>* out,
                  WarpJacobians<S>* J = nullptr) noexcept {
  const S rho = theta.dot(m);
  const Vector3<S> q = product(T_t_h.R, m) + rho * T_t_h.t;
  if (!is_finite(rho) || !all_finite(q)) return Status::non_finite;
  if (!(rho > S(0)) || !(q[2] > S(0))) return Status::behind_camera;
  const S iz = S(1) / q[2];
  const Vector2<S> warped(q[0] * iz, q[1] * iz);
  if (!is_finite(iz) || !all_finite(warped)) return Status::non_finite;
  if (J) {
    FixedMatrix<S, 2, 3> P;
    P << iz, S(0), -warped[0] * iz, S(0), iz, -warped[1] * iz;
    WarpJacobians<S> derivatives;
    derivatives.pose.template leftCols<3>() = rho * P;
    derivatives.pose.template rightCols<3>() = -(P * hat(q));
    const Vector2<S> Pt = P * T_t_h.t;
    derivatives.theta = Pt * m.transpose();
    if (!all_finite(derivatives.pose) || !all_finite(derivatives.theta)) return Status::non_finite;
    *J = derivatives;
  }
  *out = warped;
  return Status::ok;
}

/// On which side a perturbation Exp(xi) multiplies a world pose T_w_c.
enum class PerturbationSide {
  left,   ///< T_w_c <- Exp(xi) T_w_c: xi in the world frame.
  right,  ///< T_w_c <- T_w_c Exp(xi): xi in the camera frame.
};

/// d xi / d xi_h and d xi / d xi_t, xi the left perturbation of T_t_h.
template <class S>
struct RelativePoseJacobians {
  FixedMatrix<S, 6, 6> host;    ///< d xi(T_t_h) / d xi of the host's pose.
  FixedMatrix<S, 6, 6> target;  ///< d xi(T_t_h) / d xi of the target's pose.
};

/// How perturbations of the world poses move T_t_h = T_w_t^-1 T_w_h. right: host = Ad(T_t_h), target = -I; left:
/// host = Ad(T_w_t^-1), target = -Ad(T_w_t^-1). Both are exact, not first order. A Jacobian by the left perturbation of
/// T_t_h times `host` or `target` is the Jacobian by that world pose.
template <class S>
RelativePoseJacobians<S> relative_pose_jacobians(const SE3<S>& T_w_h, const SE3<S>& T_w_t,
                                                 PerturbationSide side) noexcept {
  const SE3<S> T_t_w = T_w_t.inverse();
  RelativePoseJacobians<S> J;
  if (side == PerturbationSide::right) {
    J.host = adjoint<S>(T_t_w * T_w_h);
    J.target = -FixedMatrix<S, 6, 6>::Identity();
  } else {
    J.host = adjoint(T_t_w);
    J.target = -J.host;
  }
  return J;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_GEOMETRY_HOMOGRAPHY_HPP
