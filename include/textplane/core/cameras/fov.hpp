// The FOV camera (Devernay, Faugeras: Straight lines have to be straight, 2001; PTAM's, DSO's and kalibr's fov): a
// fisheye of one coefficient whose inverse is in closed form.
#ifndef TEXTPLANE_CORE_CAMERAS_FOV_HPP
#define TEXTPLANE_CORE_CAMERAS_FOV_HPP

#include <cmath>

#include "textplane/core/cameras/lens.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// pixel = pinhole pixel of m_d,   m_d = (x, y)/R atan2(2 tan(omega/2) R, z) / omega,   R = |(x, y)|.
///
/// Its domain is all but the axis behind the camera; with omega = 0, where it is a pinhole, what lies in front.
template <class S>
struct Fov {
  static constexpr int kParameters = 5;        ///< fx fy cx cy omega.
  static constexpr const char* kName = "fov";  ///< Of the model.

  Pinhole<S> intrinsics;  ///< fx fy cx cy. In the centre the image is scaled by fx 2 tan(omega/2) / omega.
  S omega = S(0);         ///< Angle of view of an ideal lens, rad, at least 0 and below pi.

  /// Of fx fy cx cy omega.
  static Fov from_parameters(const Eigen::Matrix<S, 5, 1>& p) noexcept { return {{p[0], p[1], p[2], p[3]}, p[4]}; }
  /// fx fy cx cy omega.
  Eigen::Matrix<S, 5, 1> parameters() const noexcept { return detail::camera_parameters(intrinsics, omega); }

  /// Finite, with positive focal lengths and 0 <= omega < pi.
  bool valid() const noexcept {
    return intrinsics.valid() && all_finite(parameters()) && omega >= S(0) && omega < pi();
  }
  /// As said above.
  bool in_domain(const Vector3<S>& p) const noexcept {
    const S a = Tangent(omega).ratio * omega;
    return all_finite(p) && (p[2] > S(0) || a * a * (p[0] * p[0] + p[1] * p[1]) > S(0));
  }

  /// Pixel of the camera-frame point p, which is in the domain. What is given receives d pixel / d p (2 x 3) and
  /// d pixel / d parameters (2 x 5).
  Vector2<S> project(const Vector3<S>& p, FixedMatrix<S, 2, 3>* J_p = nullptr,
                     FixedMatrix<S, 2, 5>* J_parameters = nullptr) const noexcept {
    return detail::project_through(*this, p, J_p, J_parameters);
  }

  /// Ray m~ = (x/z, y/z, 1) of a pixel. Status::degenerate where there is none, or z of unproject_ray() is at most
  /// 1e-6; non_finite for NaN; then `m` is untouched.
  Status unproject(const Vector2<S>& px, Vector3<S>* m) const noexcept {
    Vector3<S> ray;
    const Status status = unproject_ray(px, &ray);
    return is_ok(status) ? detail::point_of(ray, m) : status;
  }
  /// Unit vector of a pixel's ray. Status::degenerate where no point of the domain has this pixel, non_finite for NaN;
  /// then `ray` is untouched.
  Status unproject_ray(const Vector2<S>& px, Vector3<S>* ray) const noexcept {
    if (!all_finite(px)) return Status::non_finite;
    const Vector3<S> m = intrinsics.unproject(px);
    const S angle2 = omega * omega * (m[0] * m[0] + m[1] * m[1]);
    if (!(angle2 < pi() * pi())) return Status::degenerate;
    const detail::SincCos<S> at = detail::sinc_cos(angle2);
    const S across = at.sinc / Tangent(omega).ratio;
    return detail::bearing_of(Vector3<S>(across * m[0], across * m[1], at.cosine), ray);
  }

  /// m_d of the camera-frame point p. If they are given, together, they receive its derivatives by p (2 x 3) and by
  /// omega (2 x 1).
  Vector2<S> lens(const Vector3<S>& p, FixedMatrix<S, 2, 3>* D_p = nullptr,
                  FixedMatrix<S, 2, 1>* D_k = nullptr) const noexcept {
    const Tangent t(omega);
    const S x = p[0], y = p[1], a = t.ratio * omega, R2 = x * x + y * y, far2 = a * a * R2;
    const detail::AngleRatio<S> angle = detail::angle_ratio(far2, p[2]);
    const S scale = t.ratio * angle.value;
    if (D_p) {
      const S twice = S(2) * t.ratio * angle.slope * a * a, inverse = -t.ratio / (far2 + p[2] * p[2]);
      *D_p << scale + twice * x * x, twice * x * y, x * inverse,  //
          twice * x * y, scale + twice * y * y, y * inverse;
      const S a_slope = S(1) + S(0.25) * a * a;  // d a / d omega, a = 2 tan(omega/2)
      const S by_omega = t.slope * angle.value + t.ratio * angle.slope * S(2) * a * a_slope * R2;
      *D_k << x * by_omega, y * by_omega;
    }
    return {x * scale, y * scale};
  }

  /// Distorted normalised point of m = (x/z, y/z), z > 0. If J is given it receives d m_d / d m (2 x 2).
  Vector2<S> distort(const Vector2<S>& m, FixedMatrix<S, 2, 2>* J = nullptr) const noexcept {
    return detail::distort_through(*this, m, J);
  }

  const Pinhole<S>& pinhole() const noexcept { return intrinsics; }  ///< With the same fx fy cx cy.
  bool is_pinhole() const noexcept { return omega == S(0); }         ///< Whether the lens distorts nothing.

  /// The same camera for pyramid level l: the lens stays the same.
  Fov at_level(int level) const noexcept { return {intrinsics.at_level(level), omega}; }

  /// The same of another scalar.
  template <class U>
  Fov<U> cast() const noexcept {
    return {intrinsics.template cast<U>(), U(omega)};
  }

 private:
  static S pi() noexcept { return S(3.14159265358979323846); }

  // 2 tan(omega/2) / omega and its derivative, smooth at omega = 0.
  struct Tangent {
    S ratio, slope;
    explicit Tangent(const S& omega) noexcept {
      using std::cos;
      using std::sin;
      const S square = omega * omega;
      if (square < S(1e-3)) {
        ratio = S(1) + square * (S(1. / 12) + square * (S(1. / 120) + square * S(17. / 20160)));
        slope = omega * (S(1. / 6) + square * (S(1. / 30) + square * S(17. / 3360)));
        return;
      }
      const S half = S(0.5) * omega, tangent = sin(half) / cos(half);
      ratio = S(2) * tangent / omega;
      slope = (S(1) + tangent * tangent - ratio) / omega;
    }
  };
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_FOV_HPP
