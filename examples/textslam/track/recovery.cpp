#include "textslam/track/recovery.hpp"

#include <algorithm>

#include "textplane/geometry/quad.hpp"
#include "textslam/track/rotation_prior.hpp"

namespace textslam {
namespace {

constexpr int kRounds = 3;  // of looking for what a pose that just became better expects

Recovery recovery_of(Tracker& tracker, TrackReport report) {
  Recovery out;
  out.ok = report.ok;
  out.T_c_w = report.T_c_w;
  out.tracks = std::move(tracker.tracks());
  out.report = std::move(report);
  return out;
}

// Inlier points that lie on no mapped text.
int points_off_texts(const Map& map, const Recovery& recovery) {
  std::vector<Quad<double>> quads;
  for (const TextObject& text : map.texts) {
    Quad<double> quad;
    if (text.state == TextState::mapped && project_text(map, text, recovery.T_c_w, &quad)) quads.push_back(quad);
  }
  int count = 0;
  for (const Track& track : recovery.tracks) {
    const Vec2 px = track.px.cast<double>();
    const bool on_text = std::any_of(quads.begin(), quads.end(),
                                     [&](const Quad<double>& quad) { return textplane::contains(quad, px); });
    count += track.point >= 0 && track.inlier && !on_text ? 1 : 0;
  }
  return count;
}

// A wrong pose would spoil the map; a frame more of being lost costs little.
bool holds(const Map& map, const Parameters& parameters, const Recovery& recovery) {
  const int expected = std::min(static_cast<int>(recovery.report.visible.size()), parameters.max_reobserved);
  if (!recovery.ok || recovery.report.inliers < parameters.relocalise_min_share * expected) return false;
  return recovery.report.texts >= 2 || (recovery.report.inliers >= 2 * parameters.min_inliers &&
                                        points_off_texts(map, recovery) >= parameters.min_inliers);
}

Recovery relocalise_by_keyframes(const Map& map, const Parameters& parameters, const Frame& frame) {
  struct Candidate {
    int keyframe;
    double zncc;
  };
  std::vector<Candidate> candidates;
  for (const int id : map.keyframe_ids()) {
    const RotationPrior prior = align_rotation(map.keyframe(id).frame, frame, map.camera, Eigen::Matrix3d::Identity());
    if (prior.zncc > 0.3) candidates.push_back({id, prior.zncc});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.zncc > b.zncc; });
  if (static_cast<int>(candidates.size()) > parameters.relocalise_candidates)
    candidates.resize(static_cast<std::size_t>(parameters.relocalise_candidates));

  Recovery best;
  for (const Candidate& candidate : candidates) {
    const KeyFrame& keyframe = map.keyframe(candidate.keyframe);
    Tracker tracker(map, parameters);
    tracker.start(keyframe.frame, keyframe.T_w_c.inverse(), tracks_of_keyframe(map, candidate.keyframe));
    TrackReport report = tracker.track(frame);
    if (!report.ok || report.inliers <= best.report.inliers) continue;
    best = recovery_of(tracker, std::move(report));
  }
  // Over so long a way tracks go astray, and many of them the same way; what the pose expects has no past.
  if (best.ok) best = observe_from(map, parameters, frame, best.T_c_w);
  if (!holds(map, parameters, best)) return {};
  return best;
}

}  // namespace

Recovery observe_from(const Map& map, const Parameters& parameters, const Frame& frame, const SE3d& T_c_w) {
  Recovery best;
  SE3d guess = T_c_w;
  for (int round = 0; round < kRounds; ++round) {
    Tracker tracker(map, parameters);
    tracker.start(frame, guess, {});
    TrackReport report = tracker.track(frame);
    if (!report.ok || report.inliers + report.texts <= best.report.inliers + best.report.texts) break;
    guess = report.T_c_w;
    best = recovery_of(tracker, std::move(report));
  }
  return best;
}

Recovery recognise_from(const Map& map, const Parameters& parameters, const Frame& frame, const SE3d& T_c_w) {
  Recovery found = observe_from(map, parameters, frame, T_c_w);
  if (!holds(map, parameters, found)) return {};
  return found;
}

Recovery relocalise_by_texts(const Map& map, const Parameters& parameters, const Frame& frame,
                             const std::vector<WordMatch>& ways) {
  for (const WordMatch words : ways) {
    for (const TextHypothesis& hypothesis : text_hypotheses(map, parameters, frame, words)) {
      Recovery found = recognise_from(map, parameters, frame, hypothesis.T_c_w);
      if (found.ok) return found;
    }
  }
  return {};
}

Recovery relocalise(const Map& map, const Parameters& parameters, const Frame& frame) {
  if (parameters.mode == Mode::text) {
    Recovery found = relocalise_by_texts(map, parameters, frame, {WordMatch::same, WordMatch::other});
    if (found.ok) return found;
  }
  return relocalise_by_keyframes(map, parameters, frame);
}

}  // namespace textslam
