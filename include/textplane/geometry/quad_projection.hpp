// Quads on planes: their image under a homography and in another camera, and their corners in space.
#ifndef TEXTPLANE_GEOMETRY_QUAD_PROJECTION_HPP
#define TEXTPLANE_GEOMETRY_QUAD_PROJECTION_HPP

#include <array>
#include <cstddef>

#include "textplane/core/cameras/camera_view.hpp"
#include "textplane/core/numeric.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/core/status.hpp"
#include "textplane/geometry/homography.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/quad.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// The quad under a homography of its coordinates. Status of warp() where a corner fails; *out is then untouched.
template <class S>
Status transform(const Quad<S>& quad, const Matrix3<S>& H, Quad<S>* out) noexcept {
  Quad<S> warped;
  for (std::size_t i = 0; i < 4; ++i) {
    const Status status = warp<S>(H, {quad.corner[i][0], quad.corner[i][1], S(1)}, &warped.corner[i]);
    if (!is_ok(status)) return status;
  }
  *out = warped;
  return Status::ok;
}

/// The image in the target (px) of a host quad (px) on the plane. behind_camera where a corner is not in front of both
/// cameras, non_finite for NaN or overflow, invalid_argument for a host camera without focal length; *out is then
/// untouched. Corners may lie outside the target image.
template <class S>
Status project_quad(const Quad<S>& quad, const Pinhole<S>& host, const Vector3<S>& theta, const SE3<S>& T_t_h,
                    const Pinhole<S>& target, Quad<S>* out) noexcept {
  if (host.fx == S(0) || host.fy == S(0)) return Status::invalid_argument;
  Quad<S> projected;
  for (std::size_t i = 0; i < 4; ++i) {
    Vector2<S> m;
    const Status status = warp_point<S>(theta, T_t_h, host.unproject(quad.corner[i]), &m);
    if (!is_ok(status)) return status;
    projected.corner[i] = target.pixel(m);
    if (!all_finite(projected.corner[i])) return Status::non_finite;
  }
  *out = projected;
  return Status::ok;
}

/// The same in a target that may have a lens; out_of_view where it has no pixel for a corner.
TEXTPLANE_DEFERRED
inline Status project_quad(const Quad<double>& quad, const Pinhole<double>& host, const Vector3<double>& theta,
                           const SE3d& T_t_h, const CameraView& target, Quad<double>* out) noexcept {
  Quad<double> rays;
  const Status status =
      project_quad<double>(quad, host, theta, T_t_h, target.lens ? Pinhole<double>() : target.pinhole, &rays);
  if (!is_ok(status)) return status;
  for (Vector2<double>& corner : rays.corner) {
    if (!target.lens) break;
    if (!target.in_domain({corner[0], corner[1], 1.0})) return Status::out_of_view;
    corner = target.pixel(corner);
  }
  *out = rays;
  return Status::ok;
}

/// The four corners (px) on the plane, in the host frame. behind_camera or non_finite as plane_point(),
/// invalid_argument for a host camera without focal length; *out untouched.
template <class S>
Status quad_points(const Quad<S>& quad, const Pinhole<S>& host, const Vector3<S>& theta,
                   std::array<Vector3<S>, 4>* out) noexcept {
  if (host.fx == S(0) || host.fy == S(0)) return Status::invalid_argument;
  std::array<Vector3<S>, 4> p;
  for (std::size_t i = 0; i < 4; ++i) {
    const Status status = plane_point<S>(theta, host.unproject(quad.corner[i]), &p[i]);
    if (!is_ok(status)) return status;
  }
  *out = p;
  return Status::ok;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_GEOMETRY_QUAD_PROJECTION_HPP
