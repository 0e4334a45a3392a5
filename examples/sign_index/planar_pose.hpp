// Planar pose: where the camera is, from the image of one quad on a known plane.
//
// Two poses explain four corners of a plane, or nearly: when small, a sign turned to the left looks much like one
// turned to the right. Both poses come in closed form from the homography's derivative at the quad's centre (Collins
// and Bartoli, Infinitesimal Plane-based Pose Estimation, IJCV 2014).
#ifndef TEXTSLAM_SIGN_INDEX_PLANAR_POSE_HPP
#define TEXTSLAM_SIGN_INDEX_PLANAR_POSE_HPP

#include <array>

#include "textplane/core/status.hpp"
#include "textplane/geometry/quad.hpp"
#include "textslam/common/geometry.hpp"

namespace textslam {

struct PlanarPose {
  textplane::Status status = textplane::Status::invalid_argument;
  int count = 0;                        ///< Solutions with the quad in front of the camera: 1 or 2 where status is ok.
  std::array<SE3d, 2> T_c_q;            ///< Frame of the corners to camera; the better one first.
  std::array<double, 2> error{{0, 0}};  ///< Root mean square over the corners, normalised units.
};

/// `corners`: on one plane, in any frame, clockwise as the text's reader sees them; `image`: their normalised images.
/// Seen face on, the two solutions coincide.
///
/// Status: degenerate where either quad is not strictly convex; behind_camera where the image shows the plane's back
/// (its corners run the other way); non_finite for NaN.
PlanarPose planar_pose(const std::array<Vec3, 4>& corners, const Quad<double>& image);

}  // namespace textslam

#endif  // TEXTSLAM_SIGN_INDEX_PLANAR_POSE_HPP
