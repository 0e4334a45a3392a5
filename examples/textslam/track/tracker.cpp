#include "textslam/track/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "io/clock.hpp"
#include "textslam/track/feature_tracks.hpp"
#include "textslam/track/rotation_prior.hpp"

namespace textslam {

void Tracker::start(const Frame& frame, const SE3d& T_c_w, std::vector<Track> tracks) {
  frame_ = frame;
  T_c_w_ = T_c_w;
  velocity_ = SE3d{};
  moving_ = false;
  tracks_ = std::move(tracks);
}

void Tracker::correct(const SE3d& T_c_w, double scale) {
  T_c_w_ = T_c_w;
  velocity_.t *= scale;
}

TrackReport Tracker::track(const Frame& taken) {
  TrackReport report;
  const double t0 = now_ms();
  Frame frame = taken;
  const SE3d predicted = predict(frame);
  roll(predicted, taken, &frame);
  std::vector<Track> corners = take_corners();
  follow_points(frame, predicted);
  const double t1 = now_ms();
  SE3d pose = predicted;
  if (!fit_pose(frame, false, &pose, &report)) pose = predicted;
  roll(pose, taken, &frame);
  const double t2 = now_ms();
  follow_corners(frame, pose, std::move(corners));
  const double t3 = now_ms();
  reobserve(frame, pose, &report);
  const double t4 = now_ms();
  report.ok = fit_pose(frame, parameters_.mode == Mode::text, &pose, &report);
  const double t5 = now_ms();
  report.klt_ms = (t1 - t0) + (t3 - t2);
  report.reobserve_ms = t4 - t3;
  report.pose_ms = (t2 - t1) + (t5 - t4);
  if (!report.ok) pose = predicted;
  report.T_c_w = pose;

  for (const Track& track : tracks_)
    if (track.point >= 0 && track.inlier) report.found.push_back(track.point);
  roll(pose, taken, &frame);
  velocity_ = pose * T_c_w_.inverse();
  seconds_ = frame.timestamp - frame_.timestamp;
  speed_ = textplane::velocity_between(T_c_w_, pose, seconds_);
  moving_ = true;
  T_c_w_ = pose;
  frame_ = std::move(frame);
  return report;
}

// The motion of a frame's rows, if its pose is this and the motion is not known: that between the last two frames, and
// as much on as it changed there.
void Tracker::roll(const SE3d& T_c_w, const Frame& taken, Frame* frame) const {
  if (taken.rows || !is_rolling(map_, parameters_)) return;
  const double seconds = frame->timestamp - frame_.timestamp;
  const Vector6 speed = textplane::velocity_between(T_c_w_, T_c_w, seconds);
  const double share = moving_ && seconds_ * seconds > 0 ? seconds / (seconds + seconds_) : 0;
  frame->rows = std::make_shared<const textplane::RowMotion>(
      textplane::RowMotion{speed + share * (speed - speed_), map_.shutter});
}

SE3d Tracker::predict(const Frame& frame) const {
  const Eigen::Matrix3d last_turn = moving_ ? velocity_.R : Eigen::Matrix3d::Identity();
  const RotationPrior prior = find_rotation(frame_, frame, map_.camera, last_turn, parameters_);
  SE3d predicted = (moving_ ? velocity_ : SE3d{}) * T_c_w_;
  // Alignment takes sideways motion for rotation, so it replaces the velocity only where they are far apart.
  if (prior.zncc > parameters_.rotation_min_zncc &&
      textplane::so3_log<double>(prior.R_b_a * last_turn.transpose()).norm() >
          radians(parameters_.rotation_max_change)) {
    const Vec3 centre = predicted.inverse().t;
    predicted.R = prior.R_b_a * T_c_w_.R;
    predicted.t = -(predicted.R * centre);
  }
  return predicted;
}

// The tracks that have no point of the map, which are left.
std::vector<Track> Tracker::take_corners() {
  const auto first = std::stable_partition(tracks_.begin(), tracks_.end(), [](const Track& t) { return t.point >= 0; });
  std::vector<Track> corners(std::make_move_iterator(first), std::make_move_iterator(tracks_.end()));
  tracks_.erase(first, tracks_.end());
  return corners;
}

Vec2f Tracker::guess(const Frame& frame, const Vec3& p_c, const Vec2f& otherwise) const {
  constexpr double kMinDepth = 0.1;  // nearer, the projection of a guess means nothing
  Vec2 px;
  return p_c.z() > kMinDepth && show(map_.view_of(frame), p_c, &px) ? px.cast<float>() : otherwise;
}

// Points of the map are expected where the predicted pose sees them.
void Tracker::follow_points(const Frame& frame, const SE3d& predicted) {
  const Eigen::Matrix3d turn = predicted.R * T_c_w_.R.transpose();
  std::vector<Vec2f> guesses;
  for (const Track& track : tracks_)
    guesses.push_back(guess(frame,
                            track.inlier ? predicted * map_.point(track.point).p_w
                                         : Vec3(turn * ray_of(map_.camera, track.px.cast<double>())),
                            track.px));
  advance_tracks(frame_, frame, map_.camera, guesses, parameters_, tracks_);
}

// Corners without depth are expected as if they were as far away as the nearest point of the map.
void Tracker::follow_corners(const Frame& frame, const SE3d& T_c_w, std::vector<Track> corners) {
  struct Depth {
    Vec2f px;
    double z;
  };
  std::vector<Depth> depths;
  for (const Track& track : tracks_) {
    if (!track.inlier) continue;
    const Vec3 p = T_c_w_ * map_.point(track.point).p_w;
    Vec2 px;
    if (show(map_.view_of(frame_), p, &px)) depths.push_back({px.cast<float>(), p.z()});
  }
  const SE3d T_now_before = T_c_w * T_c_w_.inverse();
  std::vector<Vec2f> guesses;
  for (const Track& corner : corners) {
    const Vec3 ray = ray_of(map_.camera, corner.px.cast<double>());
    const auto nearest = std::min_element(depths.begin(), depths.end(), [&](const Depth& a, const Depth& b) {
      return (a.px - corner.px).squaredNorm() < (b.px - corner.px).squaredNorm();
    });
    Vec3 p = nearest == depths.end() ? ray : Vec3(nearest->z * ray);
    if (nearest != depths.end() && frame_.rows) p = frame_.rows->at(static_cast<double>(corner.px.y())).inverse() * p;
    guesses.push_back(guess(frame, nearest == depths.end() ? Vec3(T_now_before.R * p) : T_now_before * p, corner.px));
  }
  advance_tracks(frame_, frame, map_.camera, guesses, parameters_, corners);
  tracks_.insert(tracks_.end(), std::make_move_iterator(corners.begin()), std::make_move_iterator(corners.end()));
}

void Tracker::reobserve(const Frame& frame, const SE3d& T_c_w, TrackReport* report) {
  const Vec3 centre = T_c_w.inverse().t;
  const CameraView camera = map_.view_of(frame);
  std::vector<int> track_of(map_.points.size(), -1);
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    if (tracks_[i].point >= 0) track_of[static_cast<std::size_t>(tracks_[i].point)] = static_cast<int>(i);

  std::vector<Candidate> untracked;
  for (std::size_t id = 0; id < map_.points.size(); ++id) {
    Candidate candidate;
    candidate.point = static_cast<int>(id);
    if (!looks_for_point(candidate.point) ||
        !predict_point(map_, parameters_, map_.points[id], camera, T_c_w, centre, &candidate.prediction))
      continue;
    report->visible.push_back(candidate.point);
    if (track_of[id] < 0) {
      untracked.push_back(candidate);
      continue;
    }
    // A tracked corner is pulled back onto its patch, so that errors do not add up from frame to frame.
    Track& track = tracks_[static_cast<std::size_t>(track_of[id])];
    Vec2f refined = track.px;
    if (find_point(map_, parameters_, candidate.prediction, frame, 0, &refined) &&
        (refined - track.px).norm() < parameters_.max_patch_drift)
      track.px = refined;
  }

  // An even choice where there are too many.
  const std::size_t limit = static_cast<std::size_t>(parameters_.max_reobserved);
  const std::size_t stride = untracked.size() / limit + 1;
  for (std::size_t i = static_cast<std::size_t>(frame.index) % stride; i < untracked.size(); i += stride)
    relocate(frame, untracked[i]);
}

void Tracker::relocate(const Frame& frame, const Candidate& candidate) {
  const Vec2& predicted = candidate.prediction.px;
  Vec2f px = predicted.cast<float>();
  if (!find_point(map_, parameters_, candidate.prediction, frame, parameters_.relocation_level, &px) ||
      (px.cast<double>() - predicted).norm() > parameters_.relocation_search)
    return;
  // A corner tracked at the same place is the same thing; the older point stands for it from here on.
  for (Track& track : tracks_) {
    if ((track.px - px).squaredNorm() > parameters_.same_corner * parameters_.same_corner) continue;
    if (track.point < 0 || track.point > candidate.point) {
      track.point = candidate.point;
      track.observations.clear();
      track.px = px;
    }
    return;
  }
  tracks_.push_back({px, candidate.point});
}

}  // namespace textslam
