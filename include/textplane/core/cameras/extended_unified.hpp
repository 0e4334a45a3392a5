// The extended unified camera (Khomutenko, Garcia, Martinet: An Enhanced Unified Camera Model, RA-L 2016; basalt's and
// kalibr's eucm): a fisheye or mirror of two coefficients whose inverse is in closed form. With beta = 1 it is the
// unified camera (Mei's without distortion, kalibr's omni) of mirror parameter alpha / (1 - alpha) and focal length
// fx / (1 - alpha).
#ifndef TEXTPLANE_CORE_CAMERAS_EXTENDED_UNIFIED_HPP
#define TEXTPLANE_CORE_CAMERAS_EXTENDED_UNIFIED_HPP

#include <cmath>

#include "textplane/core/cameras/lens.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// pixel = pinhole pixel of m_d,   m_d = (x, y) / (alpha d + (1 - alpha) z),   d = sqrt(beta (x^2 + y^2) + z^2).
///
/// Its domain is z > -w d, with w = alpha / (1 - alpha) for alpha <= 1/2, else (1 - alpha) / alpha: as far as the
/// distance from the centre rises with the angle.
template <class S>
struct ExtendedUnified {
  static constexpr int kParameters = 6;                     ///< fx fy cx cy alpha beta.
  static constexpr const char* kName = "extended_unified";  ///< Of the model.

  Pinhole<S> intrinsics;  ///< fx fy cx cy, of the centre of the image too.
  S alpha = S(0);         ///< Between 0 and 1.
  S beta = S(1);          ///< Positive.

  /// Of fx fy cx cy alpha beta.
  static ExtendedUnified from_parameters(const Eigen::Matrix<S, 6, 1>& p) noexcept {
    return {{p[0], p[1], p[2], p[3]}, p[4], p[5]};
  }
  /// fx fy cx cy alpha beta.
  Eigen::Matrix<S, 6, 1> parameters() const noexcept { return detail::camera_parameters(intrinsics, alpha, beta); }

  /// Finite, with positive focal lengths, 0 <= alpha <= 1 and beta > 0.
  bool valid() const noexcept {
    return intrinsics.valid() && all_finite(parameters()) && alpha >= S(0) && alpha <= S(1) && beta > S(0);
  }
  /// As said above.
  bool in_domain(const Vector3<S>& p) const noexcept {
    return all_finite(p) && p[2] > -detail::unified_limit(alpha) * distance(p);
  }

  /// Pixel of the camera-frame point p, which is in the domain. What is given receives d pixel / d p (2 x 3) and
  /// d pixel / d parameters (2 x 6).
  Vector2<S> project(const Vector3<S>& p, FixedMatrix<S, 2, 3>* J_p = nullptr,
                     FixedMatrix<S, 2, 6>* J_parameters = nullptr) const noexcept {
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
    Vector3<S> q;
    const Status status = detail::unified_ray(intrinsics.unproject(px), alpha, beta, &q);
    return is_ok(status) ? detail::bearing_of(q, ray) : status;
  }

  /// m_d of the camera-frame point p. If they are given, together, they receive its derivatives by p (2 x 3) and by
  /// alpha and beta (2 x 2).
  Vector2<S> lens(const Vector3<S>& p, FixedMatrix<S, 2, 3>* D_p = nullptr,
                  FixedMatrix<S, 2, 2>* D_k = nullptr) const noexcept {
    const S d = distance(p), share = alpha / d, R2 = p[0] * p[0] + p[1] * p[1];
    return detail::divide_point<2, S>(p, S(alpha * d + (S(1) - alpha) * p[2]),
                                      {share * beta * p[0], share * beta * p[1], share * p[2] + S(1) - alpha},
                                      {d - p[2], S(0.5) * share * R2}, D_p, D_k);
  }

  /// Distorted normalised point of m = (x/z, y/z), z > 0. If J is given it receives d m_d / d m (2 x 2).
  Vector2<S> distort(const Vector2<S>& m, FixedMatrix<S, 2, 2>* J = nullptr) const noexcept {
    return detail::distort_through(*this, m, J);
  }

  const Pinhole<S>& pinhole() const noexcept { return intrinsics; }  ///< With the same fx fy cx cy.
  bool is_pinhole() const noexcept { return alpha == S(0); }         ///< Whether the lens distorts nothing.

  /// The same camera for pyramid level l: the lens stays the same.
  ExtendedUnified at_level(int level) const noexcept { return {intrinsics.at_level(level), alpha, beta}; }

  /// The same of another scalar.
  template <class U>
  ExtendedUnified<U> cast() const noexcept {
    return {intrinsics.template cast<U>(), U(alpha), U(beta)};
  }

 private:
  S distance(const Vector3<S>& p) const noexcept {
    using std::sqrt;
    return sqrt(beta * (p[0] * p[0] + p[1] * p[1]) + p[2] * p[2]);
  }
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_EXTENDED_UNIFIED_HPP
