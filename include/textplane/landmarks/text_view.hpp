// How a text looks from a camera: its quad, slant and scale. T_t_h maps the host's points to that camera.
#ifndef TEXTPLANE_LANDMARKS_TEXT_VIEW_HPP
#define TEXTPLANE_LANDMARKS_TEXT_VIEW_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "textplane/geometry/homography.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/quad_projection.hpp"
#include "textplane/landmarks/keyframe.hpp"
#include "textplane/landmarks/text_object.hpp"
#include "textplane/landmarks/text_options.hpp"
#include "textplane/photometry/photometric_input.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
constexpr double kHalfTurn = 3.141592653589793;  // pi

inline double radians(double degrees) noexcept { return degrees * kHalfTurn / 180; }

// Between two directions of any length, degrees.
TEXTPLANE_DEFERRED
inline double degrees_between(const Vector3<double>& a, const Vector3<double>& b) noexcept {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / kHalfTurn;
}
}  // namespace detail

/// A text that has its patch's quad and camera and this plane, and no more: what the functions below look at.
TEXTPLANE_DEFERRED
inline TextObject outline_of(const TextPatch& patch, const Vector3<double>& theta) {
  TextObject text;
  text.patch.quad = patch.quad;
  text.patch.camera = patch.camera;
  text.patch.area = patch.area;
  text.patch.rows = patch.rows;
  text.theta = theta;
  return text;
}

/// px^2 that the text covers in its host's image.
TEXTPLANE_DEFERRED
inline double area_in_host(const TextPatch& patch) noexcept {
  return patch.area > 0 ? patch.area : std::abs(area(patch.quad));
}

/// The corners of the text in its host's frame (at the time stamp, where its rows were not taken at once). Status and
/// untouched output as quad_points().
TEXTPLANE_DEFERRED
inline Status text_corners(const TextObject& text, std::array<Vector3<double>, 4>* out) noexcept {
  const TextPatch& patch = text.patch;
  if (!patch.rows.active()) return quad_points(patch.quad, patch.camera, text.theta, out);
  const Matrix3<Real> C = host_row_warp(patch.rows, text.theta, patch.camera.unproject(centroid(patch.quad)));
  std::array<Vector3<Real>, 4> p;
  for (std::size_t i = 0; i < 4; ++i) {
    const Status status = plane_point(text.theta, product(C, patch.camera.unproject(patch.quad.corner[i])), &p[i]);
    if (!is_ok(status)) return status;
  }
  *out = p;
  return Status::ok;
}

/// The text's quad as seen by the camera, by its rows and those of the host; false where a corner is behind it, or
/// beyond what its lens sees.
TEXTPLANE_DEFERRED
inline bool project_text(const TextObject& text, const SE3d& T_t_h, const CameraView& camera,
                         Quad<double>* quad) noexcept {
  const Matrix3<Real> H = plane_homography(text.theta, T_t_h);
  const bool rolling = camera.rows || text.patch.rows.active();
  Matrix3<Real> C;
  if (rolling) C = host_row_warp(text.patch.rows, text.theta, text.patch.camera.unproject(centroid(text.patch.quad)));
  for (std::size_t i = 0; i < 4; ++i) {
    Vector3<Real> m = text.patch.camera.unproject(text.patch.quad.corner[i]);
    if (rolling) m = product(C, m);
    const Vector3<Real> q = H * m;
    if (camera.rows) {
      const RowProjection seen = project_rows(*camera.rows, camera, Vector3<Real>(q / text.theta.dot(m)));
      if (!is_ok(seen.status)) return false;
      quad->corner[i] = seen.px;
      continue;
    }
    if (!(q.z() > 1e-6) || !camera.in_domain(q)) return false;
    quad->corner[i] = camera.pixel(Vector2<Real>(q.x() / q.z(), q.y() / q.z()));
  }
  return true;
}

/// Cosine of the angle between the text's normal and the ray to its centre; positive where the camera sees its front.
TEXTPLANE_DEFERRED
inline double facing(const TextObject& text, const SE3<Real>& T_t_h) noexcept {
  const Vector3<Real> m = text.patch.camera.unproject(centroid(text.patch.quad));
  const Vector3<Real> centre = T_t_h * plane_point(text.theta, m);
  const Vector3<Real> normal = T_t_h.R * plane_normal(text.theta);
  return -normal.dot(centre.normalized());
}

/// The slant test, for the cosine that facing() returns.
inline bool is_too_slanted(const TextOptions& options, double facing) noexcept {
  return facing < std::cos(detail::radians(options.max_slant));
}

/// As project_text(), and whether the camera sees enough of the text's front to compare it with the host: not too
/// slanted, at least `min_area` px^2, and `min_share` of it inside the image (1: the whole quad, off the border).
TEXTPLANE_DEFERRED
inline bool is_in_view(const TextOptions& options, const TextObject& text, const SE3d& T_t_h, const TextImage& image,
                       double min_area, double min_share, Quad<double>* quad) noexcept {
  if (!project_text(text, T_t_h, image.camera, quad) || is_too_slanted(options, facing(text, T_t_h))) return false;
  const double whole = std::abs(area(*quad));
  if (whole < min_area) return false;
  if (min_share >= 1) return inside_image(*quad, image.width(), image.height(), options.seen_border);
  return area(clip_to_image(*quad, image.width(), image.height())) >= min_share * whole;
}

/// The same as tracking asks for it: by TextOptions::min_area and min_share.
TEXTPLANE_DEFERRED
inline bool text_in_view(const TextOptions& options, const TextObject& text, const SE3d& T_t_h, const TextImage& image,
                         Quad<double>* quad) noexcept {
  return is_in_view(options, text, T_t_h, image, options.min_area, options.min_share, quad);
}

/// Does the plane lie in front of its host, not too slanted, over the whole quad?
TEXTPLANE_DEFERRED
inline bool is_plausible_plane(const TextOptions& options, const Pinhole<Real>& camera, const Quad<double>& quad,
                               const Vector3<double>& theta) noexcept {
  const Vector3<Real> ray = camera.unproject(centroid(quad)).normalized();
  if (is_too_slanted(options, -plane_normal(theta).dot(ray))) return false;
  return std::all_of(quad.corner.begin(), quad.corner.end(), [&](const Vector2<Real>& corner) {
    return inverse_depth<double>(theta, camera.unproject(corner)) > 0;
  });
}

/// Which pyramid levels of host and view show the text at one scale, for its quad in the view: see photometric_input().
TEXTPLANE_DEFERRED
inline int scale_shift(const TextObject& text, const Quad<double>& quad) noexcept {
  return scale_shift(area_in_host(text.patch), std::abs(area(quad)));
}

/// Largest standard deviation of the direction of a plane's normal n = -theta / |theta|, radians.
TEXTPLANE_DEFERRED
inline double normal_sigma(const Vector3<double>& theta, const Matrix3<double>& covariance) noexcept {
  const Vector3<Real> n = plane_normal(theta);
  const Matrix3<Real> J = (Matrix3<Real>::Identity() - n * n.transpose()) / theta.norm();
  const Matrix3<Real> of_normal = J * covariance * J.transpose();
  return std::sqrt((std::max)(0.0, symmetric_eigen<double, 3>(of_normal).values[2]));
}
/// The same of a text.
TEXTPLANE_DEFERRED
inline double normal_sigma(const TextObject& text) noexcept { return normal_sigma(text.theta, text.covariance); }

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_VIEW_HPP
