#include "textslam/loop/loop_closure.hpp"

#include <algorithm>

#include "textplane/geometry/quad.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/text_views.hpp"
#include "textslam/track/pose_refit.hpp"

namespace textslam {
namespace {

Map part_of(const Map& map, const LocalMap& local, bool inside) {
  Map part = map;
  for (std::size_t i = 0; i < part.points.size(); ++i) {
    if (local.has_point(static_cast<int>(i)) == inside) continue;
    part.points[i].bad = true;
    part.points[i].observations.clear();
  }
  for (KeyFrame& keyframe : part.keyframes) erase_if(keyframe.points, [&](int id) { return part.point(id).bad; });
  for (TextObject& text : part.texts)
    if (local.has_text(text.id) != inside) text.state = TextState::dropped;
  return part;
}

// Points outside the local map that key frame `id` would see if there were no drift.
int old_points_in_view(const Map& map, const LocalMap& local, const Parameters& parameters, int id) {
  const SE3d& T_w_c = map.keyframe(id).T_w_c;
  const SE3d T_c_w = T_w_c.inverse();
  int count = 0;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const MapPoint& point = map.points[i];
    if (point.bad || local.has_point(static_cast<int>(i))) continue;
    const Vec3 p = T_c_w * point.p_w;
    if (!map.camera.in_domain(p)) continue;
    const Vec2 px = map.camera.project(p);
    if (!(px.x() >= 0 && px.y() >= 0 && px.x() < map.width && px.y() < map.height)) continue;
    const Vec3 from_host = point.p_w - map.keyframe(point.observations.front().keyframe).T_w_c.t;
    count += (point.p_w - T_w_c.t).normalized().dot(from_host.normalized()) > parameters.min_view_cosine ? 1 : 0;
  }
  return count;
}

// Detections that may be old texts: those that read like one, and unread ones on no text of the local map.
std::vector<Detection> detections_of_old(const Map& map, const LocalMap& local, const Parameters& parameters,
                                         const KeyFrame& keyframe) {
  const SE3d T_c_w = keyframe.T_w_c.inverse();
  std::vector<std::string> words;
  std::vector<Quad<double>> known;
  for (const TextObject& text : map.texts) {
    Quad<double> quad;
    if (text.state != TextState::mapped) continue;
    if (!local.has_text(text.id)) {
      words.push_back(textplane::consensus(text.votes));
    } else if (facing(map, text, T_c_w) > 0 && project_text(map, text, T_c_w, &quad)) {
      known.push_back(quad);
    }
  }
  std::vector<Detection> out;
  if (words.empty()) return out;
  for (const Detection& detection : keyframe.frame.detections) {
    const bool wanted = is_read(detection.text)
                            ? std::find(words.begin(), words.end(), detection.text) != words.end()
                            : std::none_of(known.begin(), known.end(), [&](const Quad<double>& quad) {
                                return textplane::iou(quad, detection.quad) >= parameters.text_shown_iou;
                              });
    if (wanted) out.push_back(detection);
  }
  return out;
}

// The key frame, of the old part, that shows most of the points seen.
int key_frame_met(const Map& old_part, const Relocalisation& seen) {
  std::vector<int> counts(old_part.keyframes.size(), 0);
  for (const Track& track : seen.tracks)
    if (track.point >= 0 && track.inlier)
      for (const PointObservation& o : old_part.point(track.point).observations)
        ++counts[static_cast<std::size_t>(o.keyframe)];
  return static_cast<int>(std::max_element(counts.begin(), counts.end()) - counts.begin());
}

// Key frames of the old part that look like the newest.
std::vector<PlaceRank> old_places(const Map& map, const LocalMap& local, const Parameters& parameters,
                                  const Frame& frame, FrameLooks& looks) {
  std::vector<int> ids = map.keyframe_ids();
  erase_if(ids, [&](int id) { return local.has_keyframe(id); });
  if (ids.empty()) return {};
  keep_corners(map, map.newest_keyframe(), looks);  // the ranking describes the frame anyway
  return rank_places(map, parameters, looks, ids, parameters.place_compared_in_passing, frame.index);
}

// Places that look the same may lie far apart; no drift takes one to the other.
bool is_credible_drift(const Map& map, const Parameters& parameters, int newest, int met, const Relocalisation& seen) {
  const double shift = (seen.T_c_w.inverse().t - map.keyframe(newest).T_w_c.t).norm();
  return shift <= parameters.loop_most_drift * path_length_between(map, met, newest);
}

}  // namespace

double path_length_between(const Map& map, int a, int b) {
  double way = 0;
  int before = a;
  for (int id = a + 1; id <= b; ++id) {
    if (map.keyframe(id).culled) continue;
    way += (map.keyframe(id).T_w_c.t - map.keyframe(before).T_w_c.t).norm();
    before = id;
  }
  return way;
}

Map old_part(const Map& map, const LocalMap& local) { return part_of(map, local, false); }
Map recent_part(const Map& map, const LocalMap& local) { return part_of(map, local, true); }

Loop find_loop(const Map& map, const LocalMap& local, const Parameters& parameters) {
  Loop loop;
  loop.keyframe = map.newest_keyframe();
  const KeyFrame& newest = map.keyframe(loop.keyframe);
  const bool expected = old_points_in_view(map, local, parameters, loop.keyframe) >=
                        parameters.loop_expected_factor * parameters.min_inliers;
  Frame frame = newest.frame;
  frame.detections.clear();
  if (parameters.mode == Mode::text) frame.detections = detections_of_old(map, local, parameters, newest);
  Map old;
  if (expected || !frame.detections.empty()) old = old_part(map, local);
  if (expected) loop.seen = recognise_from(old, parameters, frame, newest.T_w_c.inverse());
  if (!loop.seen.ok && !frame.detections.empty())
    loop.seen = relocalise_by_texts(old, parameters, frame, {WordMatch::same, WordMatch::unread});
  if (!loop.seen.ok) {
    FrameLooks looks(frame, parameters);
    const std::vector<PlaceRank> places = old_places(map, local, parameters, frame, looks);
    if (places.empty()) return loop;
    old = old_part(map, local);
    loop.seen = relocalise_by_places(old, parameters, frame, looks, places);
    if (loop.seen.ok && !is_credible_drift(map, parameters, loop.keyframe, key_frame_met(old, loop.seen), loop.seen))
      loop.seen = {};
  }
  if (!loop.seen.ok) return loop;
  loop.link = link_maps(old, recent_part(map, local), parameters, loop.seen);
  loop.met = key_frame_met(old, loop.seen);
  loop.ok = loop.link.ok;
  return loop;
}

Drift drift_left(const Map& map, const Parameters& parameters, const Loop& loop) {
  Drift left;
  const SE3d& T_w_c = map.keyframe(loop.keyframe).T_w_c;
  PoseEstimate refitted{T_w_c.inverse()};
  const std::vector<SeenPoint> old_points = seen_points(loop.seen.tracks, loop.seen.tracks.size());
  if (!refit_pose(map, parameters, map.view_of(loop.keyframe), old_points, &refitted)) return left;
  const SE3d& by_old = refitted.T_c_w;
  const SE3d T_c_w = T_w_c.inverse();
  std::vector<double> ratios;
  for (const SeenPoint& seen : old_points)
    if (!map.point(seen.point).bad)
      ratios.push_back((by_old * map.point(seen.point).p_w).z() / (T_c_w * map.point(seen.point).p_w).z());
  return {(by_old.inverse().t - T_w_c.t).norm() / path_length_between(map, loop.met, loop.keyframe),
          degrees(by_old.R * T_w_c.R), median(std::move(ratios))};
}

}  // namespace textslam
