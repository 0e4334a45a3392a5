// The pose of a frame from matches, many of them wrong, of map points with its pixels.
//
// Three matches give a pose: Newton's method on the three depths, from those that a similar view suggests. Triples are
// drawn by a generator with a constant seed; the pose that most matches agree with is fitted to all of those.
#ifndef TEXTSLAM_RELOCALISE_THREE_POINT_POSE_HPP
#define TEXTSLAM_RELOCALISE_THREE_POINT_POSE_HPP

#include <array>
#include <vector>

#include "textplane/core/status.hpp"
#include "textslam/common/parameters.hpp"
#include "textslam/common/rays.hpp"

namespace textslam {

/// The pose world to camera that puts three points on three rays (normalised homogeneous), the one nearest to `depths`
/// along the optical axis. Status: degenerate for points or rays on a line; diverged where none is found nearby;
/// non_finite for NaN.
textplane::Status three_point_pose(const std::array<Vec3, 3>& p_w, const std::array<Vec3, 3>& rays, const Vec3& depths,
                                   SE3d* T_c_w);

struct PointMatch {
  int point = -1;  ///< Id, for the caller.
  Vec3 p_w = Vec3::Zero();
  Vec2 px = Vec2::Zero();
  double sigma = 1;  ///< px.
};

struct MatchedPose {
  SE3d T_c_w;
  int inliers = 0;  ///< Matches that agree with it; 0 where no pose was found.
};

/// Fits a pose to the matches that agree with it, until no more do.
MatchedPose settled_pose(const std::vector<PointMatch>& matches, const CameraView& camera, const SE3d& T_c_w,
                         const Parameters& parameters);

/// `T_near`: pose of a similar view, world to camera. Pixels of the matches have rays.
MatchedPose pose_of_matches(const std::vector<PointMatch>& matches, const CameraView& camera, const SE3d& T_near,
                            const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_RELOCALISE_THREE_POINT_POSE_HPP
