// Tracker, the part that fits the pose of a frame and judges it.
#include <algorithm>
#include <cmath>
#include <map>

#include "textplane/landmarks/text_noise.hpp"
#include "textplane/landmarks/text_view.hpp"
#include "textplane/solver/pose.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/track/pose_refit.hpp"
#include "textslam/track/tracker.hpp"

namespace textslam {

// Corners whose depth is not known yet, as points at the median depth of the key frame that saw them last: they hold
// the rotation, and less of the position the farther the camera is from there.
void Tracker::add_unmapped(const SE3d& T_c_w, std::vector<textplane::PosePointTerm>& points) const {
  const double focal = std::max(map_.camera.pinhole.fx, map_.camera.pinhole.fy);
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
    Vec3 p = depth * ray_of(map_.camera, seen.px);
    if (const auto& rows = map_.keyframe(seen.keyframe).frame.rows) p = rows->at(seen.px.y()).inverse() * p;
    points.push_back({T_w_k * p, track.px.cast<double>(),
                      std::hypot(parameters_.point_sigma, parameters_.hold_depth_spread * shift)});
  }
}

// The mapped texts that a camera at T_c_w sees.
std::vector<Tracker::SeenText> Tracker::texts_in_view(const Frame& frame, const SE3d& T_c_w) const {
  std::vector<SeenText> seen;
  for (const TextObject& text : map_.texts) {
    Quad<double> quad;
    if (text.state != TextState::mapped || (local_ && !local_->has_text(text.id))) continue;
    if (!text_in_view(parameters_.text, text, map_.T_c_h(T_c_w, text.host), map_.text_image(frame), &quad)) continue;
    seen.push_back({&text, {&text.patch, text.theta, map_.keyframe(text.host).T_w_c, 1, scale_shift(text, quad)}});
  }
  return seen;
}

// The ZNCC that a text has which looks as its patch does.
double Tracker::least_zncc(const Frame& frame, const TextObject& text, const SE3d& T_c_w) const {
  return text_zncc_limit(parameters_.text, parameters_.text.min_zncc, text.patch, 0, text.theta,
                         map_.text_keyframe(text.host), map_.text_image(frame), map_.T_c_h(T_c_w, text.host));
}

float Tracker::chi2_of(const Track& track, const CameraView& camera, const SE3d& T_c_w) const {
  return pose_chi2(camera, T_c_w, map_.point(track.point).p_w, track.px.cast<double>(), parameters_.point_sigma);
}

// The tracks of map points: first the `heard` ones, which may move the pose. One that did not fit the last pose, and
// that this one expects beyond outlier_reach, may not: a Huber weight bounds the error, but not its Jacobian. A point
// at a wrong depth that the camera passes would pull harder than all others together.
std::vector<std::size_t> Tracker::tracks_of_points(const CameraView& camera, const SE3d& T_c_w,
                                                   std::size_t* heard) const {
  std::vector<std::size_t> tracks;
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    if (tracks_[i].point >= 0 && looks_for_point(tracks_[i].point)) tracks.push_back(i);
  const auto rest = std::stable_partition(tracks.begin(), tracks.end(), [&](std::size_t i) {
    if (tracks_[i].inlier) return true;
    const float chi2 = chi2_of(tracks_[i], camera, T_c_w);
    return chi2 >= 0 && chi2 < parameters_.outlier_reach * parameters_.outlier_reach;
  });
  *heard = static_cast<std::size_t>(rest - tracks.begin());
  if (*heard < static_cast<std::size_t>(parameters_.min_inliers)) *heard = tracks.size();
  return tracks;
}

// One solve, and what is left of each term then.
bool Tracker::refine(const Frame& frame, const std::vector<textplane::PosePointTerm>& points,
                     std::vector<SeenText>& texts, std::vector<float>& chi2, SE3d* T_c_w, TrackReport* report) const {
  std::vector<textplane::PoseTextTerm> terms;
  for (const SeenText& seen : texts) terms.push_back(seen.term);
  const int text_count = static_cast<int>(terms.size()), point_count = static_cast<int>(points.size());
  textplane::PoseWorkspace workspace;
  workspace.reserve(terms.data(), text_count, point_count);
  textplane::PoseOptions options;
  options.sigma_photo = parameters_.photometric_sigma;
  options.coarsest_level = parameters_.text.levels - 1;
  std::vector<float> zncc(texts.size());
  const auto result = textplane::refine_pose(terms.data(), text_count, points.data(), point_count, frame.image->view(),
                                             map_.view_of(frame), *T_c_w, options, workspace, zncc.data(), chi2.data());
  if (!textplane::is_ok(result.status) && result.status != textplane::Status::diverged) return false;
  for (std::size_t i = 0; i < texts.size(); ++i) texts[i].zncc = zncc[i];
  *T_c_w = textplane::renormalised(result.T_t_w);
  report->information = result.information;
  return true;
}

// False where the pose does not hold. The report gets what it rests on. A text that is not seen where the pose expects
// it, as it is hidden or the pose is wrong, takes no part: its pixels would hold a wrong pose against the points.
bool Tracker::fit_pose(const Frame& frame, bool with_text, SE3d* T_c_w, TrackReport* report) {
  std::size_t heard = 0;
  const std::vector<std::size_t> track_of = tracks_of_points(map_.view_of(frame), *T_c_w, &heard);
  std::vector<textplane::PosePointTerm> points;
  for (std::size_t k = 0; k < heard; ++k) {
    const Track& track = tracks_[track_of[k]];
    points.push_back({map_.point(track.point).p_w, track.px.cast<double>(), parameters_.point_sigma});
  }
  const int map_points = static_cast<int>(heard);
  if (map_points < parameters_.hold_points) add_unmapped(*T_c_w, points);
  std::vector<SeenText> texts;
  if (with_text) texts = texts_in_view(frame, *T_c_w);

  const int point_count = static_cast<int>(points.size());
  const bool may_do_without = point_count >= parameters_.pose_min_points;
  report->points = static_cast<int>(track_of.size());
  report->inliers = report->texts = 0;
  if (!may_do_without && texts.empty()) return false;
  std::vector<float> chi2(points.size());
  const SE3d start = *T_c_w;
  const double clearly = parameters_.text.cull_zncc / parameters_.text.min_zncc;  // lower, as in count_view()
  for (std::size_t seen = texts.size() + 1; texts.size() < seen;) {
    seen = texts.size();
    *T_c_w = start;
    if (!refine(frame, points, texts, chi2, T_c_w, report)) return false;
    for (SeenText& text : texts) text.least = least_zncc(frame, *text.text, *T_c_w);
    report->texts = static_cast<int>(
        std::count_if(texts.begin(), texts.end(), [](const SeenText& text) { return text.zncc >= text.least; }));
    if (may_do_without) erase_if(texts, [&](const SeenText& text) { return text.zncc < clearly * text.least; });
  }
  int held = 0;
  for (std::size_t k = heard; k < points.size(); ++k) held += is_pose_inlier(parameters_, chi2[k]) ? 1 : 0;
  for (std::size_t k = 0; k < track_of.size(); ++k) {
    Track& track = tracks_[track_of[k]];
    track.inlier = is_pose_inlier(parameters_, k < heard ? chi2[k] : chi2_of(track, map_.view_of(frame), *T_c_w));
    report->inliers += track.inlier ? 1 : 0;
  }
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
                             const std::vector<SeenText>& texts, TrackReport* report) const {
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
  for (const auto& [text, term, zncc, least] : texts) {
    const Vec3 corner =
        textplane::plane_point<double>(text->theta, text->patch.camera.unproject(text->patch.quad.corner[0]));
    depths.push_back((T_c_w * (term.T_w_h * corner)).z());
  }
  const double focal = std::max(map_.camera.pinhole.fx, map_.camera.pinhole.fy), depth = median(std::move(depths));
  report->position_sigma = position_sigma(report->information) / depth + (all > 0 ? guessed / all / focal : 0);
}

}  // namespace textslam
