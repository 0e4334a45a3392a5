// Stage: one sign on a plastered wall, seen from anywhere, with the exact truth. The numbered examples run on it.
//
// The world's axes are those of a camera that faces the wall: x right, y down, z ahead, in metres. The sign's plate is
// centred at (0, 0, 2).
#ifndef TEXTSLAM_STAGE_STAGE_HPP
#define TEXTSLAM_STAGE_STAGE_HPP

#include <cstdint>
#include <string>

#include "renderer/scene.hpp"
#include "renderer/sensor.hpp"

namespace textslam {

class Stage {
 public:
  /// `turn`: the wall with its sign is turned by this rotation vector (rad) about the sign's centre. Throws
  /// std::runtime_error where no font is found.
  explicit Stage(const std::string& word, const Vector3<double>& turn = Vector3<double>::Zero());

  /// The camera of all views: 480 x 360 px, no distortion.
  const Pinhole<double>& camera() const noexcept { return camera_; }
  /// The image of the camera at T_w_c.
  Image<std::uint8_t> view(const SE3d& T_w_c, const SensorState& sensor = {}) const;
  /// Corners of the text (not of the plate) in that view, px.
  Quad<double> quad(const SE3d& T_w_c) const;
  /// The sign's plane in the frame of that camera.
  Vector3<double> theta(const SE3d& T_w_c) const;

 private:
  Pinhole<double> camera_{420, 420, 239.5, 179.5};
  Scene scene_;
};

/// A camera at `position` (m), turned by the rotation vector `turn` (rad) from facing the wall.
SE3d camera_at(const Vector3<double>& position, const Vector3<double>& turn = Vector3<double>::Zero());

/// Mean distance of the corners, px.
double corner_error(const Quad<double>& a, const Quad<double>& b);

/// The image of the quad under the pixel homography of plane theta and pose T_t_h, with one camera for both views; NaN
/// where it is behind the camera.
Quad<double> warped(const Quad<double>& quad, const Vector3<double>& theta, const SE3d& T_t_h,
                    const Pinhole<double>& camera);

}  // namespace textslam

#endif  // TEXTSLAM_STAGE_STAGE_HPP
