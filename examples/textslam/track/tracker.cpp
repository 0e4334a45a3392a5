#include "textslam/track/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "io/clock.hpp"
#include "textplane/landmarks/text_noise.hpp"
#include "textplane/landmarks/text_view.hpp"
#include "textplane/solver/pose.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/track/feature_tracks.hpp"
#include "textslam/track/pose_refit.hpp"
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

TrackReport Tracker::track(const Frame& frame) {
  TrackReport report;
  const double t0 = now_ms();
  const SE3d predicted = predict(frame);
  std::vector<Track> corners = take_corners();
  follow_points(frame, predicted);
  const double t1 = now_ms();
  SE3d pose = predicted;
  if (!fit_pose(frame, false, &pose, &report)) pose = predicted;
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
  velocity_ = pose * T_c_w_.inverse();
  moving_ = true;
  T_c_w_ = pose;
  frame_ = frame;
  return report;
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

Vec2f Tracker::guess(const Vec3& p_c, const Vec2f& otherwise) const {
  constexpr double kMinDepth = 0.1;  // nearer, the projection of a guess means nothing
  return p_c.z() > kMinDepth ? map_.camera.project(p_c).cast<float>() : otherwise;
}

// Points of the map are expected where the predicted pose sees them.
void Tracker::follow_points(const Frame& frame, const SE3d& predicted) {
  const Eigen::Matrix3d turn = predicted.R * T_c_w_.R.transpose();
  std::vector<Vec2f> guesses;
  for (const Track& track : tracks_)
    guesses.push_back(guess(track.inlier ? predicted * map_.point(track.point).p_w
                                         : Vec3(turn * map_.camera.unproject(track.px.cast<double>())),
                            track.px));
  advance_tracks(frame_, frame, guesses, parameters_, tracks_);
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
    if (p.z() > 0) depths.push_back({map_.camera.project(p).cast<float>(), p.z()});
  }
  const SE3d T_now_before = T_c_w * T_c_w_.inverse();
  std::vector<Vec2f> guesses;
  for (const Track& corner : corners) {
    const Vec3 ray = map_.camera.unproject(corner.px.cast<double>());
    const auto nearest = std::min_element(depths.begin(), depths.end(), [&](const Depth& a, const Depth& b) {
      return (a.px - corner.px).squaredNorm() < (b.px - corner.px).squaredNorm();
    });
    guesses.push_back(
        guess(nearest == depths.end() ? Vec3(T_now_before.R * ray) : T_now_before * (nearest->z * ray), corner.px));
  }
  advance_tracks(frame_, frame, guesses, parameters_, corners);
  tracks_.insert(tracks_.end(), std::make_move_iterator(corners.begin()), std::make_move_iterator(corners.end()));
}

void Tracker::reobserve(const Frame& frame, const SE3d& T_c_w, TrackReport* report) {
  const Vec3 centre = T_c_w.inverse().t;
  std::vector<int> track_of(map_.points.size(), -1);
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    if (tracks_[i].point >= 0) track_of[static_cast<std::size_t>(tracks_[i].point)] = static_cast<int>(i);

  std::vector<Candidate> untracked;
  for (std::size_t id = 0; id < map_.points.size(); ++id) {
    Candidate candidate;
    candidate.point = static_cast<int>(id);
    if (!looks_for_point(candidate.point) ||
        !predict_point(map_, parameters_, map_.points[id], T_c_w, centre, &candidate.prediction))
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

// Corners whose depth is not known yet, as points at the median depth of the key frame that saw them last: they hold
// the rotation, and less of the position the farther the camera is from there.
void Tracker::add_unmapped(const SE3d& T_c_w, std::vector<textplane::PosePointTerm>& points) const {
  const double focal = std::max(map_.camera.fx, map_.camera.fy);
  std::map<int, double> depths;
  for (const Track& track : tracks_) {
    if (track.point >= 0 || track.observations.empty()) continue;
    const PointObservation& seen = track.observations.back();
    const auto [found, fresh] = depths.try_emplace(seen.keyframe, 0);
    if (fresh) found->second = median_depth(map_, seen.keyframe);
    const double depth = found->second;
    if (!(depth > 0)) continue;
    const SE3d& T_w_k = map_.keyframe(seen.keyframe).T_w_c;
    const double shift = focal * (T_c_w * T_w_k).t.norm() / depth;
    points.push_back({T_w_k * Vec3(depth * map_.camera.unproject(seen.px)), track.px.cast<double>(),
                      std::hypot(parameters_.point_sigma, parameters_.hold_depth_spread * shift)});
  }
}

// How many of the texts look as their patches do.
int Tracker::agreeing(const Frame& frame, const std::vector<const TextObject*>& texts, const SE3d& T_c_w,
                      const std::vector<float>& zncc) const {
  int count = 0;
  const textplane::TextImage image = map_.text_image(frame);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const TextObject& text = *texts[i];
    const double least = text_zncc_limit(parameters_.text, parameters_.text.min_zncc, text.patch, 0, text.theta,
                                         map_.text_keyframe(text.host), image, map_.T_c_h(T_c_w, text.host));
    count += zncc[i] >= least ? 1 : 0;
  }
  return count;
}

// False where the pose does not hold. The report gets what it rests on.
bool Tracker::fit_pose(const Frame& frame, bool with_text, SE3d* T_c_w, TrackReport* report) {
  std::vector<textplane::PosePointTerm> points;
  std::vector<std::size_t> track_of;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (tracks_[i].point < 0 || !looks_for_point(tracks_[i].point)) continue;
    points.push_back({map_.point(tracks_[i].point).p_w, tracks_[i].px.cast<double>(), parameters_.point_sigma});
    track_of.push_back(i);
  }
  const int map_points = static_cast<int>(points.size());
  if (map_points < parameters_.hold_points) add_unmapped(*T_c_w, points);
  std::vector<textplane::PoseTextTerm> texts;
  std::vector<const TextObject*> seen;
  if (with_text)
    for (const TextObject& text : map_.texts) {
      Quad<double> quad;
      if (text.state != TextState::mapped || (local_ && !local_->has_text(text.id))) continue;
      if (!text_in_view(parameters_.text, text, map_.T_c_h(*T_c_w, text.host), map_.text_image(frame), &quad)) continue;
      texts.push_back({&text.patch, text.theta, map_.keyframe(text.host).T_w_c, 1, scale_shift(text, quad)});
      seen.push_back(&text);
    }

  const int text_count = static_cast<int>(texts.size()), point_count = static_cast<int>(points.size());
  report->points = map_points;
  report->inliers = report->texts = 0;
  if (point_count < parameters_.pose_min_points && texts.empty()) return false;
  textplane::PoseWorkspace workspace;
  workspace.reserve(texts.data(), text_count, point_count);
  textplane::PoseOptions options;
  options.sigma_photo = parameters_.photometric_sigma;
  options.coarsest_level = parameters_.text.levels - 1;
  std::vector<float> zncc(texts.size()), chi2(points.size());
  const auto result = textplane::refine_pose(texts.data(), text_count, points.data(), point_count, frame.image->view(),
                                             map_.camera, *T_c_w, options, workspace, zncc.data(), chi2.data());
  if (!textplane::is_ok(result.status) && result.status != textplane::Status::diverged) return false;
  *T_c_w = textplane::renormalised(result.T_t_w);
  report->information = result.information;
  int held = 0;
  for (std::size_t k = track_of.size(); k < points.size(); ++k) held += is_pose_inlier(parameters_, chi2[k]) ? 1 : 0;
  for (std::size_t k = 0; k < track_of.size(); ++k) {
    Track& track = tracks_[track_of[k]];
    track.inlier = is_pose_inlier(parameters_, chi2[k]);
    report->inliers += track.inlier ? 1 : 0;
  }
  report->texts = agreeing(frame, seen, *T_c_w, zncc);
  judge_position(*T_c_w, points, map_points, texts, report);
  if (!(report->position_sigma <= parameters_.max_position_sigma)) return false;
  const int inliers = report->inliers;
  // Corners without depth help to hold a pose. Alone they would pass it on from key frame to key frame.
  const bool enough_points = 2 * inliers >= parameters_.min_inliers && inliers + held >= parameters_.min_inliers &&
                             inliers + held >= parameters_.min_inlier_share * point_count;
  return enough_points || report->texts >= parameters_.enough_texts ||
         (report->texts > 0 && inliers >= parameters_.min_inliers / 2);
}

// The depths that corners are guessed at may all be wrong by the same factor: what they say of the position has that
// error in common, which the information does not know.
void Tracker::judge_position(const SE3d& T_c_w, const std::vector<textplane::PosePointTerm>& points, int map_points,
                             const std::vector<textplane::PoseTextTerm>& texts, TrackReport* report) const {
  std::vector<double> depths;
  const double known = parameters_.point_sigma * parameters_.point_sigma;
  double guessed = 0, all = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    depths.push_back((T_c_w * points[i].p_w).z());
    const double weight = 1 / (points[i].sigma * points[i].sigma);
    all += weight;
    if (static_cast<int>(i) >= map_points)
      guessed += weight * std::sqrt(std::max(0.0, points[i].sigma * points[i].sigma - known));
  }
  for (const textplane::PoseTextTerm& text : texts) {
    const Vec3 corner = textplane::plane_point<double>(text.theta, map_.camera.unproject(text.patch->quad.corner[0]));
    depths.push_back((T_c_w * (text.T_w_h * corner)).z());
  }
  const double focal = std::max(map_.camera.fx, map_.camera.fy), depth = median(std::move(depths));
  report->position_sigma = position_sigma(report->information) / depth + (all > 0 ? guessed / all / focal : 0);
}

}  // namespace textslam
