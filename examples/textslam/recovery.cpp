#include "textslam/recovery.hpp"

#include <algorithm>

#include "textslam/rotation_prior.hpp"

namespace textslam {

Recovery relocalise(const Map& map, const Parameters& parameters, const Frame& frame) {
  struct Candidate {
    int keyframe;
    double zncc;
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const RotationPrior prior = align_rotation(map.keyframes[i].frame, frame, map.camera, Eigen::Matrix3d::Identity());
    if (prior.zncc > 0.3) candidates.push_back({static_cast<int>(i), prior.zncc});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.zncc > b.zncc; });
  if (static_cast<int>(candidates.size()) > parameters.relocalise_candidates)
    candidates.resize(static_cast<std::size_t>(parameters.relocalise_candidates));

  Recovery best;
  for (const Candidate& candidate : candidates) {
    const KeyFrame& keyframe = map.keyframe(candidate.keyframe);
    auto tracker = std::make_unique<Tracker>(map, parameters);
    tracker->start(keyframe.frame, keyframe.T_w_c.inverse(), tracks_of_keyframe(map, candidate.keyframe));
    TrackReport report = tracker->track(frame);
    if (!report.ok || report.inliers <= best.report.inliers) continue;
    best.report = std::move(report);
    best.tracker = std::move(tracker);
  }
  // A wrong pose would spoil the map; a frame more of being lost costs little.
  if (best.report.inliers < 2 * parameters.min_inliers && best.report.texts < 2) best.tracker.reset();
  return best;
}

}  // namespace textslam
