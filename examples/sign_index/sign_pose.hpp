// Sign pose: the camera from the corners of known signs, how well it is determined, and where it puts another sign.
#ifndef TEXTSLAM_SIGN_INDEX_SIGN_POSE_HPP
#define TEXTSLAM_SIGN_INDEX_SIGN_POSE_HPP

#include <array>
#include <optional>
#include <vector>

#include "textplane/geometry/quad.hpp"
#include "textslam/common/geometry.hpp"

namespace textslam {

/// A sign, and the quad that it was seen as.
struct SeenSign {
  std::array<Vec3, 4> corners;  ///< map's frame
  Quad<double> quad;            ///< normalised image coordinates
};

/// A camera that is held upright, roughly: its x axis lies level, and its z axis nearly so.
struct Upright {
  Vec3 up = Vec3::UnitZ();       ///< unit vector in the map's frame
  double roll = 5 * M_PI / 180;  ///< rad, standard deviation
  double pitch = 15 * M_PI / 180;
};

struct SignPose {
  SE3d T_c_w;
  Matrix6 covariance = Matrix6::Zero();  ///< of the left perturbation of T_c_w
  double log_volume = 0;                 ///< half the logarithm of its determinant
  double chi2 = 0;                       ///< squared errors over their variance: 8 a sign, and 2 of the upright camera
};

/// Where a sign's centre falls, and its uncertainty by the pose alone.
struct CentreView {
  Vec2 at;  ///< normalised
  Eigen::Matrix2d covariance;
};

/// Moves T_c_w to the least squares of all corners, and of the camera's tilt where it is known to be upright. `sigma`:
/// of each coordinate, normalised. False where a corner is not in front of the camera, or the corners do not determine
/// a pose.
bool refine_sign_pose(const std::vector<SeenSign>& seen, double sigma, const std::optional<Upright>& upright,
                      SignPose* pose);

/// False behind the camera.
bool view_of_centre(const SignPose& pose, const Vec3& centre, CentreView* view);

}  // namespace textslam

#endif  // TEXTSLAM_SIGN_INDEX_SIGN_POSE_HPP
