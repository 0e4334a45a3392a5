// The Kannala-Brandt camera, as cv::fisheye, ORB-SLAM3 (KannalaBrandt8), TUM-VI and kalibr (pinhole with equidistant
// distortion) have it: the distance from the centre is a polynomial of the angle between the ray and the axis.
#ifndef TEXTPLANE_CORE_CAMERAS_KANNALA_BRANDT_HPP
#define TEXTPLANE_CORE_CAMERAS_KANNALA_BRANDT_HPP

#include "textplane/core/cameras/lens.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// pixel = pinhole pixel of m_d,   m_d = (x, y)/R (theta + k1 theta^3 + k2 theta^5 + k3 theta^7 + k4 theta^9),
/// R = |(x, y)|, theta = atan2(R, z).
///
/// Its domain ends at the angle where the polynomial stops rising, or at 180 degrees.
template <class S>
struct KannalaBrandt {
  static constexpr int kParameters = 8;                   ///< fx fy cx cy k1 k2 k3 k4.
  static constexpr const char* kName = "kannala_brandt";  ///< Of the model.

  Pinhole<S> intrinsics;  ///< Of the undistorted image.
  S k1 = S(0);            ///< Of theta^3.
  S k2 = S(0);            ///< Of theta^5.
  S k3 = S(0);            ///< Of theta^7.
  S k4 = S(0);            ///< Of theta^9.

  /// Of fx fy cx cy k1 k2 k3 k4.
  static KannalaBrandt from_parameters(const Eigen::Matrix<S, 8, 1>& p) noexcept {
    return {{p[0], p[1], p[2], p[3]}, p[4], p[5], p[6], p[7]};
  }
  /// fx fy cx cy k1 k2 k3 k4.
  Eigen::Matrix<S, 8, 1> parameters() const noexcept { return detail::camera_parameters(intrinsics, k1, k2, k3, k4); }

  /// Finite, with positive focal lengths.
  bool valid() const noexcept { return intrinsics.valid() && all_finite(parameters()); }
  /// At an angle below 180 degrees up to which the polynomial rises.
  bool in_domain(const Vector3<S>& p) const noexcept {
    const S R2 = p[0] * p[0] + p[1] * p[1];
    if (!all_finite(p) || !(R2 > S(0) || p[2] > S(0))) return false;
    const S ratio = detail::angle_ratio(R2, p[2]).value;
    return Angles{*this}.one_to_one({p[0] * ratio, p[1] * ratio}, {});
  }

  /// Pixel of the camera-frame point p, which is in the domain. What is given receives d pixel / d p (2 x 3) and
  /// d pixel / d parameters (2 x 8).
  Vector2<S> project(const Vector3<S>& p, FixedMatrix<S, 2, 3>* J_p = nullptr,
                     FixedMatrix<S, 2, 8>* J_parameters = nullptr) const noexcept {
    return detail::project_through(*this, p, J_p, J_parameters);
  }

  /// Ray m~ = (x/z, y/z, 1) of a pixel. Status::degenerate where there is none, or z of unproject_ray() is at most
  /// 1e-6; non_finite for NaN; then `m` is untouched.
  Status unproject(const Vector2<S>& px, Vector3<S>* m) const noexcept {
    Vector3<S> ray;
    const Status status = unproject_ray(px, &ray);
    return is_ok(status) ? detail::point_of(ray, m) : status;
  }
  /// Unit vector of a pixel's ray, by Newton's method to 1e-12 (float: 1e-6). Status::degenerate where no point of the
  /// domain has this pixel, non_finite for NaN; then `ray` is untouched.
  Status unproject_ray(const Vector2<S>& px, Vector3<S>* ray) const noexcept {
    Vector2<S> a;
    const Status status = detail::invert_lens(Angles{*this}, intrinsics.unproject(px).template head<2>().eval(), &a);
    if (!is_ok(status)) return status;
    const detail::SincCos<S> at = detail::sinc_cos(S(a[0] * a[0] + a[1] * a[1]));
    *ray = {a[0] * at.sinc, a[1] * at.sinc, at.cosine};
    return Status::ok;
  }

  /// m_d of the camera-frame point p. If they are given, together, they receive its derivatives by p (2 x 3) and by
  /// k1 k2 k3 k4 (2 x 4).
  Vector2<S> lens(const Vector3<S>& p, FixedMatrix<S, 2, 3>* D_p = nullptr,
                  FixedMatrix<S, 2, 4>* D_k = nullptr) const noexcept {
    const S x = p[0], y = p[1], R2 = x * x + y * y;
    const detail::AngleRatio<S> ratio = detail::angle_ratio(R2, p[2]);
    const Vector2<S> a(x * ratio.value, y * ratio.value);
    if (!D_p) return Angles{*this}.distort(a);
    FixedMatrix<S, 2, 2> J;
    const Vector2<S> distorted = Angles{*this}.distort(a, &J);
    const S twice = S(2) * ratio.slope, inverse = S(-1) / (R2 + p[2] * p[2]);
    FixedMatrix<S, 2, 3> a_by_p;
    a_by_p << ratio.value + twice * x * x, twice * x * y, x * inverse,  //
        twice * x * y, ratio.value + twice * y * y, y * inverse;
    *D_p = product(J, a_by_p);
    const S theta2 = a[0] * a[0] + a[1] * a[1];
    S power = theta2;
    for (int k = 0; k < 4; ++k, power *= theta2)
      for (int i = 0; i < 2; ++i) (*D_k)(i, k) = a[i] * power;
    return distorted;
  }

  /// Distorted normalised point of m = (x/z, y/z), z > 0. If J is given it receives d m_d / d m (2 x 2).
  Vector2<S> distort(const Vector2<S>& m, FixedMatrix<S, 2, 2>* J = nullptr) const noexcept {
    return detail::distort_through(*this, m, J);
  }

  const Pinhole<S>& pinhole() const noexcept { return intrinsics; }  ///< With the same fx fy cx cy.
  bool is_pinhole() const noexcept { return false; }                 ///< Never.

  /// The same camera for pyramid level l: the lens stays the same.
  KannalaBrandt at_level(int level) const noexcept { return {intrinsics.at_level(level), k1, k2, k3, k4}; }

  /// The same of another scalar.
  template <class U>
  KannalaBrandt<U> cast() const noexcept {
    return {intrinsics.template cast<U>(), U(k1), U(k2), U(k3), U(k4)};
  }

 private:
  // The polynomial as a lens of a = theta (x, y)/R, which is smooth on the axis.
  struct Angles {
    const KannalaBrandt& c;

    Vector2<S> distort(const Vector2<S>& a, FixedMatrix<S, 2, 2>* J = nullptr) const noexcept {
      const S t = a[0] * a[0] + a[1] * a[1];
      const S radial = S(1) + t * (c.k1 + t * (c.k2 + t * (c.k3 + t * c.k4)));
      const S slope = S(2) * (c.k1 + t * (S(2) * c.k2 + t * (S(3) * c.k3 + t * S(4) * c.k4)));
      return detail::bend(a, radial, slope, S(0), S(0), J);
    }
    bool one_to_one(const Vector2<S>& a, const FixedMatrix<S, 2, 2>&) const noexcept {
      const S slope[] = {S(1), S(3) * c.k1, S(5) * c.k2, S(7) * c.k3, S(9) * c.k4};
      const S t = a[0] * a[0] + a[1] * a[1], pi = S(3.14159265358979323846);
      return t < pi * pi && detail::positive_up_to<4>(slope, t);
    }
  };
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_KANNALA_BRANDT_HPP
