// The radial-tangential camera (Brown-Conrady; OpenCV's and ORB-SLAM's order of coefficients): a pinhole behind a lens
// that distorts normalised coordinates m = (x/z, y/z).
#ifndef TEXTPLANE_CORE_CAMERAS_RADIAL_TANGENTIAL_HPP
#define TEXTPLANE_CORE_CAMERAS_RADIAL_TANGENTIAL_HPP

#include "textplane/core/cameras/lens.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// pixel = pinhole pixel of m_d,
/// m_d = m (1 + k1 r^2 + k2 r^4 + k3 r^6) + (2 p1 x y + p2 (r^2 + 2 x^2), p1 (r^2 + 2 y^2) + 2 p2 x y).
template <class S>
struct RadialTangential {
  static constexpr int kParameters = 9;                      ///< fx fy cx cy k1 k2 p1 p2 k3.
  static constexpr const char* kName = "radial_tangential";  ///< Of the model.

  Pinhole<S> intrinsics;  ///< Of the undistorted image.
  S k1 = S(0);            ///< Radial, of r^2.
  S k2 = S(0);            ///< Radial, of r^4.
  S p1 = S(0);            ///< Tangential.
  S p2 = S(0);            ///< Tangential.
  S k3 = S(0);            ///< Radial, of r^6.

  /// Of fx fy cx cy k1 k2 p1 p2 k3.
  static RadialTangential from_parameters(const Eigen::Matrix<S, 9, 1>& p) noexcept {
    return {{p[0], p[1], p[2], p[3]}, p[4], p[5], p[6], p[7], p[8]};
  }
  /// fx fy cx cy k1 k2 p1 p2 k3.
  Eigen::Matrix<S, 9, 1> parameters() const noexcept {
    return detail::camera_parameters(intrinsics, k1, k2, p1, p2, k3);
  }

  /// Finite, with positive focal lengths.
  bool valid() const noexcept { return intrinsics.valid() && all_finite(parameters()); }
  /// In front of the camera, where one_to_one() holds.
  bool in_domain(const Vector3<S>& p) const noexcept {
    if (!(p[2] > S(0))) return false;
    const Vector2<S> m(p[0] / p[2], p[1] / p[2]);
    FixedMatrix<S, 2, 2> J;
    distort(m, &J);
    return one_to_one(m, J);
  }
  /// Whether the lens has not folded over between the centre and m: the radial part of m_d rises all the way, and the
  /// determinant of J = d m_d / d m, which distort() gives, is above 1e-6.
  bool one_to_one(const Vector2<S>& m, const FixedMatrix<S, 2, 2>& J) const noexcept {
    const S slope[] = {S(1), S(3) * k1, S(5) * k2, S(7) * k3};  // d (r radial) / d r, of r^2
    return J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0) > S(1e-6) &&
           detail::positive_up_to<3>(slope, S(m[0] * m[0] + m[1] * m[1]));
  }

  /// Pixel of the camera-frame point p, which is in the domain. What is given receives d pixel / d p (2 x 3) and
  /// d pixel / d parameters (2 x 9).
  Vector2<S> project(const Vector3<S>& p, FixedMatrix<S, 2, 3>* J_p = nullptr,
                     FixedMatrix<S, 2, 9>* J_parameters = nullptr) const noexcept {
    return detail::project_through(*this, p, J_p, J_parameters);
  }

  /// Ray m~ = (m, 1) of a pixel: see undistort().
  Status unproject(const Vector2<S>& px, Vector3<S>* ray) const noexcept {
    Vector2<S> m;
    const Status status = undistort(intrinsics.unproject(px).template head<2>(), &m);
    if (is_ok(status)) *ray = {m[0], m[1], S(1)};
    return status;
  }
  /// The same as a unit vector.
  Status unproject_ray(const Vector2<S>& px, Vector3<S>* ray) const noexcept {
    Vector3<S> m;
    const Status status = unproject(px, &m);
    return is_ok(status) ? detail::bearing_of(m, ray) : status;
  }

  /// m_d of the camera-frame point p. If they are given, together, they receive its derivatives by p (2 x 3) and by
  /// k1 k2 p1 p2 k3 (2 x 5).
  Vector2<S> lens(const Vector3<S>& p, FixedMatrix<S, 2, 3>* D_p = nullptr,
                  FixedMatrix<S, 2, 5>* D_k = nullptr) const noexcept {
    const Vector2<S> m(p[0] / p[2], p[1] / p[2]);
    if (!D_p) return distort(m);
    FixedMatrix<S, 2, 2> J;
    const Vector2<S> distorted = distort(m, &J);
    detail::chain_to_point(p, J, D_p);
    detail::tangential_columns(m, 2, D_k);
    const S r2 = m[0] * m[0] + m[1] * m[1];
    for (int i = 0; i < 2; ++i) {
      (*D_k)(i, 0) = m[i] * r2;
      (*D_k)(i, 1) = m[i] * r2 * r2;
      (*D_k)(i, 4) = m[i] * r2 * r2 * r2;
    }
    return distorted;
  }

  /// Distorted normalised point of m. If J is given it receives d m_d / d m (2 x 2).
  Vector2<S> distort(const Vector2<S>& m, FixedMatrix<S, 2, 2>* J = nullptr) const noexcept {
    const S r2 = m[0] * m[0] + m[1] * m[1];
    const S radial = S(1) + r2 * (k1 + r2 * (k2 + r2 * k3));
    const S slope = S(2) * (k1 + r2 * (S(2) * k2 + r2 * S(3) * k3));
    return detail::bend(m, radial, slope, p1, p2, J);
  }

  /// Inverse of distort() by Newton's method, where one_to_one() holds. It stops one step after the residual falls
  /// below 1e-12 (float: 1e-6), so that the derivative of a dual number has settled too. Status::degenerate where no
  /// such point is found, non_finite for NaN; then `m` is untouched.
  Status undistort(const Vector2<S>& distorted, Vector2<S>* m) const noexcept {
    return detail::invert_lens(*this, distorted, m);
  }

  const Pinhole<S>& pinhole() const noexcept { return intrinsics; }  ///< The camera behind the lens.
  /// Whether the lens distorts nothing.
  bool is_pinhole() const noexcept { return k1 == S(0) && k2 == S(0) && p1 == S(0) && p2 == S(0) && k3 == S(0); }

  /// The same camera for pyramid level l: the lens stays the same.
  RadialTangential at_level(int level) const noexcept { return {intrinsics.at_level(level), k1, k2, p1, p2, k3}; }

  /// The same of another scalar.
  template <class U>
  RadialTangential<U> cast() const noexcept {
    return {intrinsics.template cast<U>(), U(k1), U(k2), U(p1), U(p2), U(k3)};
  }
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_RADIAL_TANGENTIAL_HPP
