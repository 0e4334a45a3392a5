// Pose refit: places a frame between key frames anew, against the final map, by the map points that it saw.
#ifndef TEXTSLAM_TRACK_POSE_REFIT_HPP
#define TEXTSLAM_TRACK_POSE_REFIT_HPP

#include <vector>

#include "textslam/common/rays.hpp"
#include "textslam/track/track.hpp"

namespace textslam {

/// A map point in a frame.
struct SeenPoint {
  int point;
  Vec2f px;
};

/// Chi-square of a point's reprojection error, as a pose solve has it; negative where the pose does not show the point.
inline float pose_chi2(const CameraView& camera, const SE3d& T_c_w, const Vec3& p_w, const Vec2& px, double sigma) {
  Vec2 shown;
  if (!show(camera, T_c_w * p_w, &shown)) return -1;
  return static_cast<float>((shown - px).squaredNorm() / (sigma * sigma));
}

/// Is a point an inlier of a frame's pose, by the chi-square of its reprojection error; negative where it has none?
inline bool is_pose_inlier(const Parameters& parameters, float chi2) {
  return chi2 >= 0 && chi2 <= parameters.pose_outlier_factor * parameters.outlier_chi2;
}

/// The inliers of the tracks, at most `most`, evenly spaced.
std::vector<SeenPoint> seen_points(const std::vector<Track>& tracks, std::size_t most);

/// The pose that fits what the frame saw, and the pose given, by their information. `camera`: as it took the frame.
/// False, and the pose as it was, where too few points are left or fit.
bool refit_pose(const Map& map, const Parameters& parameters, const CameraView& camera,
                const std::vector<SeenPoint>& seen, PoseEstimate* pose);

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_POSE_REFIT_HPP
