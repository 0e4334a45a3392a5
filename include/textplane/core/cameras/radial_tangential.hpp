// The radial-tangential camera (Brown-Conrady; OpenCV's and ORB-SLAM's order of coefficients): a pinhole behind a lens
// that distorts normalised coordinates m = (x/z, y/z).
#ifndef TEXTPLANE_CORE_CAMERAS_RADIAL_TANGENTIAL_HPP
#define TEXTPLANE_CORE_CAMERAS_RADIAL_TANGENTIAL_HPP

#include <cmath>
#include <limits>

#include "textplane/core/cameras/pinhole.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// pixel = pinhole pixel of m_d,
/// m_d = m (1 + k1 r^2 + k2 r^4 + k3 r^6) + (2 p1 x y + p2 (r^2 + 2 x^2), p1 (r^2 + 2 y^2) + 2 p2 x y).
template <class S>
struct RadialTangential {
  static constexpr int kParameters = 9;  ///< fx fy cx cy k1 k2 p1 p2 k3.

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
    Eigen::Matrix<S, 9, 1> p;
    p << intrinsics.parameters(), k1, k2, p1, p2, k3;
    return p;
  }

  /// Finite, with positive focal lengths.
  bool valid() const noexcept { return intrinsics.valid() && all_finite(parameters()); }
  /// In front of the camera, where the lens does not fold over (see undistort()).
  bool in_domain(const Vector3<S>& p) const noexcept {
    if (!(p[2] > S(0))) return false;
    FixedMatrix<S, 2, 2> J;
    distort({p[0] / p[2], p[1] / p[2]}, &J);
    return J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0) > min_determinant();
  }

  /// Pixel of the camera-frame point p, which is in the domain. If J is given it receives d pixel / d p (2 x 3).
  Vector2<S> project(const Vector3<S>& p, FixedMatrix<S, 2, 3>* J = nullptr) const noexcept {
    const Vector2<S> m(p[0] / p[2], p[1] / p[2]);
    if (!J) return intrinsics.pixel(distort(m));
    FixedMatrix<S, 2, 2> D;
    const Vector2<S> distorted = distort(m, &D);
    D.row(0) *= intrinsics.fx;
    D.row(1) *= intrinsics.fy;
    Pinhole<S>().project(p, J);  // d m / d p
    *J = product(D, *J);
    return intrinsics.pixel(distorted);
  }

  /// Ray m~ = (m, 1) of a pixel: see undistort().
  Status unproject(const Vector2<S>& px, Vector3<S>* ray) const noexcept {
    Vector2<S> m;
    const Status status = undistort(intrinsics.unproject(px).template head<2>(), &m);
    if (is_ok(status)) *ray = {m[0], m[1], S(1)};
    return status;
  }

  /// Distorted normalised point of m. If J is given it receives d m_d / d m (2 x 2).
  Vector2<S> distort(const Vector2<S>& m, FixedMatrix<S, 2, 2>* J = nullptr) const noexcept {
    const S x = m[0], y = m[1], r2 = x * x + y * y;
    const S radial = S(1) + r2 * (k1 + r2 * (k2 + r2 * k3));
    if (J) {
      const S slope = S(2) * (k1 + r2 * (S(2) * k2 + r2 * S(3) * k3));  // d radial / d r^2, times 2
      const S cross = x * y * slope + S(2) * (p1 * x + p2 * y);
      *J << radial + x * x * slope + S(2) * p1 * y + S(6) * p2 * x, cross,  //
          cross, radial + y * y * slope + S(6) * p1 * y + S(2) * p2 * x;
    }
    return {x * radial + S(2) * p1 * x * y + p2 * (r2 + S(2) * x * x),
            y * radial + p1 * (r2 + S(2) * y * y) + S(2) * p2 * x * y};
  }

  /// Inverse of distort() by Newton's method. It stops one step after the residual falls below 1e-12 (float: 1e-6), so
  /// that the derivative of a dual number has settled too. Status::degenerate where the lens model folds over (its
  /// Jacobian is singular or reversed) or the iteration does not converge, non_finite for NaN; then `m` is untouched.
  Status undistort(const Vector2<S>& distorted, Vector2<S>* m) const noexcept {
    using std::abs;
    if (!all_finite(distorted)) return Status::non_finite;
    const S tolerance = std::numeric_limits<S>::epsilon() < S(1e-10) ? S(1e-12) : S(1e-6);
    Vector2<S> x = distorted;
    for (int i = 0; i < 20; ++i) {
      FixedMatrix<S, 2, 2> J;
      const Vector2<S> e = distort(x, &J) - distorted;
      const S det = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
      if (!(det > min_determinant()) || !all_finite(e)) return Status::degenerate;
      x[0] -= (J(1, 1) * e[0] - J(0, 1) * e[1]) / det;
      x[1] -= (J(0, 0) * e[1] - J(1, 0) * e[0]) / det;
      if (abs(e[0]) < tolerance && abs(e[1]) < tolerance) {
        *m = x;
        return Status::ok;
      }
    }
    return Status::degenerate;
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

 private:
  static S min_determinant() noexcept { return S(1e-6); }
};

static_assert(is_camera_model<RadialTangential<double>>::value, "textplane: RadialTangential is no camera model");

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_RADIAL_TANGENTIAL_HPP
