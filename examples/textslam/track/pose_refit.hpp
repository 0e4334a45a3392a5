// Pose refit: the poses of all frames once the map is final. A frame between key frames was placed against the map of its time;
// here it is placed again, from the map points that it saw, against what became of them.
#ifndef TEXTSLAM_TRACK_POSE_REFIT_HPP
#define TEXTSLAM_TRACK_POSE_REFIT_HPP

#include <vector>

#include "textslam/common/parameters.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// A map point in a frame.
struct SeenPoint {
  int point;
  Vec2f px;
};

/// The inliers of the tracks, evenly thinned to `most`.
std::vector<SeenPoint> seen_points(const std::vector<Track>& tracks, std::size_t most);

/// The world-to-camera pose that fits what the frame saw, from a start. False where too few of the points are left or fit: the
/// start then is the best there is.
bool refit_pose(const Map& map, const Parameters& parameters, const std::vector<SeenPoint>& seen, SE3d* T_c_w);

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_POSE_REFIT_HPP
