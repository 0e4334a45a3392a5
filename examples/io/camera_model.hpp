// The camera that took a sequence, and the files that describe it.
//
//   camera.yaml   `Camera.key: value` a line with the keys width height fps fx fy cx cy, optionally type, and the
//                 coefficients of that type (io/camera_types.hpp; without a type k1 k2 p1 p2 [k3]). Other keys of an
//                 ORB-SLAM settings file are ignored.
//   sensor.yaml   EuRoC's, see io/euroc.hpp
#ifndef TEXTSLAM_IO_CAMERA_MODEL_HPP
#define TEXTSLAM_IO_CAMERA_MODEL_HPP

#include <string>

#include "io/camera_types.hpp"

namespace textslam {

struct CameraModel {
  RawCamera raw;
  int width = 0, height = 0;  ///< px
  double fps = 0;             ///< 0: not known

  // The members of a camera model (textplane/core/cameras/camera.hpp) that the programs use.
  Vector2<double> project(const Vector3<double>& p) const noexcept {
    return std::visit([&p](const auto& camera) { return camera.project(p); }, raw);
  }
  textplane::Status unproject(const Vector2<double>& px, Vector3<double>* m) const noexcept {
    return std::visit([&](const auto& camera) { return camera.unproject(px, m); }, raw);
  }
  /// Of the undistorted images.
  const Pinhole<double>& pinhole() const noexcept {
    return std::visit([](const auto& camera) -> const Pinhole<double>& { return camera.pinhole(); }, raw);
  }
  bool is_pinhole() const noexcept {
    return std::visit([](const auto& camera) { return camera.is_pinhole(); }, raw);
  }
};

/// Reads camera.yaml. Throws InputError for a missing or repeated key, a bad number, a focal length or size that is not
/// positive, or a Camera.type that io/camera_types.hpp does not have.
CameraModel read_camera(const std::string& path);
/// The text that read_camera() reads; the numbers survive the round trip exactly.
std::string format_camera(const CameraModel& camera);

/// A pinhole that sees `fov` degrees (above 0, below 180) from the left edge of the image to the right one: square
/// pixels, principal point in the centre of the image, no lens distortion.
CameraModel camera_from_fov(double fov, int width, int height);

}  // namespace textslam

#endif  // TEXTSLAM_IO_CAMERA_MODEL_HPP
