// The pinhole, the camera that every kernel takes: pixel = (fx x/z + cx, fy y/z + cy).
#ifndef TEXTPLANE_CORE_CAMERAS_PINHOLE_HPP
#define TEXTPLANE_CORE_CAMERAS_PINHOLE_HPP

#include "textplane/core/cameras/camera.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Pinhole intrinsics in px.
template <class S>
struct Pinhole {
  static_assert(!std::is_integral<S>::value, "textplane: a camera of integers; write Pinhole<double>(500, ...)");
  static constexpr int kParameters = 4;            ///< fx fy cx cy.
  static constexpr const char* kName = "pinhole";  ///< Of the model.

  S fx = S(1);  ///< Focal length along x, px.
  S fy = S(1);  ///< Focal length along y, px.
  S cx = S(0);  ///< Principal point, px.
  S cy = S(0);  ///< Likewise.

  Pinhole() = default;
  /// Focal lengths and principal point, px.
  Pinhole(S fx_, S fy_, S cx_, S cy_) noexcept : fx(fx_), fy(fy_), cx(cx_), cy(cy_) {}
  /// Of fx fy cx cy.
  static Pinhole from_parameters(const Eigen::Matrix<S, 4, 1>& p) noexcept { return {p[0], p[1], p[2], p[3]}; }
  Eigen::Matrix<S, 4, 1> parameters() const noexcept { return {fx, fy, cx, cy}; }  ///< fx fy cx cy.

  /// Finite, with positive focal lengths.
  bool valid() const noexcept { return all_finite(parameters()) && fx > S(0) && fy > S(0); }
  /// In front of the camera.
  bool in_domain(const Vector3<S>& p) const noexcept { return all_finite(p) && p[2] > S(0); }

  /// Pixel of the normalised point m = (x/z, y/z).
  Vector2<S> pixel(const Vector2<S>& m) const noexcept { return {fx * m[0] + cx, fy * m[1] + cy}; }

  /// Pixel of the camera-frame point p; the caller has checked p_z > 0. What is given receives d pixel / d p (2 x 3)
  /// and d pixel / d parameters (2 x 4).
  Vector2<S> project(const Vector3<S>& p, FixedMatrix<S, 2, 3>* J_p = nullptr,
                     FixedMatrix<S, 2, 4>* J_parameters = nullptr) const noexcept {
    const S iz = S(1) / p[2], u = p[0] * iz, v = p[1] * iz;
    if (J_p) *J_p << fx * iz, S(0), -fx * u * iz, S(0), fy * iz, -fy * v * iz;
    if (J_parameters) *J_parameters << u, S(0), S(1), S(0), S(0), v, S(0), S(1);
    return {fx * u + cx, fy * v + cy};
  }

  /// Normalised homogeneous point m~ = ((x - cx)/fx, (y - cy)/fy, 1) of a pixel.
  Vector3<S> unproject(const Vector2<S>& px) const noexcept { return {(px[0] - cx) / fx, (px[1] - cy) / fy, S(1)}; }
  /// The same; Status::non_finite for NaN.
  Status unproject(const Vector2<S>& px, Vector3<S>* m) const noexcept {
    const Vector3<S> ray = unproject(px);
    if (!all_finite(ray)) return Status::non_finite;
    *m = ray;
    return Status::ok;
  }
  /// The same as a unit vector; Status::degenerate where m~ is too long to have one.
  Status unproject_ray(const Vector2<S>& px, Vector3<S>* ray) const noexcept {
    if (!all_finite(px)) return Status::non_finite;
    return detail::bearing_of(unproject(px), ray);
  }

  /// There is no lens: m itself. If J is given it receives the identity.
  Vector2<S> distort(const Vector2<S>& m, FixedMatrix<S, 2, 2>* J = nullptr) const noexcept {
    if (J) *J << S(1), S(0), S(0), S(1);
    return m;
  }

  const Pinhole& pinhole() const noexcept { return *this; }  ///< Itself.
  bool is_pinhole() const noexcept { return true; }          ///< Always.

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

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_PINHOLE_HPP
