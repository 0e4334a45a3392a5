// Pixels and rays of a camera that may have a lens. All pixels are those of the image as it was taken.
//
// Behind a lens not every pixel has a ray, as in the dark corners of a fisheye. Corners and observations are taken only
// where there is one, so that nothing that rests on them need ask.
#ifndef TEXTSLAM_COMMON_RAYS_HPP
#define TEXTSLAM_COMMON_RAYS_HPP

#include <array>
#include <cmath>
#include <limits>

#include "textplane/core/cameras/camera_view.hpp"
#include "textslam/common/geometry.hpp"

namespace textslam {

using textplane::CameraView;

/// Where the image shows the camera-frame point p of the frame's pose: behind a rolling shutter (camera.rows), from the
/// pose of the row. False where the camera does not see it; *px is then untouched.
inline bool show(const CameraView& camera, const Vec3& p, Vec2* px) {
  if (!camera.rows) {
    if (!camera.in_domain(p)) return false;
    *px = camera.project(p);
    return true;
  }
  const textplane::RowProjection seen = textplane::project_rows(*camera.rows, camera, p);
  if (textplane::is_ok(seen.status)) *px = seen.px;
  return textplane::is_ok(seen.status);
}

/// The camera's pose (world to camera) at the row of a pixel, by the frame's pose.
inline SE3d pose_at_row(const CameraView& camera, const SE3d& T_c_w, const Vec2& px) {
  return camera.rows ? camera.rows->at(px.y()) * T_c_w : T_c_w;
}

/// Whether the pixel has a ray.
inline bool has_ray(const CameraView& camera, const Vec2& px) {
  Vec3 ray;
  return textplane::is_ok(camera.unproject(px, &ray));
}

/// Ray (x/z, y/z, 1) of a pixel that has one; NaN, which no solver takes, of any other.
inline Vec3 ray_of(const CameraView& camera, const Vec2& px) {
  Vec3 ray = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  camera.unproject(px, &ray);
  return ray;
}

/// The ray of what a pixel shows, if it is far away, at the frame's pose: behind a rolling shutter the row took it from
/// another.
inline Vec3 ray_at_pose(const CameraView& camera, const Vec2& px) {
  const Vec3 ray = ray_of(camera, px);
  if (!camera.rows) return ray;
  const Vec3 turned = camera.rows->at(px.y()).R.transpose() * ray;
  return turned / turned.z();
}

/// Rays of the corners of a quad. False where one has none; *rays may then hold anything.
inline bool rays_of(const CameraView& camera, const Quad<double>& quad, std::array<Vec3, 4>* rays) {
  for (std::size_t i = 0; i < 4; ++i)
    if (!textplane::is_ok(camera.unproject(quad.corner[i], &(*rays)[i]))) return false;
  return true;
}

/// px a unit of normalised coordinates about the camera-frame point p, which is in the domain: the focal length, and
/// what the lens makes of it there.
inline double focal_at(const CameraView& camera, const Vec3& p) {
  if (!camera.lens) return camera.pinhole.fx;
  textplane::FixedMatrix<double, 2, 2> D;
  camera.lens->distort({p.x() / p.z(), p.y() / p.z()}, &D);
  return camera.pinhole.fx * std::sqrt(std::abs(D(0, 0) * D(1, 1) - D(0, 1) * D(1, 0)));
}

}  // namespace textslam

#endif  // TEXTSLAM_COMMON_RAYS_HPP
