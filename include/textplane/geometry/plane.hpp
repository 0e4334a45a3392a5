// Planes as three parameters theta: conversion from and to normal and distance, depth along a ray, change of frame.
// Fits of theta to measurements are in plane_fit.hpp.
//
// A plane n^T p + d = 0 of the host camera frame is theta = -n / d, so theta^T p = 1 on the plane and the inverse depth
// of the normalised point m~ = (u, v, 1) is rho = theta^T m~ (paper, eq. 1 to 3; docs/conventions.md,
// docs/equations.md). theta has the unit of an inverse length; theta = 0 is the plane at infinity. The code published
// with the paper stores -theta.
#ifndef TEXTPLANE_GEOMETRY_PLANE_HPP
#define TEXTPLANE_GEOMETRY_PLANE_HPP

#include <cmath>
#include <limits>

#include "textplane/core/numeric.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/core/status.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// theta = -n / d of the plane n^T p + d = 0; n need not be a unit vector. Zero where d is not finite or zero: a plane
/// through the camera centre has no theta.
template <class S>
Vector3<S> plane_from_normal(const Vector3<S>& n, const S& d) noexcept {
  if (!is_finite(d) || d == S(0)) return Vector3<S>::Zero();
  return -n / d;
}

/// theta from a source that stores n / d, as the code published with the paper does.
template <class S>
Vector3<S> from_negated(const Vector3<S>& negated_theta) noexcept {
  return -negated_theta;
}

/// Unit normal towards the host camera, -theta / |theta|. theta must not be zero.
template <class S>
Vector3<S> plane_normal(const Vector3<S>& theta) noexcept {
  using std::sqrt;
  return -theta / S(sqrt(theta.squaredNorm()));
}

/// Distance of the plane from the host camera centre, 1 / |theta|. theta must not be zero.
template <class S>
S plane_distance(const Vector3<S>& theta) noexcept {
  using std::sqrt;
  return S(1) / S(sqrt(theta.squaredNorm()));
}

/// rho = theta^T m~. The plane lies in front of the camera along m~ where rho > 0.
template <class S>
S inverse_depth(const Vector3<S>& theta, const Vector3<S>& m) noexcept {
  return theta.dot(m);
}

/// The plane's point m~ / rho on the ray of m~. behind_camera where rho <= 0, non_finite for NaN; *point is then
/// untouched.
template <class S>
Status plane_point(const Vector3<S>& theta, const Vector3<S>& m, Vector3<S>* point) noexcept {
  const S rho = theta.dot(m);
  if (!is_finite(rho)) return Status::non_finite;
  if (!(rho > S(0))) return Status::behind_camera;
  const Vector3<S> p = m / rho;
  if (!all_finite(p)) return Status::non_finite;
  *point = p;
  return Status::ok;
}

/// The plane's point on the ray of m~, zero where the status form fails.
template <class S>
Vector3<S> plane_point(const Vector3<S>& theta, const Vector3<S>& m) noexcept {
  Vector3<S> p = Vector3<S>::Zero();
  plane_point(theta, m, &p);
  return p;
}

/// The same plane in the target frame: theta' = R theta / k with k = 1 + theta^T R^T t.
///
/// J_theta (3 x 3): d theta' / d theta = (I - theta' t^T) R / k. J_pose (3 x 6): d theta' / d xi for the left
/// perturbation T_t_h <- Exp(xi) T_t_h, xi = (v, omega): [-theta' theta'^T, -[theta']x]. behind_camera where k <= 0
/// (the target centre lies on the plane or beyond it), non_finite for NaN and overflow, of requested derivatives too;
/// then the outputs are untouched.
template <class S>
Status reanchor_plane(const Vector3<S>& theta, const SE3<S>& T_t_h, Vector3<S>* out, Matrix3<S>* J_theta = nullptr,
                      FixedMatrix<S, 3, 6>* J_pose = nullptr) noexcept {
  const Vector3<S> a = product(T_t_h.R, theta);
  const S k = S(1) + a.dot(T_t_h.t);
  if (!is_finite(k) || !all_finite(a)) return Status::non_finite;
  // k is the plane's distance from the target over its distance from the host: a rounding error of zero counts as zero.
  if (!(k > S(8) * std::numeric_limits<S>::epsilon())) return Status::behind_camera;
  const Vector3<S> result = a / k;
  if (!all_finite(result)) return Status::non_finite;
  Matrix3<S> by_theta, outer;
  if (J_theta) {
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) outer(r, c) = S(r == c ? 1 : 0) - result[r] * T_t_h.t[c];
    by_theta = product(outer, T_t_h.R);
    for (int i = 0; i < 9; ++i) by_theta.data()[i] /= k;
    if (!all_finite(by_theta)) return Status::non_finite;
  }
  if (J_pose) {
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) outer(r, c) = result[r] * result[c];
    if (!all_finite(outer)) return Status::non_finite;
    const Matrix3<S> cross = hat(result);
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) {
        (*J_pose)(r, c) = -outer(r, c);
        (*J_pose)(r, 3 + c) = -cross(r, c);
      }
  }
  if (J_theta) *J_theta = by_theta;
  *out = result;
  return Status::ok;
}

/// Value form of reanchor_plane(): zeros, in the Jacobians too, where the status form fails.
template <class S>
Vector3<S> reanchor_plane(const Vector3<S>& theta, const SE3<S>& T_t_h, Matrix3<S>* J_theta = nullptr,
                          FixedMatrix<S, 3, 6>* J_pose = nullptr) noexcept {
  Vector3<S> out = Vector3<S>::Zero();
  if (J_theta) J_theta->setZero();
  if (J_pose) J_pose->setZero();
  reanchor_plane(theta, T_t_h, &out, J_theta, J_pose);
  return out;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_GEOMETRY_PLANE_HPP
