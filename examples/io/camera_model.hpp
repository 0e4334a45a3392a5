// The camera that took a sequence, and the files that describe it. Each is known by its content:
//
//   settings   `Camera.key: value` a line with the keys type width height fx fy cx cy, the coefficients of the type,
//              and optionally fps, readout and readout_row (ORB-SLAM's settings; ORB-SLAM3's Camera1.fx and so on
//              too, its other keys are ignored). Without a type k1 k2 p1 p2 [k3]. This is the camera.yaml of a
//              sequence
//   sensor     EuRoC's and TUM-VI's sensor.yaml: camera_model, intrinsics, distortion_model, distortion_coefficients,
//              resolution, and optionally rate_hz and T_BS
//   camchain   kalibr's camchain.yaml: the same words below cam0, with T_cam_imu; further cameras are ignored
//   opencv     YAML or XML of cv::FileStorage: image_width, image_height, camera_matrix, distortion_coefficients of 4,
//              5 or 8 numbers, and fisheye_model; or ROS's camera_info
//   colmap     COLMAP's cameras.txt with one camera. Its pixel (0.5, 0.5) is our (0, 0)
//
// camera_formats/camera_types.hpp has the words for each camera model.
#ifndef TEXTSLAM_IO_CAMERA_MODEL_HPP
#define TEXTSLAM_IO_CAMERA_MODEL_HPP

#include <string>

#include "io/names.hpp"

namespace textslam {

/// The shutter of an image whose rows are all taken at once; a readout that is given to it counts from the middle row.
inline textplane::RollingShutter all_at_once(int rows) { return {0, 0.5 * (rows - 1), rows}; }

/// The same shutter as seen from the time of its middle row.
inline textplane::RollingShutter at_middle(const textplane::RollingShutter& shutter, int rows) {
  textplane::RollingShutter out = all_at_once(rows);
  if (shutter.rows > 1) out.readout = shutter.readout;
  return out;
}

struct CameraModel {
  textplane::AnyCamera<double> raw;   ///< of the images as they were taken
  int width = 0, height = 0;          ///< px
  double fps = 0;                     ///< 0: not known
  textplane::RollingShutter shutter;  ///< Its rows are the height; by default all rows are taken at once.
  bool knows_readout = false;         ///< That of `shutter` is said, 0 too; else it is a default.

  // The members of a camera model (textplane/core/cameras/camera.hpp) that the programs use.
  Vector2<double> project(const Vector3<double>& p) const noexcept;
  textplane::Status unproject(const Vector2<double>& px, Vector3<double>* m) const noexcept;
  /// Of the undistorted images.
  const Pinhole<double>& pinhole() const noexcept { return raw.pinhole(); }
  bool is_pinhole() const noexcept { return raw.is_pinhole(); }
};

struct CameraFile {
  CameraModel model;
  SE3d T_b_c;  ///< camera to body (IMU); the identity where the file does not say it
};

enum class CameraFormat { settings, sensor, camchain, opencv, colmap };

/// Reads a file of any of these formats. Throws InputError, with the line where there is one, for content of none of
/// them, a key that is missing or there twice, a bad number, a focal length or size that is not positive, parameters
/// out of a model's range, and words for models that the library does not have.
CameraFile read_camera_file(const std::string& path);
/// Its camera.
CameraModel read_camera(const std::string& path);

/// The text of a file of this format; empty where the format has no word for the model. read_camera() makes the same
/// numbers of it; a lens may come back as a model that it is a case of (a pinhole as radial_tangential in opencv, a
/// radial_tangential with k3 as rational in colmap). COLMAP's half pixel may round the last bit of cx and cy.
std::string format_camera(const CameraModel& camera, CameraFormat format = CameraFormat::settings);

/// The file of a sequence's folder that describes its camera: camera.yaml, sensor.yaml, camchain.yaml, *-camchain.yaml
/// or cameras.txt, the first of these that is there; empty where none is. Throws InputError where two end in
/// -camchain.yaml.
std::string find_camera(const std::string& folder);

/// A pinhole that sees `fov` degrees (above 0, below 180) from the left edge of the image to the right one: square
/// pixels, principal point in the centre of the image, no lens distortion.
CameraModel camera_from_fov(double fov, int width, int height);

}  // namespace textslam

#endif  // TEXTSLAM_IO_CAMERA_MODEL_HPP
