#include "textslam/track/pose_refit.hpp"

#include "textplane/solver/pose.hpp"

namespace textslam {
namespace {

// To first order: the step from the one pose towards the other that both informations ask for.
PoseEstimate fused(const PoseEstimate& a, const PoseEstimate& b) {
  PoseEstimate out{a.T_c_w, a.information + b.information};
  const textplane::Ldlt<double, 6> ldlt(out.information);
  if (!ldlt.ok()) return a;
  const Vector6 apart = textplane::se3_log<double>(b.T_c_w * a.T_c_w.inverse());
  out.T_c_w = textplane::renormalised(textplane::se3_exp<double>(ldlt.solve(b.information * apart)) * a.T_c_w);
  return out;
}

}  // namespace

std::vector<SeenPoint> seen_points(const std::vector<Track>& tracks, std::size_t most) {
  std::vector<SeenPoint> all;
  for (const Track& track : tracks)
    if (track.point >= 0 && track.inlier) all.push_back({track.point, track.px});
  if (all.size() <= most) return all;
  std::vector<SeenPoint> chosen;
  for (std::size_t i = 0; i < most; ++i) chosen.push_back(all[i * all.size() / most]);
  return chosen;
}

bool refit_pose(const Map& map, const Parameters& parameters, const CameraView& camera,
                const std::vector<SeenPoint>& seen, PoseEstimate* pose) {
  std::vector<textplane::PosePointTerm> points;
  for (const SeenPoint& s : seen)
    if (!map.point(s.point).bad)
      points.push_back({map.point(s.point).p_w, s.px.cast<double>(), parameters.point_sigma});
  const int count = static_cast<int>(points.size());
  if (count < parameters.refit_min_points) return false;
  textplane::PoseWorkspace workspace;
  workspace.reserve(nullptr, 0, count);
  const textplane::PoseOptions options;
  std::vector<float> chi2(points.size());
  const auto result = textplane::refine_pose(nullptr, 0, points.data(), count, textplane::PyramidView(), camera,
                                             pose->T_c_w, options, workspace, nullptr, chi2.data());
  if (!textplane::is_ok(result.status)) return false;
  int inliers = 0;
  for (const float c : chi2) inliers += is_pose_inlier(parameters, c) ? 1 : 0;
  if (inliers < parameters.refit_min_points) return false;
  const PoseEstimate by_points{textplane::renormalised(result.T_t_w), result.information};
  *pose = fused(by_points, *pose);
  return true;
}

}  // namespace textslam
