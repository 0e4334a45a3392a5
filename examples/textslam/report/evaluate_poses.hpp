// The final poses, live and filled-in ones apart, against the truth and against what their covariances state.
//
// A stated covariance takes the map for known. It is compared with two errors: that of the aligned trajectory, in which
// the map's drift is, and that of the motion from the key frame nearest in time, which has little of it.
#ifndef TEXTSLAM_REPORT_EVALUATE_POSES_HPP
#define TEXTSLAM_REPORT_EVALUATE_POSES_HPP

#include <vector>

#include "io/evaluate.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

/// A pose of the map with what is stated of its position.
struct StatedPose {
  StampedPose pose;
  Matrix3<double> covariance = Matrix3<double>::Zero();  ///< Of the position, in the map's world; zero: not stated.
};

struct PoseErrors {
  std::size_t poses = 0;
  double ate_rmse = 0;         ///< By the alignment of all final poses; NaN without pairs, as the next.
  double relative_rmse = 0;    ///< Of the position seen from the nearest key frame, in units of the truth.
  ErrorStatistics over_sigma;  ///< Each error over the square root of its covariance's trace.
  ErrorStatistics
      relative_over_sigma;  ///< The same from the nearest key frame. About .9 in the median where it is right.
};

/// `alignment`: map to truth. Key frames themselves count for the errors, but have no motion from themselves.
PoseErrors compare_poses(const std::vector<StatedPose>& poses, const std::vector<StampedPose>& keyframes,
                         const std::vector<StampedPose>& truth, const Similarity& alignment);

/// The tracked frames that were live ones, or those that were not.
std::vector<StatedPose> stated_poses(const System& system, bool live);

/// The key frames' poses, in order of time, without those of earlier sessions.
std::vector<StampedPose> keyframe_trajectory(const Map& map);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_EVALUATE_POSES_HPP
