// The double sphere camera (Usenko, Demmel, Cremers: The Double Sphere Camera Model, 3DV 2018; basalt's and kalibr's
// ds): a fisheye of two coefficients whose inverse is in closed form.
#ifndef TEXTPLANE_CORE_CAMERAS_DOUBLE_SPHERE_HPP
#define TEXTPLANE_CORE_CAMERAS_DOUBLE_SPHERE_HPP

#include <cmath>

#include "textplane/core/cameras/lens.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// pixel = pinhole pixel of m_d,   m_d = (x, y) / (alpha d2 + (1 - alpha) zeta),
/// d1 = |p|, zeta = xi d1 + z, d2 = |(x, y, zeta)|.
///
/// Its domain is zeta > -w d2, with w = alpha / (1 - alpha) for alpha <= 1/2, else (1 - alpha) / alpha: as far as the
/// distance from the centre rises with the angle. The condition that the paper prints,
/// z > -(w + xi) / sqrt(2 w xi + xi^2 + 1) d1, leaves out a rim of it, or goes beyond where xi is far below 0.
template <class S>
struct DoubleSphere {
  static constexpr int kParameters = 6;                  ///< fx fy cx cy xi alpha.
  static constexpr const char* kName = "double_sphere";  ///< Of the model.

  Pinhole<S> intrinsics;  ///< fx fy cx cy. In the centre the image is scaled by fx / (1 + xi).
  S xi = S(0);            ///< Distance between the spheres, above -1 and below 1.
  S alpha = S(0);         ///< Between 0 and 1.

  /// Of fx fy cx cy xi alpha.
  static DoubleSphere from_parameters(const Eigen::Matrix<S, 6, 1>& p) noexcept {
    return {{p[0], p[1], p[2], p[3]}, p[4], p[5]};
  }
  /// fx fy cx cy xi alpha.
  Eigen::Matrix<S, 6, 1> parameters() const noexcept { return detail::camera_parameters(intrinsics, xi, alpha); }

  /// Finite, with positive focal lengths, -1 < xi < 1 and 0 <= alpha <= 1.
  bool valid() const noexcept {
    return intrinsics.valid() && all_finite(parameters()) && xi > S(-1) && xi < S(1) && alpha >= S(0) && alpha <= S(1);
  }
  /// As said above.
  bool in_domain(const Vector3<S>& p) const noexcept {
    const Spheres at(*this, p);
    return all_finite(p) && at.zeta > -detail::unified_limit(alpha) * at.d2;
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
    using std::sqrt;
    Vector3<S> q;  // towards the point from the centre of the second sphere
    const Status status = detail::unified_ray(intrinsics.unproject(px), alpha, S(1), &q);
    if (!is_ok(status)) return status;
    if (!(xi > S(-1) && xi < S(1))) return Status::degenerate;
    const S r2 = q[0] * q[0] + q[1] * q[1], z2 = q[2] * q[2];
    const S scale = (q[2] * xi + sqrt(z2 + (S(1) - xi * xi) * r2)) / (z2 + r2);
    const Vector3<S> unit(scale * q[0], scale * q[1], scale * q[2] - xi);
    if (!all_finite(unit)) return Status::degenerate;
    *ray = unit;
    return Status::ok;
  }

  /// m_d of the camera-frame point p. If they are given, together, they receive its derivatives by p (2 x 3) and by
  /// xi and alpha (2 x 2).
  Vector2<S> lens(const Vector3<S>& p, FixedMatrix<S, 2, 3>* D_p = nullptr,
                  FixedMatrix<S, 2, 2>* D_k = nullptr) const noexcept {
    const Spheres at(*this, p);
    const S w = alpha * at.d2 + (S(1) - alpha) * at.zeta;
    const S by_zeta = alpha * at.zeta / at.d2 + S(1) - alpha;  // of w, with x and y held
    const S across = alpha / at.d2 + by_zeta * xi / at.d1;
    return detail::divide_point<2, S>(p, w, {across * p[0], across * p[1], by_zeta * (xi * p[2] / at.d1 + S(1))},
                                      {by_zeta * at.d1, at.d2 - at.zeta}, D_p, D_k);
  }

  /// Distorted normalised point of m = (x/z, y/z), z > 0. If J is given it receives d m_d / d m (2 x 2).
  Vector2<S> distort(const Vector2<S>& m, FixedMatrix<S, 2, 2>* J = nullptr) const noexcept {
    return detail::distort_through(*this, m, J);
  }

  const Pinhole<S>& pinhole() const noexcept { return intrinsics; }         ///< With the same fx fy cx cy.
  bool is_pinhole() const noexcept { return xi == S(0) && alpha == S(0); }  ///< Whether the lens distorts nothing.

  /// The same camera for pyramid level l: the lens stays the same.
  DoubleSphere at_level(int level) const noexcept { return {intrinsics.at_level(level), xi, alpha}; }

  /// The same of another scalar.
  template <class U>
  DoubleSphere<U> cast() const noexcept {
    return {intrinsics.template cast<U>(), U(xi), U(alpha)};
  }

 private:
  struct Spheres {
    S d1, zeta, d2;
    Spheres(const DoubleSphere& camera, const Vector3<S>& p) noexcept {
      using std::sqrt;
      const S R2 = p[0] * p[0] + p[1] * p[1];
      d1 = sqrt(R2 + p[2] * p[2]);
      zeta = camera.xi * d1 + p[2];
      d2 = sqrt(R2 + zeta * zeta);
    }
  };
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_DOUBLE_SPHERE_HPP
