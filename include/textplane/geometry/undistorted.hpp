// Quads of a raw image as the undistorted image has them, by any lens.
//
// A lens is a camera model of core/cameras, anything else with `unproject(px, &ray)`, or a function that is called so:
// px is a Vector2<S> of the raw image, ray a Vector3<S>* of the camera frame, of any length. It returns a Status, or
// whether there is a ray.
#ifndef TEXTPLANE_GEOMETRY_UNDISTORTED_HPP
#define TEXTPLANE_GEOMETRY_UNDISTORTED_HPP

#include <cstddef>

#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"
#include "textplane/geometry/quad.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
inline Status status_of_ray(Status status) noexcept { return status; }
inline Status status_of_ray(bool has_ray) noexcept { return has_ray ? Status::ok : Status::degenerate; }

template <class Lens, class S>
auto ray_of(const Lens& lens, const Vector2<S>& px, Vector3<S>* ray, int /*preferred*/)
    -> decltype(status_of_ray(lens.unproject(px, ray))) {
  return status_of_ray(lens.unproject(px, ray));
}
template <class Lens, class S>
auto ray_of(const Lens& lens, const Vector2<S>& px, Vector3<S>* ray, long /*otherwise*/)
    -> decltype(status_of_ray(lens(px, ray))) {
  return status_of_ray(lens(px, ray));
}
}  // namespace detail

/// Pixel of the pinhole image that shows what `px` of the raw image shows. The lens's own status, degenerate for its
/// `false`, where there is no ray; behind_camera where the ray does not point forward, non_finite for NaN or overflow.
/// *out is then untouched. The pixel may lie outside the pinhole image. Throws where the lens does.
template <class S, class Lens>
Status undistorted(const Vector2<S>& px, const Lens& lens, const Pinhole<S>& pinhole, Vector2<S>* out) {
  if (!all_finite(px)) return Status::non_finite;
  Vector3<S> ray = Vector3<S>::Zero();
  const Status status = detail::ray_of(lens, px, &ray, 0);
  if (!is_ok(status)) return status;
  if (!all_finite(ray)) return Status::non_finite;
  if (!(ray[2] > S(0))) return Status::behind_camera;
  const Vector2<S> pixel = pinhole.project(ray);
  if (!all_finite(pixel)) return Status::non_finite;
  *out = pixel;
  return Status::ok;
}

/// The same for a quad: the status of its first corner that fails. Edges stay straight between the corners.
template <class S, class Lens>
Status undistorted(const Quad<S>& quad, const Lens& lens, const Pinhole<S>& pinhole, Quad<S>* out) {
  Quad<S> straight;
  for (std::size_t i = 0; i < 4; ++i) {
    const Status status = undistorted(quad.corner[i], lens, pinhole, &straight.corner[i]);
    if (!is_ok(status)) return status;
  }
  *out = straight;
  return Status::ok;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_GEOMETRY_UNDISTORTED_HPP
