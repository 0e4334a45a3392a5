#include "textslam/track/tracker.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "textplane/features/klt.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/solver/pose.hpp"
#include "textslam/track/feature_tracks.hpp"
#include "textslam/track/rotation_prior.hpp"

namespace textslam {
namespace {

constexpr double kPriorZncc = 0.4;  // below it two whole images say nothing about each other
constexpr int kTemplateHalf = 5;    // px: half width of a re-observed patch
constexpr double kMaxDrift = 1.5;   // px that a tracked corner may be moved back onto its host's patch

// How a fronto-parallel patch at p_w of the host's view shows in the target: px displacement of the host per px of
// target.
bool affine_to_host(const Pinhole<double>& camera, const SE3d& T_t_h, const Vec2& host_px, double host_depth,
                    Eigen::Matrix2f* A) {
  const Vec3 theta(0, 0, 1 / host_depth);
  const Vec3 m = camera.unproject(host_px);
  const Eigen::Matrix3d H = textplane::plane_homography(theta, T_t_h);
  const Vec3 q = H * m;
  if (!(q.z() > 0)) return false;
  Eigen::Matrix<double, 2, 3> P;
  P << 1 / q.z(), 0, -q.x() / (q.z() * q.z()), 0, 1 / q.z(), -q.y() / (q.z() * q.z());
  Eigen::Matrix2d forward = P * H.leftCols<2>();
  forward.row(0) *= camera.fx;
  forward.row(1) *= camera.fy;
  forward.col(0) /= camera.fx;
  forward.col(1) /= camera.fy;
  const double det = forward(0, 0) * forward(1, 1) - forward(0, 1) * forward(1, 0);
  if (!(std::abs(det) > 0.1) || std::abs(det) > 10) return false;
  Eigen::Matrix2d inverse;
  inverse << forward(1, 1), -forward(0, 1), -forward(1, 0), forward(0, 0);
  *A = (inverse / det).cast<float>();
  return true;
}

Vec2f to_level(const Vec2f& px, int level) {
  const float k = 1.0F / static_cast<float>(1 << level);
  return (px.array() + 0.5F).matrix() * k - Vec2f::Constant(0.5F);
}

Vec2f from_level(const Vec2f& px, int level) {
  const float k = static_cast<float>(1 << level);
  return (px.array() + 0.5F).matrix() * k - Vec2f::Constant(0.5F);
}

// Finds the patch of a host key frame in the frame, on levels `coarsest` to 0, from a start in level-0 px.
bool find_patch(const Frame& host, const Vec2& host_px, const Eigen::Matrix2f& A, const Frame& frame, int coarsest,
                float min_zncc, Vec2f* px) {
  // Where the host shows the patch larger than the frame, its next coarser level is the sharpest that does not alias.
  const int shift = std::sqrt(std::abs(A.determinant())) > 1.4F ? 1 : 0;
  textplane::KltOptions options;
  options.min_zncc = min_zncc;
  textplane::PointPatch patch;
  for (int level = coarsest; level >= 0; --level) {
    const int host_level = std::min(level + shift, host.image->levels() - 1);
    const float scale = std::ldexp(1.0F, level - host_level);
    const auto status = textplane::extract_point_patch(
        host.image->level(host_level), to_level(host_px.cast<float>(), host_level), scale * A, kTemplateHalf, &patch);
    if (!textplane::is_ok(status)) {
      if (level > 0) continue;
      return false;
    }
    options.min_zncc = level > 0 ? 0.5F : min_zncc;
    const auto result = textplane::align_point_patch(patch, frame.image->level(level), to_level(*px, level), options);
    if (textplane::is_ok(result.status)) {
      *px = from_level(result.px, level);
    } else if (level == 0) {
      return false;
    }
  }
  return true;
}

}  // namespace

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::vector<Track> tracks_of_keyframe(const Map& map, int id) {
  std::vector<Track> tracks;
  for (const int point : map.keyframe(id).points)
    for (const PointObservation& o : map.point(point).observations)
      if (o.keyframe == id) {
        Track track;
        track.px = o.px.cast<float>();
        track.point = point;
        tracks.push_back(std::move(track));
      }
  return tracks;
}

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
  const Eigen::Matrix3d last_turn = moving_ ? velocity_.R : Eigen::Matrix3d::Identity();
  const RotationPrior prior = align_rotation(frame_, frame, map_.camera, last_turn);
  const bool aligned = prior.zncc > kPriorZncc;
  const Eigen::Matrix3d turn = aligned ? prior.R_b_a : last_turn;

  // The whole-image turn takes sideways motion for rotation, so it replaces the velocity only where the two are far
  // apart.
  SE3d predicted = (moving_ ? velocity_ : SE3d{}) * T_c_w_;
  if (aligned && textplane::so3_log<double>(turn * last_turn.transpose()).norm() > 3 * M_PI / 180) {
    const Vec3 centre = predicted.inverse().t;
    predicted.R = turn * T_c_w_.R;
    predicted.t = -(predicted.R * centre);
  }

  // Points of the map are expected where the predicted pose sees them, corners without depth where the turn takes them.
  std::vector<Vec2f> guesses;
  for (const Track& track : tracks_) {
    const Vec3 turned = turn * map_.camera.unproject(track.px.cast<double>());
    const Vec3 m = track.point >= 0 && track.inlier ? predicted * map_.point(track.point).p_w : turned;
    guesses.push_back(m.z() > 0.1 ? map_.camera.project(m).cast<float>() : track.px);
  }
  advance_tracks(frame_, frame, guesses, parameters_, tracks_);
  const double t1 = now_ms();

  SE3d pose = predicted;
  Fit fit = fit_pose(frame, false, &pose);
  if (!fit.ok) pose = predicted;
  const double t2 = now_ms();
  reobserve(frame, pose, &report);
  const double t3 = now_ms();
  fit = fit_pose(frame, parameters_.mode == Mode::text, &pose);
  const double t4 = now_ms();
  report.klt_ms = t1 - t0;
  report.reobserve_ms = t3 - t2;
  report.pose_ms = (t2 - t1) + (t4 - t3);
  report.ok = fit.ok;
  report.points = fit.points;
  report.inliers = fit.inliers;
  report.texts = fit.texts;
  if (!fit.ok) pose = predicted;
  report.T_c_w = pose;

  for (const Track& track : tracks_)
    if (track.point >= 0 && track.inlier) report.found.push_back(track.point);
  velocity_ = pose * T_c_w_.inverse();
  moving_ = true;
  T_c_w_ = pose;
  frame_ = frame;
  return report;
}

void Tracker::reobserve(const Frame& frame, const SE3d& T_c_w, TrackReport* report) {
  const Vec3 centre = T_c_w.inverse().t;
  std::vector<int> track_of(map_.points.size(), -1);
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    if (tracks_[i].point >= 0) track_of[static_cast<std::size_t>(tracks_[i].point)] = static_cast<int>(i);

  struct Candidate {
    int point;
    const PointObservation* host;
    Vec2 predicted;
    Eigen::Matrix2f A;
  };
  std::vector<Candidate> lost_sight;
  const double border = kTemplateHalf + 3;
  for (std::size_t id = 0; id < map_.points.size(); ++id) {
    const MapPoint& point = map_.points[id];
    if (!looks_for_point(static_cast<int>(id))) continue;
    const Vec3 p = T_c_w * point.p_w;
    if (!(p.z() > 0)) continue;
    Candidate candidate;
    candidate.point = static_cast<int>(id);
    candidate.predicted = map_.camera.project(p);
    const Vec2& px = candidate.predicted;
    if (!(px.x() >= border && px.y() >= border && px.x() < map_.width - border && px.y() < map_.height - border))
      continue;

    // The key frame that saw the point most nearly from here.
    double best = kMinViewCosine;
    candidate.host = nullptr;
    const Vec3 ray = (point.p_w - centre).normalized();
    for (const PointObservation& o : point.observations) {
      const double cosine = ray.dot((point.p_w - map_.keyframe(o.keyframe).T_w_c.t).normalized());
      if (cosine > best + 1e-3) {
        best = cosine;
        candidate.host = &o;
      }
    }
    if (!candidate.host) continue;
    const KeyFrame& host = map_.keyframe(candidate.host->keyframe);
    const Vec3 in_host = host.T_w_c.inverse() * point.p_w;
    if (!(in_host.z() > 0) ||
        !affine_to_host(map_.camera, T_c_w * host.T_w_c, candidate.host->px, in_host.z(), &candidate.A))
      continue;
    report->visible.push_back(candidate.point);

    const int track = track_of[id];
    if (track < 0) {
      lost_sight.push_back(candidate);
      continue;
    }
    // A tracked corner is pulled back onto its patch, so that errors do not add up from frame to frame.
    Track& t = tracks_[static_cast<std::size_t>(track)];
    Vec2f refined = t.px;
    if (find_patch(host.frame, candidate.host->px, candidate.A, frame, 0, parameters_.min_template_zncc, &refined) &&
        (refined - t.px).norm() < kMaxDrift)
      t.px = refined;
  }

  // An even choice where there are too many.
  const std::size_t limit = static_cast<std::size_t>(parameters_.max_reobserved);
  const std::size_t stride = lost_sight.size() / limit + 1;
  for (std::size_t i = static_cast<std::size_t>(frame.index) % stride; i < lost_sight.size(); i += stride) {
    const Candidate& candidate = lost_sight[i];
    Vec2f px = candidate.predicted.cast<float>();
    if (!find_patch(map_.keyframe(candidate.host->keyframe).frame, candidate.host->px, candidate.A, frame, 2,
                    parameters_.min_template_zncc, &px))
      continue;
    if ((px.cast<double>() - candidate.predicted).norm() > parameters_.relocation_search) continue;
    // A corner tracked at the same place is the same thing; the older point stands for it from here on.
    bool taken = false;
    for (Track& track : tracks_) {
      if ((track.px - px).squaredNorm() > 2.25F) continue;
      taken = true;
      if (track.point < 0 || track.point > candidate.point) {
        track.point = candidate.point;
        track.observations.clear();
        track.px = px;
      }
      break;
    }
    if (taken) continue;
    Track track;
    track.px = px;
    track.point = candidate.point;
    tracks_.push_back(std::move(track));
  }
}

Tracker::Fit Tracker::fit_pose(const Frame& frame, bool with_text, SE3d* T_c_w) {
  std::vector<textplane::PosePointTerm> points;
  std::vector<std::size_t> track_of;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (tracks_[i].point < 0 || !looks_for_point(tracks_[i].point)) continue;
    points.push_back({map_.point(tracks_[i].point).p_w, tracks_[i].px.cast<double>(), parameters_.point_sigma});
    track_of.push_back(i);
  }
  std::vector<textplane::PoseTextTerm> texts;
  if (with_text)
    for (const TextObject& text : map_.texts) {
      Quad<double> quad;
      if (text.state != TextState::mapped || (local_ && !local_->has_text(text.id))) continue;
      if (!text_in_view(map_, parameters_, text, *T_c_w, &quad)) continue;
      texts.push_back({&text.patch, text.theta, map_.keyframe(text.host).T_w_c, 1, scale_shift(text, quad)});
    }

  Fit fit;
  fit.points = static_cast<int>(points.size());
  if (points.size() < 4 && texts.empty()) return fit;
  const int text_count = static_cast<int>(texts.size()), point_count = static_cast<int>(points.size());
  textplane::PoseWorkspace workspace;
  workspace.reserve(texts.data(), text_count, point_count);
  textplane::PoseOptions options;
  options.sigma_photo = parameters_.photometric_sigma;
  options.coarsest_level = parameters_.text_levels - 1;
  std::vector<float> zncc(texts.size()), chi2(points.size());
  const auto result = textplane::refine_pose(texts.data(), text_count, points.data(), point_count, frame.image->view(),
                                             map_.camera, *T_c_w, options, workspace, zncc.data(), chi2.data());
  if (!textplane::is_ok(result.status) && result.status != textplane::Status::diverged) return fit;
  *T_c_w = textplane::renormalised(result.T_t_w);
  for (std::size_t k = 0; k < points.size(); ++k) {
    Track& track = tracks_[track_of[k]];
    track.inlier = chi2[k] >= 0 && chi2[k] <= 2 * parameters_.outlier_chi2;
    fit.inliers += track.inlier ? 1 : 0;
  }
  for (const float z : zncc) fit.texts += z >= parameters_.text_min_zncc ? 1 : 0;
  const bool enough_points =
      fit.inliers >= parameters_.min_inliers && fit.inliers >= parameters_.min_inlier_share * fit.points;
  const bool enough_text = fit.texts >= 2 || (fit.texts == 1 && fit.inliers >= parameters_.min_inliers / 2);
  fit.ok = enough_points || enough_text;
  return fit;
}

}  // namespace textslam
