// Cameras that see far off their axis, and what is different for them. A pinhole may be one; a lens need not.
#ifndef TEXTSLAM_COMMON_WIDE_VIEW_HPP
#define TEXTSLAM_COMMON_WIDE_VIEW_HPP

#include <algorithm>
#include <cmath>

#include "textslam/common/parameters.hpp"
#include "textslam/common/rays.hpp"

namespace textslam {

/// Whether images of this size reach beyond Parameters::wide_angle off the axis, along a row or a column through the
/// principal point.
inline bool is_wide(const CameraView& camera, int width, int height, const Parameters& parameters) {
  const double cx = camera.pinhole.cx, cy = camera.pinhole.cy;
  for (const Vec2& px : {Vec2(0, cy), Vec2(width - 1, cy), Vec2(cx, 0), Vec2(cx, height - 1)}) {
    Vec3 ray;
    if (!textplane::is_ok(camera.unproject(px, &ray)) || degrees_between(ray, Vec3::UnitZ()) > parameters.wide_angle)
      return true;
  }
  return false;
}

/// The parameters for a camera. Motion in the image is that of 525 px focal length at 640x480: a wide view shows the
/// same motion of the camera by fewer pixels. Its corners are followed by smaller patches.
inline Parameters at_view(Parameters parameters, const CameraView& camera, int width, int height) {
  if (!is_wide(camera, width, height, parameters)) return parameters;
  const double usual = 525 * std::sqrt(static_cast<double>(width) * height / (640.0 * 480.0));
  const double scale = std::min(1.0, focal_at(camera, Vec3::UnitZ()) / usual);
  parameters.keyframe_flow *= scale;
  parameters.init_view_flow *= scale;
  parameters.klt_radius = std::min(parameters.klt_radius, parameters.wide_klt_radius);
  return parameters;
}

}  // namespace textslam

#endif  // TEXTSLAM_COMMON_WIDE_VIEW_HPP
