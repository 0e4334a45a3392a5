// The rational camera: OpenCV's radial-tangential model of eight coefficients (CALIB_RATIONAL_MODEL), whose radial part
// is a quotient. It follows wider lenses than the polynomial alone, up to 180 degrees of view.
#ifndef TEXTPLANE_CORE_CAMERAS_RATIONAL_HPP
#define TEXTPLANE_CORE_CAMERAS_RATIONAL_HPP

#include "textplane/core/cameras/lens.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// pixel = pinhole pixel of m_d,
/// m_d = m (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
///       + (2 p1 x y + p2 (r^2 + 2 x^2), p1 (r^2 + 2 y^2) + 2 p2 x y),     m = (x, y) of norm r.
template <class S>
struct Rational {
  static constexpr int kParameters = 12;            ///< fx fy cx cy k1 k2 p1 p2 k3 k4 k5 k6.
  static constexpr const char* kName = "rational";  ///< Of the model.

  Pinhole<S> intrinsics;  ///< Of the undistorted image.
  S k1 = S(0);            ///< Of r^2 above the line.
  S k2 = S(0);            ///< Of r^4 above the line.
  S p1 = S(0);            ///< Tangential.
  S p2 = S(0);            ///< Tangential.
  S k3 = S(0);            ///< Of r^6 above the line.
  S k4 = S(0);            ///< Of r^2 below the line.
  S k5 = S(0);            ///< Of r^4 below the line.
  S k6 = S(0);            ///< Of r^6 below the line.

  /// Of fx fy cx cy k1 k2 p1 p2 k3 k4 k5 k6.
  static Rational from_parameters(const Eigen::Matrix<S, 12, 1>& p) noexcept {
    return {{p[0], p[1], p[2], p[3]}, p[4], p[5], p[6], p[7], p[8], p[9], p[10], p[11]};
  }
  /// fx fy cx cy k1 k2 p1 p2 k3 k4 k5 k6.
  Eigen::Matrix<S, 12, 1> parameters() const noexcept {
    return detail::camera_parameters(intrinsics, k1, k2, p1, p2, k3, k4, k5, k6);
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
  /// Whether the lens has neither a pole nor a fold between the centre and m: the radial part of m_d rises all the way,
  /// and the determinant of J = d m_d / d m, which distort() gives, is above 1e-6.
  bool one_to_one(const Vector2<S>& m, const FixedMatrix<S, 2, 2>& J) const noexcept {
    if (!(J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0) > S(1e-6))) return false;
    const S a[] = {S(1), k1, k2, k3}, b[] = {S(1), k4, k5, k6};
    S slope[7] = {};  // the numerator of d (r a / b) / d r, of r^2
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) slope[i + j] += S(1 + 2 * (i - j)) * a[i] * b[j];
    const S r2 = m[0] * m[0] + m[1] * m[1];
    return detail::positive_up_to<3>(b, r2) && detail::positive_up_to<6>(slope, r2);
  }

  /// Pixel of the camera-frame point p, which is in the domain. What is given receives d pixel / d p (2 x 3) and
  /// d pixel / d parameters (2 x 12).
  Vector2<S> project(const Vector3<S>& p, FixedMatrix<S, 2, 3>* J_p = nullptr,
                     FixedMatrix<S, 2, 12>* J_parameters = nullptr) const noexcept {
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
  /// k1 k2 p1 p2 k3 k4 k5 k6 (2 x 8).
  Vector2<S> lens(const Vector3<S>& p, FixedMatrix<S, 2, 3>* D_p = nullptr,
                  FixedMatrix<S, 2, 8>* D_k = nullptr) const noexcept {
    const Vector2<S> m(p[0] / p[2], p[1] / p[2]);
    if (!D_p) return distort(m);
    FixedMatrix<S, 2, 2> J;
    const Vector2<S> distorted = distort(m, &J);
    detail::chain_to_point(p, J, D_p);
    detail::tangential_columns(m, 2, D_k);
    const S r2 = m[0] * m[0] + m[1] * m[1], radial = above(r2) / below(r2);
    for (int i = 0; i < 2; ++i) {
      const S share = m[i] * r2 / below(r2);
      (*D_k)(i, 0) = share;
      (*D_k)(i, 1) = share * r2;
      (*D_k)(i, 4) = share * r2 * r2;
      (*D_k)(i, 5) = -share * radial;
      (*D_k)(i, 6) = -share * radial * r2;
      (*D_k)(i, 7) = -share * radial * r2 * r2;
    }
    return distorted;
  }

  /// Distorted normalised point of m. If J is given it receives d m_d / d m (2 x 2).
  Vector2<S> distort(const Vector2<S>& m, FixedMatrix<S, 2, 2>* J = nullptr) const noexcept {
    const S r2 = m[0] * m[0] + m[1] * m[1], inverse = S(1) / below(r2), radial = above(r2) * inverse;
    const S above_slope = k1 + r2 * (S(2) * k2 + r2 * S(3) * k3), below_slope = k4 + r2 * (S(2) * k5 + r2 * S(3) * k6);
    return detail::bend(m, radial, S(S(2) * (above_slope - radial * below_slope) * inverse), p1, p2, J);
  }

  /// Inverse of distort() by Newton's method, where one_to_one() holds. It stops one step after the residual falls
  /// below 1e-12 (float: 1e-6), so that the derivative of a dual number has settled too. Status::degenerate where no
  /// such point is found, non_finite for NaN; then `m` is untouched.
  Status undistort(const Vector2<S>& distorted, Vector2<S>* m) const noexcept {
    return detail::invert_lens(*this, distorted, m);
  }

  const Pinhole<S>& pinhole() const noexcept { return intrinsics; }  ///< The camera behind the lens.
  /// Whether the lens distorts nothing.
  bool is_pinhole() const noexcept { return k1 == k4 && k2 == k5 && k3 == k6 && p1 == S(0) && p2 == S(0); }

  /// The same camera for pyramid level l: the lens stays the same.
  Rational at_level(int level) const noexcept { return {intrinsics.at_level(level), k1, k2, p1, p2, k3, k4, k5, k6}; }

  /// The same of another scalar.
  template <class U>
  Rational<U> cast() const noexcept {
    return {intrinsics.template cast<U>(), U(k1), U(k2), U(p1), U(p2), U(k3), U(k4), U(k5), U(k6)};
  }

 private:
  S above(const S& r2) const noexcept { return S(1) + r2 * (k1 + r2 * (k2 + r2 * k3)); }
  S below(const S& r2) const noexcept { return S(1) + r2 * (k4 + r2 * (k5 + r2 * k6)); }
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_RATIONAL_HPP
