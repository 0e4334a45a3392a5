#include "textslam/initialiser.hpp"

#include <algorithm>

#include "textslam/adjustment.hpp"
#include "textslam/feature_tracks.hpp"
#include "textslam/late_corners.hpp"
#include "textslam/point_mapper.hpp"
#include "textslam/rotation_prior.hpp"
#include "textslam/two_view.hpp"

namespace textslam {

void Initialiser::restart(const Frame& frame) {
  reference_ = last_ = frame;
  tracks_.clear();
  std::vector<Quad<double>> quads;
  if (parameters_.mode == Mode::text) quads = quads_of(frame.detections);
  add_corners(frame, 0, quads, parameters_, tracks_);
  frames_ = ambiguous_ = 0;
}

void Initialiser::add_detections(int frame, std::vector<Detection> detections) {
  if (tracks_.empty() || reference_.index != frame) return;
  reference_.detections = std::move(detections);
  if (parameters_.mode != Mode::text) return;
  const std::vector<Quad<double>> quads = quads_of(reference_.detections);
  std::vector<Track> then = tracks_;
  std::vector<Vec2f> now;
  for (Track& track : then) {
    now.push_back(track.px);
    track.px = track.observations.front().px.cast<float>();
  }
  const std::vector<Track> corners = late_corners(reference_, 0, quads, then, now, last_, parameters_);
  tracks_.insert(tracks_.end(), corners.begin(), corners.end());
}

bool Initialiser::add(const Frame& frame, Map& map, std::vector<Track>* tracks) {
  if (tracks_.empty()) {
    restart(frame);
    return false;
  }
  const RotationPrior prior = align_rotation(last_, frame, map.camera, Eigen::Matrix3d::Identity());
  std::vector<Vec2f> guesses;
  for (const Track& track : tracks_) {
    const Vec3 m = prior.R_b_a * map.camera.unproject(track.px.cast<double>());
    guesses.push_back(map.camera.project(m).cast<float>());
  }
  advance_tracks(last_, frame, guesses, parameters_, tracks_);
  last_ = frame;
  ++frames_;
  if (static_cast<int>(tracks_.size()) < parameters_.init_min_matches) {
    restart(frame);
    return false;
  }
  return build(frame, map, tracks);
}

bool Initialiser::build(const Frame& frame, Map& map, std::vector<Track>* tracks) {
  std::vector<Vec3> a, b;
  for (const Track& track : tracks_) {
    a.push_back(map.camera.unproject(track.observations[0].px));
    b.push_back(map.camera.unproject(track.px.cast<double>()));
  }
  const TwoView view = estimate_two_view(a, b, map.camera.fx);
  if (!view.ok || view.inliers < parameters_.init_min_matches || view.parallax < parameters_.init_min_parallax ||
      view.direction_sigma > parameters_.init_max_direction || view.rms > parameters_.init_max_rms)
    return false;
  if (view.ambiguity < parameters_.init_ambiguity && ++ambiguous_ < parameters_.init_patience) return false;

  map.keyframes.clear();
  map.points.clear();
  map.texts.clear();
  std::vector<Track> kept;
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    if (view.inlier[i]) kept.push_back(tracks_[i]);
  const SE3d T_w_b = view.T_b_a.inverse();
  map.keyframes.push_back({reference_, SE3d{}, {}, false});
  insert_keyframe(map, frame, T_w_b, kept);
  Parameters loose = parameters_;
  loose.min_parallax = 0.5 * parameters_.init_min_parallax;
  triangulate_tracks(map, loose, kept);
  adjust_all(map, parameters_, 20);

  int points = 0;
  for (const MapPoint& point : map.points) points += point.bad ? 0 : 1;
  const double depth = median_depth(map, 0);
  if (points < parameters_.init_min_matches / 2 || !(depth > 0)) {
    map.keyframes.clear();
    map.points.clear();
    return false;
  }
  for (KeyFrame& keyframe : map.keyframes) keyframe.T_w_c.t /= depth;
  for (MapPoint& point : map.points) point.p_w /= depth;
  kept.erase(
      std::remove_if(kept.begin(), kept.end(), [&](const Track& t) { return t.point >= 0 && map.point(t.point).bad; }),
      kept.end());
  *tracks = std::move(kept);
  tracks_.clear();
  return true;
}

}  // namespace textslam
