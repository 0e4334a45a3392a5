#include "textslam/report/evaluate_poses.hpp"

#include <algorithm>
#include <cmath>

namespace textslam {
namespace {

// A key frame with its true pose.
struct Anchor {
  StampedPose estimate;
  SE3d truth;
};

std::vector<Anchor> anchors_of(const std::vector<StampedPose>& keyframes, const std::vector<StampedPose>& truth) {
  std::vector<Anchor> anchors;
  for (const PosePair& pair : associate(keyframes, truth, EvaluationOptions{}.tolerance))
    anchors.push_back({keyframes[pair.estimate], truth[pair.truth].T_w_c});
  return anchors;
}

const Anchor* nearest(const std::vector<Anchor>& anchors, double time) {
  const auto gap = [time](const Anchor& a) { return std::abs(a.estimate.timestamp - time); };
  const auto at = std::min_element(anchors.begin(), anchors.end(),
                                   [&](const Anchor& a, const Anchor& b) { return gap(a) < gap(b); });
  return at == anchors.end() ? nullptr : &*at;
}

}  // namespace

PoseErrors compare_poses(const std::vector<StatedPose>& poses, const std::vector<StampedPose>& keyframes,
                         const std::vector<StampedPose>& truth, const Similarity& alignment) {
  PoseErrors out;
  out.poses = poses.size();
  const std::vector<Anchor> anchors = anchors_of(keyframes, truth);
  std::vector<StampedPose> stamped;
  for (const StatedPose& pose : poses) stamped.push_back(pose.pose);
  std::vector<double> errors, relative, over_sigma, relative_over_sigma;
  for (const PosePair& pair : associate(stamped, truth, EvaluationOptions{}.tolerance)) {
    const StatedPose& stated = poses[pair.estimate];
    const SE3d &estimate = stated.pose.T_w_c, &true_pose = truth[pair.truth].T_w_c;
    const double sigma = alignment.scale * std::sqrt(std::max(0.0, stated.covariance.trace()));
    errors.push_back((alignment * estimate.t - true_pose.t).norm());
    if (sigma > 0) over_sigma.push_back(errors.back() / sigma);
    const Anchor* anchor = nearest(anchors, stated.pose.timestamp);
    if (!anchor || anchor->estimate.timestamp == stated.pose.timestamp) continue;
    const Vec3 moved = alignment.scale * (anchor->estimate.T_w_c.inverse() * estimate.t);
    relative.push_back((moved - anchor->truth.inverse() * true_pose.t).norm());
    if (sigma > 0) relative_over_sigma.push_back(relative.back() / sigma);
  }
  out.ate_rmse = errors.empty() ? std::nan("") : error_statistics(std::move(errors)).rmse;
  out.relative_rmse = relative.empty() ? std::nan("") : error_statistics(std::move(relative)).rmse;
  out.over_sigma = error_statistics(std::move(over_sigma));
  out.relative_over_sigma = error_statistics(std::move(relative_over_sigma));
  return out;
}

std::vector<StatedPose> stated_poses(const System& system, bool live) {
  std::vector<StatedPose> poses;
  for (const FrameRecord& record : system.records()) {
    if (record.state != FrameState::tracked || record.live != live) continue;
    StatedPose stated;
    stated.pose = {record.timestamp, system.final_pose(record)};
    // T_c_w -> exp(v, omega) T_c_w moves the camera by -R_w_c v.
    const textplane::Ldlt<double, 6> ldlt(record.information);
    const Matrix3<double>& R = stated.pose.T_w_c.R;
    if (ldlt.ok()) stated.covariance = R * ldlt.inverse().topLeftCorner<3, 3>() * R.transpose();
    poses.push_back(stated);
  }
  return poses;
}

std::vector<StampedPose> keyframe_trajectory(const Map& map) {
  std::vector<StampedPose> poses;
  for (const int id : map.keyframe_ids())
    if (map.keyframe(id).frame.index >= 0) poses.push_back({map.keyframe(id).frame.timestamp, map.keyframe(id).T_w_c});
  std::sort(poses.begin(), poses.end(),
            [](const StampedPose& a, const StampedPose& b) { return a.timestamp < b.timestamp; });
  return poses;
}

}  // namespace textslam
