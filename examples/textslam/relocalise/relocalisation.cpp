#include "textslam/relocalise/relocalisation.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "textplane/geometry/quad.hpp"
#include "textslam/map/text_views.hpp"
#include "textslam/track/rotation_prior.hpp"

namespace textslam {
namespace {

// Inlier points that lie on no mapped text.
int points_off_texts(const Map& map, const SE3d& T_c_w, const std::vector<Track>& tracks) {
  std::vector<Quad<double>> quads;
  for (const TextObject& text : map.texts) {
    Quad<double> quad;
    if (text.state == TextState::mapped && project_text(map, text, T_c_w, &quad)) quads.push_back(quad);
  }
  int count = 0;
  for (const Track& track : tracks) {
    const Vec2 px = track.px.cast<double>();
    const bool on_text = std::any_of(quads.begin(), quads.end(),
                                     [&](const Quad<double>& quad) { return textplane::contains(quad, px); });
    count += track.point >= 0 && track.inlier && !on_text ? 1 : 0;
  }
  return count;
}

// The map points that were looked for.
int expected_points(const Parameters& parameters, const TrackReport& found) {
  return std::min(static_cast<int>(found.visible.size()), parameters.max_reobserved);
}

// Whether no other pose needs to be tried. One that is wrong holds too, where it fits what is far and small.
bool is_clear(const Parameters& parameters, const Relocalisation& found) {
  return found.ok && found.inliers >= parameters.relocalise_clear_share * expected_points(parameters, found);
}

// Whether most points that either shows are the same, at the same places.
bool agree(const Relocalisation& a, const Relocalisation& b) {
  constexpr float kSamePlace = 2;  // px
  std::map<int, Vec2f> places;
  for (const Track& track : a.tracks)
    if (track.point >= 0 && track.inlier) places[track.point] = track.px;
  int same = 0;
  for (const Track& track : b.tracks) {
    const auto place = track.inlier ? places.find(track.point) : places.end();
    same += place != places.end() && (place->second - track.px).norm() <= kSamePlace ? 1 : 0;
  }
  return 2 * same > std::max(a.inliers, b.inliers);
}

// What gave the pose first stays named where the better one is the same.
void take_better(Relocalisation other, Relocalisation* found) {
  if (!other.ok || (found->ok && other.shown() <= found->shown())) return;
  if (found->ok && found->by != FoundBy::nothing && agree(*found, other)) other.by = found->by;
  *found = std::move(other);
}

// Key frames that saw a sign, those nearest to where it puts the camera first.
std::vector<int> nearest_views(const Map& map, const Parameters& parameters, const TextHypothesis& hypothesis) {
  const TextObject& text = map.text(hypothesis.text);
  const Vec3 centre = hypothesis.T_c_w.inverse().t;
  std::vector<std::pair<double, int>> views;
  const auto add = [&](int id) {
    if (!map.keyframe(id).culled) views.emplace_back((map.keyframe(id).T_w_c.t - centre).norm(), id);
  };
  add(text.host);
  for (const int id : text.views) add(id);
  std::sort(views.begin(), views.end());
  std::vector<int> ids;
  for (const auto& [distance, id] : views)
    if (static_cast<int>(ids.size()) < parameters.place_candidates) ids.push_back(id);
  return ids;
}

// One small sign gives a rough pose: farther off than points are searched. Then the looks of the points around it tell
// the pose, and the sign must still stand where the detector saw one.
Relocalisation recognise_around(const Map& map, const Parameters& parameters, FrameLooks& looks,
                                const TextHypothesis& hypothesis) {
  const std::vector<int> keyframes = nearest_views(map, parameters, hypothesis);
  if (keyframes.empty()) return {};
  const MatchedPose pose = pose_by_places(map, parameters, looks, keyframes);
  if (pose.inliers == 0) return {};
  Relocalisation found = recognise_from(map, parameters, looks.frame(), pose.T_c_w);
  Quad<double> quad;
  if (!found.ok || !project_text(map, map.text(hypothesis.text), found.T_c_w, &quad)) return {};
  const auto& detections = looks.frame().detections;
  const bool stands = std::any_of(detections.begin(), detections.end(), [&](const Detection& detection) {
    return textplane::iou(quad, detection.quad) >= parameters.text_shown_iou;
  });
  return stands ? found : Relocalisation();
}

Relocalisation relocalise_by_keyframes(const Map& map, const Parameters& parameters, const Frame& frame) {
  struct Candidate {
    int keyframe;
    double zncc;
  };
  std::vector<Candidate> candidates;
  for (const int id : map.keyframe_ids()) {
    const RotationPrior prior =
        align_rotation(map.keyframe(id).frame, frame, map.camera, Eigen::Matrix3d::Identity(), parameters);
    if (prior.zncc > parameters.relocalise_min_image_zncc) candidates.push_back({id, prior.zncc});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.zncc > b.zncc; });
  if (static_cast<int>(candidates.size()) > parameters.relocalise_candidates)
    candidates.resize(static_cast<std::size_t>(parameters.relocalise_candidates));

  Relocalisation best;
  for (const Candidate& candidate : candidates) {
    const KeyFrame& keyframe = map.keyframe(candidate.keyframe);
    Tracker tracker(map, parameters);
    tracker.start(keyframe.frame, keyframe.T_w_c.inverse(), tracks_of_keyframe(map, candidate.keyframe));
    TrackReport report = tracker.track(frame);
    if (!report.ok || report.inliers <= best.inliers) continue;
    best = {std::move(report), FoundBy::images, std::move(tracker.tracks())};
  }
  // From so far away many tracks go wrong together; a search from the pose alone does not inherit that.
  if (best.ok) best = recognise_from(map, parameters, frame, best.T_c_w);
  best.by = FoundBy::images;
  return best;
}

}  // namespace

// A wrong pose would spoil the map, and another lost frame costs little.
bool holds(const Map& map, const Parameters& parameters, const TrackReport& found, const std::vector<Track>& tracks) {
  if (!found.ok || found.inliers < parameters.relocalise_min_share * expected_points(parameters, found)) return false;
  return found.texts >= parameters.enough_texts ||
         (found.inliers >= parameters.relocalise_inlier_factor * parameters.min_inliers &&
          points_off_texts(map, found.T_c_w, tracks) >= parameters.min_inliers);
}

Relocalisation observe_from(const Map& map, const Parameters& parameters, const Frame& frame, const SE3d& T_c_w) {
  Relocalisation best;
  SE3d guess = T_c_w;
  for (int round = 0; round < parameters.relocalise_rounds; ++round) {
    Tracker tracker(map, parameters);
    tracker.start(frame, guess, {});
    TrackReport report = tracker.track(frame);
    if (!report.ok || report.inliers + report.texts <= best.shown()) break;
    guess = report.T_c_w;
    best = {std::move(report), FoundBy::nothing, std::move(tracker.tracks())};
  }
  return best;
}

Relocalisation recognise_from(const Map& map, const Parameters& parameters, const Frame& frame, const SE3d& T_c_w) {
  Relocalisation found = observe_from(map, parameters, frame, T_c_w);
  return holds(map, parameters, found, found.tracks) ? found : Relocalisation();
}

Relocalisation relocalise_by_texts(const Map& map, const Parameters& parameters, const Frame& frame,
                                   const std::vector<WordMatch>& ways, FrameLooks* looks) {
  Relocalisation best;
  for (const WordMatch words : ways) {
    const std::vector<TextHypothesis> hypotheses = text_hypotheses(map, parameters, frame, words);
    for (const TextHypothesis& hypothesis : hypotheses)
      take_better(recognise_from(map, parameters, frame, hypothesis.T_c_w), &best);
    for (const TextHypothesis& hypothesis : hypotheses)
      if (looks != nullptr && !is_clear(parameters, best))
        take_better(recognise_around(map, parameters, *looks, hypothesis), &best);
    if (is_clear(parameters, best)) break;
  }
  best.by = FoundBy::texts;
  return best;
}

Relocalisation relocalise_by_places(const Map& map, const Parameters& parameters, const Frame& frame, FrameLooks& looks,
                                    const std::vector<PlaceRank>& places) {
  // One by one, then all together: those of a wide view share few points with the frame each.
  std::vector<std::vector<int>> tries;
  std::vector<int> all;
  for (const PlaceRank& place : places) {
    tries.push_back({place.keyframe});
    all.push_back(place.keyframe);
  }
  if (all.size() > 1) tries.push_back(all);
  for (const std::vector<int>& keyframes : tries) {
    const MatchedPose pose = pose_by_places(map, parameters, looks, keyframes);
    if (pose.inliers == 0) continue;
    Relocalisation found = recognise_from(map, parameters, frame, pose.T_c_w);
    found.by = FoundBy::points;
    if (found.ok) return found;
  }
  return {};
}

Relocalisation relocalise(const Map& map, const Parameters& parameters, const Frame& frame, FrameLooks& looks,
                          bool lost) {
  Relocalisation found;
  if (parameters.mode == Mode::text)
    found = relocalise_by_texts(map, parameters, frame, {WordMatch::same, WordMatch::other}, &looks);
  if (!is_clear(parameters, found)) take_better(relocalise_by_keyframes(map, parameters, frame), &found);
  if (is_clear(parameters, found)) return found;
  const int most = lost ? parameters.place_compared : parameters.place_compared_in_passing;
  take_better(relocalise_by_places(map, parameters, frame, looks,
                                   rank_places(map, parameters, looks, map.keyframe_ids(), most, frame.index)),
              &found);
  return found;
}

Relocalisation relocalise(const Map& map, const Parameters& parameters, const Frame& frame) {
  FrameLooks looks(frame, parameters);
  return relocalise(map, parameters, frame, looks, true);
}

}  // namespace textslam
