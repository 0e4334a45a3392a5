// The camera that took a sequence, and the files that describe it.
//
//   camera.yaml   `Camera.key: value` a line with the keys width height fps fx fy cx cy k1 k2 p1 p2 [k3]; other keys of an
//                 ORB-SLAM settings file are ignored
//   sensor.yaml   EuRoC's, see io/euroc.hpp
#ifndef TEXTSLAM_IO_CAMERA_MODEL_HPP
#define TEXTSLAM_IO_CAMERA_MODEL_HPP

#include <string>

#include "io/names.hpp"

namespace textslam {

/// raw pixel = pinhole.pixel(lens.distort(m)).
struct CameraModel {
  Pinhole<double> pinhole;
  RadialTangential<double> lens;
  int width = 0, height = 0;  ///< px
  double fps = 0;             ///< 0: not known
};

/// Reads camera.yaml. Throws InputError for a missing or repeated key, a bad number, a focal length or size that is not
/// positive, or a lens model other than the pinhole.
CameraModel read_camera(const std::string& path);
/// The text that read_camera() reads; the numbers survive the round trip exactly.
std::string format_camera(const CameraModel& camera);

/// A pinhole that sees `fov` degrees (above 0, below 180) from the left edge of the image to the right one: square pixels,
/// principal point in the centre of the image, no lens distortion.
CameraModel camera_from_fov(double fov, int width, int height);

}  // namespace textslam

#endif  // TEXTSLAM_IO_CAMERA_MODEL_HPP
