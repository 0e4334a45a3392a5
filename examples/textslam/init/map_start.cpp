#include "textslam/init/map_start.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/geometry/quad.hpp"
#include "textslam/adjust/adjustment.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/init/two_view.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/map/point_normals.hpp"
#include "textslam/track/feature_tracks.hpp"
#include "textslam/track/frame_turns.hpp"
#include "textslam/track/point_mapper.hpp"
#include "textslam/track/track_from_keyframe.hpp"

namespace textslam {

namespace {

// The ray of a pixel of the frame, had the camera stood still while the rows were taken. All that looks for the motion
// of two views takes these, or their pixels.
Vec3 standing_ray(const Frame& frame, const CameraView& camera, const Vec2& px) {
  return ray_at_pose({camera.pinhole, camera.lens, frame.rows.get()}, px);
}
Vec2 standing(const Frame& frame, const CameraView& camera, const Vec2& px) {
  if (!frame.rows) return px;
  const Vec3 ray = standing_ray(frame, camera, px);
  return camera.in_domain(ray) ? camera.project(ray) : px;
}

}  // namespace

MapStart::MapStart(const Frame& reference, const CameraView& camera, const Parameters& parameters)
    : parameters_(parameters), reference_(reference), hypotheses_(parameters) {
  std::vector<Quad<double>> quads;
  if (parameters.mode == Mode::text) quads = quads_of(reference.detections);
  add_corners(reference, camera, 0, quads, parameters, tracks_);
  corners_ = static_cast<int>(tracks_.size());
}

void MapStart::know_rows(std::shared_ptr<const textplane::RowMotion> rows, double unsure) {
  reference_.rows = std::move(rows);
  unsure_ = unsure;
}

void MapStart::add_detections(std::vector<Detection> detections, const CameraView& camera, const Frame& last) {
  reference_.detections = std::move(detections);
  // Hypotheses are judged by corners that were followed from their first view on.
  if (parameters_.mode != Mode::text || !hypotheses_.empty()) return;
  const std::vector<Quad<double>> quads = quads_of(reference_.detections);
  std::vector<Track> then = tracks_;
  std::vector<Vec2f> now;
  for (Track& track : then) {
    now.push_back(track.px);
    track.px = track.observations.front().px.cast<float>();
  }
  const std::vector<Track> corners = track_from_keyframe(reference_, camera, 0, quads, then, now, last, parameters_);
  tracks_.insert(tracks_.end(), corners.begin(), corners.end());
}

void MapStart::follow(const Frame& last, const Frame& newest, const Eigen::Matrix3d& R_newest_last,
                      const CameraView& camera) {
  std::vector<Vec2f> guesses;
  for (const Track& track : tracks_) {
    const Vec3 m = R_newest_last * ray_of(camera, track.px.cast<double>());
    guesses.push_back(camera.in_domain(m) ? camera.project(m).cast<float>() : track.px);
  }
  advance_tracks(last, newest, camera, guesses, parameters_, tracks_);
  if (last.index == reference_.index) beside_ = newest;
}

bool MapStart::build(const Frame& newest, double unsure, Map& map, std::vector<Track>* tracks) {
  const std::optional<Motion> motion = hypotheses_.empty() ? motion_of_two_views(newest, unsure, map.camera)
                                                           : motion_of_hypotheses(newest, unsure, map.camera);
  return motion && build_by(*motion, newest, map, tracks);
}

// Radians, of the direction of translation. A wrong motion of the rows is an error that matches share, so it does not
// get smaller with their number. `off` is its root mean square over the rows; the parallax tells the direction.
double MapStart::error_of_rows(const Frame& newest, double unsure, double parallax) const {
  if (!newest.rows) return 0;
  const double off = std::abs(newest.rows->shutter.readout) / std::sqrt(12.0) * std::max(unsure_, unsure);
  return off > 0 ? off / radians(parallax) : 0;
}

// Corners on texts are strong ones, and fewer of them do. An image that shows few corners cannot lose many of them, and
// the motion by them must be known as well as by many.
int MapStart::matches_needed() const {
  const int share = static_cast<int>(parameters_.init_match_share * corners_);
  const int fewest = std::min(parameters_.init_min_text_matches, parameters_.init_min_matches);
  const int needed = std::clamp(share, fewest, parameters_.init_min_matches);
  if (parameters_.mode != Mode::text) return needed;
  const std::vector<Quad<double>> quads = quads_of(reference_.detections);
  int on_text = 0;
  for (const Track& track : tracks_)
    on_text += std::any_of(quads.begin(), quads.end(), [&](const Quad<double>& quad) {
      return textplane::contains(quad, track.observations[0].px);
    });
  return on_text >= parameters_.init_min_text_matches ? parameters_.init_min_text_matches : needed;
}

std::optional<MapStart::Motion> MapStart::motion_of_two_views(const Frame& newest, double unsure,
                                                              const CameraView& camera) {
  std::vector<Vec3> a, b;
  for (const Track& track : tracks_) {
    a.push_back(standing_ray(reference_, camera, track.observations[0].px));
    b.push_back(standing_ray(newest, camera, track.px.cast<double>()));
  }
  const TwoView view = estimate_two_view(a, b, camera.pinhole.fx, parameters_);
  if (!view.ok || view.inliers < matches_needed() || view.parallax < parameters_.init_min_parallax ||
      std::hypot(view.direction_sigma, error_of_rows(newest, unsure, view.parallax)) > parameters_.init_max_direction ||
      view.rms > parameters_.init_max_rms)
    return std::nullopt;
  const double limit = clear_ratio(static_cast<double>(a.size()) - kTwoViewFreedom, parameters_.init_clear);
  std::vector<SE3d> close;
  for (const TwoViewMotion& motion : view.motions)
    if (motion.cost <= limit * view.motions.front().cost) close.push_back(motion.T_b_a);
  if (close.size() < 2) return Motion{view.T_b_a, view.inlier};
  hypotheses_.begin(close);
  began_ = newest.timestamp;
  for (Track& track : tracks_) track.observations.push_back({1, standing(newest, camera, track.px.cast<double>())});
  return std::nullopt;
}

std::optional<MapStart::Motion> MapStart::motion_of_hypotheses(const Frame& newest, double unsure,
                                                               const CameraView& camera) {
  std::vector<double> flow;
  for (const Track& track : tracks_) flow.push_back((track.observations.back().px - track.px.cast<double>()).norm());
  if (median(std::move(flow)) < parameters_.init_view_flow) return std::nullopt;
  const bool full = static_cast<int>(tracks_[0].observations.size()) >= parameters_.init_views;
  for (Track& track : tracks_) {
    if (full) track.observations.pop_back();
    track.observations.push_back(
        {static_cast<int>(track.observations.size()), standing(newest, camera, track.px.cast<double>())});
  }
  std::vector<Track> all_standing = tracks_;
  for (Track& track : all_standing) track.observations[0].px = standing(reference_, camera, track.observations[0].px);
  hypotheses_.judge(all_standing, camera, full);
  if (hypotheses_.rms() > parameters_.init_max_rms) {
    contradicted_ = true;
    return std::nullopt;
  }
  if (!hypotheses_.won() && newest.timestamp - began_ < parameters_.init_patience) return std::nullopt;
  const Motion best{hypotheses_.T_newest_a(), hypotheses_.inlier()};
  if (std::count(best.inlier.begin(), best.inlier.end(), 1) < matches_needed()) return std::nullopt;
  // The camera may have come back to where it began.
  const double found = parallax(best, newest, camera);
  if (found < parameters_.init_min_parallax || error_of_rows(newest, unsure, found) > parameters_.init_max_direction)
    return std::nullopt;
  return best;
}

// Degrees, median over the inliers, the rotation removed.
double MapStart::parallax(const Motion& motion, const Frame& newest, const CameraView& camera) const {
  std::vector<double> angles;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (!motion.inlier[i]) continue;
    const Vec3 turned = motion.T_b_a.R * standing_ray(reference_, camera, tracks_[i].observations[0].px);
    angles.push_back(degrees_between(turned, standing_ray(newest, camera, tracks_[i].px.cast<double>())));
  }
  return median(std::move(angles));
}

bool MapStart::build_by(const Motion& motion, const Frame& newest, Map& map, std::vector<Track>* tracks) {
  map.clear();
  std::vector<Track> kept;
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    if (motion.inlier[i]) {
      kept.push_back(tracks_[i]);
      kept.back().observations.resize(1);
    }
  const SE3d T_w_b = motion.T_b_a.inverse();
  map.keyframes.push_back({reference_, SE3d{}, {}, false});
  insert_keyframe(map, newest, T_w_b, kept);
  triangulate_tracks(map, parameters_, parameters_.init_parallax_share * parameters_.init_min_parallax, kept);
  adjust_all(map, parameters_, parameters_.init_adjust_iterations);

  int points = 0;
  for (const MapPoint& point : map.points) points += point.bad ? 0 : 1;
  const double depth = median_depth(map, 0);
  if (points < matches_needed() / 2 || !(depth > 0)) {
    map.clear();
    return false;
  }
  for (KeyFrame& keyframe : map.keyframes) keyframe.T_w_c.t /= depth;
  for (MapPoint& point : map.points) point.p_w /= depth;
  for (const int id : map.keyframe_ids()) fit_point_normals(map, parameters_, id);
  erase_bad_tracks(map, kept);
  *tracks = std::move(kept);
  return true;
}

}  // namespace textslam
