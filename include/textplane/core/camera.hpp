// Cameras: the pinhole that every kernel takes, and the radial-tangential (Brown-Conrady, OpenCV and ORB-SLAM order) lens
// that turns raw pixels into pinhole pixels.
//
// Normalised coordinates m = (x/z, y/z); homogeneous m~ = (m, 1). Pixels: the centre of the top-left pixel is (0, 0).
#ifndef TEXTPLANE_CORE_CAMERA_HPP
#define TEXTPLANE_CORE_CAMERA_HPP

#include <cmath>
#include <type_traits>

#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Pinhole intrinsics in px.
template <class S>
struct Pinhole {
  static_assert(!std::is_integral<S>::value, "textplane: a camera of integers; write Pinhole<double>(500, ...)");

  S fx = S(1);  ///< Focal length along x, px.
  S fy = S(1);  ///< Focal length along y, px.
  S cx = S(0);  ///< Principal point, px.
  S cy = S(0);  ///< Likewise.

  Pinhole() = default;
  /// Focal lengths and principal point, px.
  Pinhole(S fx_, S fy_, S cx_, S cy_) noexcept : fx(fx_), fy(fy_), cx(cx_), cy(cy_) {}

  /// Finite, with positive focal lengths.
  bool valid() const noexcept {
    return is_finite(fx) && is_finite(fy) && is_finite(cx) && is_finite(cy) && fx > S(0) && fy > S(0);
  }

  /// Pixel of the normalised point m.
  Vector2<S> pixel(const Vector2<S>& m) const noexcept { return {fx * m[0] + cx, fy * m[1] + cy}; }

  /// Pixel of the camera-frame point p; the caller has checked p_z > 0. If J is given it receives d pixel / d p (2 x 3).
  Vector2<S> project(const Vector3<S>& p, Eigen::Matrix<S, 2, 3>* J = nullptr) const noexcept {
    const S iz = S(1) / p[2], u = p[0] * iz, v = p[1] * iz;
    if (J) *J << fx * iz, S(0), -fx * u * iz, S(0), fy * iz, -fy * v * iz;
    return {fx * u + cx, fy * v + cy};
  }

  /// Normalised homogeneous point m~ = ((x - cx)/fx, (y - cy)/fy, 1) of a pixel.
  Vector3<S> unproject(const Vector2<S>& px) const noexcept { return {(px[0] - cx) / fx, (px[1] - cy) / fy, S(1)}; }

  /// The same camera for pyramid level l, whose pixels are (x + 0.5)/2^l - 0.5.
  Pinhole at_level(int level) const noexcept {
    const S k = S(1) / S(1 << level);
    return {fx * k, fy * k, (cx + S(0.5)) * k - S(0.5), (cy + S(0.5)) * k - S(0.5)};
  }

  /// The same of another scalar.
  template <class U>
  Pinhole<U> cast() const noexcept {
    return {U(fx), U(fy), U(cx), U(cy)};
  }
};

/// Radial-tangential distortion of normalised coordinates, coefficients in the order k1 k2 p1 p2 k3:
/// m_d = m (1 + k1 r^2 + k2 r^4 + k3 r^6) + (2 p1 x y + p2 (r^2 + 2 x^2), p1 (r^2 + 2 y^2) + 2 p2 x y).
template <class S>
struct RadialTangential {
  S k1 = S(0);  ///< Radial, of r^2.
  S k2 = S(0);  ///< Radial, of r^4.
  S p1 = S(0);  ///< Tangential.
  S p2 = S(0);  ///< Tangential.
  S k3 = S(0);  ///< Radial, of r^6.

  /// Whether it distorts nothing.
  bool is_zero() const noexcept { return k1 == S(0) && k2 == S(0) && p1 == S(0) && p2 == S(0) && k3 == S(0); }

  /// Distorted normalised point of m. If J is given it receives d m_d / d m (2 x 2).
  Vector2<S> distort(const Vector2<S>& m, Eigen::Matrix<S, 2, 2>* J = nullptr) const noexcept {
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

  /// Inverse of distort() by Newton's method: one step beyond a residual of 1e-12 (float: 1e-6), so that the derivative of a
  /// dual number has settled too. Status::degenerate, and `m` untouched, where the lens model folds over (its Jacobian is
  /// singular or reversed) or the iteration does not settle; non_finite for NaN.
  Status undistort(const Vector2<S>& distorted, Vector2<S>* m) const noexcept {
    using std::abs;
    if (!all_finite(distorted)) return Status::non_finite;
    const S tolerance = std::numeric_limits<S>::epsilon() < S(1e-10) ? S(1e-12) : S(1e-6);
    Vector2<S> x = distorted;
    for (int i = 0; i < 20; ++i) {
      Eigen::Matrix<S, 2, 2> J;
      const Vector2<S> e = distort(x, &J) - distorted;
      const S det = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
      if (!(det > S(1e-6)) || !all_finite(e)) return Status::degenerate;
      x[0] -= (J(1, 1) * e[0] - J(0, 1) * e[1]) / det;
      x[1] -= (J(0, 0) * e[1] - J(1, 0) * e[0]) / det;
      if (abs(e[0]) < tolerance && abs(e[1]) < tolerance) {
        *m = x;
        return Status::ok;
      }
    }
    return Status::degenerate;
  }

  /// The same of another scalar.
  template <class U>
  RadialTangential<U> cast() const noexcept {
    return {U(k1), U(k2), U(p1), U(p2), U(k3)};
  }
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERA_HPP
