#include "textslam/init/motion_hypotheses.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/geometry/triangulate.hpp"
#include "textplane/solver/pose.hpp"
#include "textplane/solver/window.hpp"

namespace textslam {
namespace {

constexpr double kHopeless = 1e9;  // px: of a hypothesis whose views cannot be adjusted

// Where a corner lies in the reference's frame; not ok where its rays do not meet in front.
struct Corner {
  Vec3 p_a = Vec3::Zero();
  bool ok = false;
};

std::vector<Corner> triangulate(const std::vector<Track>& tracks, const CameraView& camera,
                                const std::vector<SE3d>& T_c_a) {
  std::vector<Corner> points(tracks.size());
  std::vector<Vec3> rays(T_c_a.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (std::size_t v = 0; v < T_c_a.size(); ++v) rays[v] = ray_of(camera, tracks[i].observations[v].px);
    points[i].ok = textplane::is_ok(
        textplane::triangulate_views(T_c_a.data(), rays.data(), static_cast<int>(rays.size()), &points[i].p_a));
  }
  return points;
}

bool same_motion(const SE3d& x, const SE3d& y, const Parameters& parameters) {
  return textplane::so3_log<double>(x.R * y.R.transpose()).norm() < parameters.init_same_rotation &&
         x.t.normalized().dot(y.t.normalized()) > std::cos(parameters.init_same_direction);
}

// The reference's frame is fixed, the first; the distance to the second holds the scale.
textplane::Window window_of(const std::vector<Track>& tracks, const CameraView& camera, const std::vector<SE3d>& T_c_a,
                            const std::vector<Corner>& points, double sigma) {
  textplane::Window window;
  window.camera = camera;
  for (const SE3d& T : T_c_a) window.frames.push_back({T.inverse(), window.frames.empty(), {}});
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!points[i].ok) continue;
    const int point = static_cast<int>(window.points.size());
    for (std::size_t v = 0; v < T_c_a.size(); ++v)
      window.point_observations.push_back({static_cast<int>(v), point, tracks[i].observations[v].px, sigma});
    window.points.push_back({points[i].p_a});
  }
  return window;
}

}  // namespace

double clear_ratio(double degrees_of_freedom, double sigmas) {
  return degrees_of_freedom > 0 ? 1 + sigmas * 2 / std::sqrt(degrees_of_freedom) : 1e9;
}

void MotionHypotheses::begin(const std::vector<SE3d>& T_b_a) {
  hypotheses_.clear();
  for (const SE3d& T : T_b_a) hypotheses_.push_back({{SE3d{}, T}, 0, {}});
}

void MotionHypotheses::judge(const std::vector<Track>& tracks, const CameraView& camera, bool replaced) {
  for (Hypothesis& hypothesis : hypotheses_) {
    if (replaced && hypothesis.T_c_a.size() > 2) hypothesis.T_c_a.pop_back();
    add_view(tracks, camera, hypothesis);
    adjust(tracks, camera, hypothesis);
  }
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(),
                   [](const Hypothesis& x, const Hypothesis& y) { return x.rms < y.rms; });
  const double views = static_cast<double>(hypotheses_.front().T_c_a.size()),
               corners = static_cast<double>(tracks.size());
  const double limit = clear_ratio(2 * views * corners - 3 * corners - 6 * views + 7, parameters_.init_clear);
  std::size_t kept = 1;
  for (std::size_t i = 1; i < hypotheses_.size(); ++i) {
    const double ratio = hypotheses_[i].rms / hypotheses_.front().rms;
    if (ratio * ratio > limit) break;
    const bool known = std::any_of(
        hypotheses_.begin(), hypotheses_.begin() + static_cast<std::ptrdiff_t>(kept),
        [&](const Hypothesis& better) { return same_motion(better.T_c_a[1], hypotheses_[i].T_c_a[1], parameters_); });
    if (known) continue;
    if (kept != i) hypotheses_[kept] = std::move(hypotheses_[i]);
    ++kept;
  }
  hypotheses_.resize(kept);
}

// The newest view's pose, by the points of the views before.
void MotionHypotheses::add_view(const std::vector<Track>& tracks, const CameraView& camera,
                                Hypothesis& hypothesis) const {
  const std::vector<Corner> points = triangulate(tracks, camera, hypothesis.T_c_a);
  std::vector<textplane::PosePointTerm> terms;
  for (std::size_t i = 0; i < tracks.size(); ++i)
    if (points[i].ok) terms.push_back({points[i].p_a, tracks[i].observations.back().px, parameters_.point_sigma});
  const int count = static_cast<int>(terms.size());
  SE3d pose = hypothesis.T_c_a.back();
  textplane::PoseWorkspace workspace;
  workspace.reserve(nullptr, 0, count);
  const auto fit = textplane::refine_pose(nullptr, 0, terms.data(), count, textplane::PyramidView(), camera, pose,
                                          textplane::PoseOptions{}, workspace, nullptr, nullptr);
  if (textplane::is_ok(fit.status)) pose = textplane::renormalised(fit.T_t_w);
  hypothesis.T_c_a.push_back(pose);
}

void MotionHypotheses::adjust(const std::vector<Track>& tracks, const CameraView& camera,
                              Hypothesis& hypothesis) const {
  const std::vector<Corner> points = triangulate(tracks, camera, hypothesis.T_c_a);
  textplane::Window window = window_of(tracks, camera, hypothesis.T_c_a, points, parameters_.window_point_sigma);
  textplane::WindowOptions options;
  options.max_iterations = parameters_.init_view_iterations;
  options.scale_frame_a = 0;
  options.scale_frame_b = 1;
  options.covariance = false;
  const textplane::Status solved = textplane::solve_window(window, options).status;
  hypothesis.inlier.assign(tracks.size(), 0);
  if (!textplane::is_ok(solved) && solved != textplane::Status::diverged) {
    hypothesis.rms = kHopeless;
    return;
  }
  for (std::size_t v = 0; v < hypothesis.T_c_a.size(); ++v)
    hypothesis.T_c_a[v] = textplane::renormalised(window.frames[v].T_w_c.inverse());

  // A corner without a point counts as one that is as far off as max_reprojection in every view.
  const int views = static_cast<int>(window.frames.size());
  const double most = parameters_.max_reprojection * parameters_.max_reprojection;
  const double variance = parameters_.window_point_sigma * parameters_.window_point_sigma;
  double sum = 0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!points[i].ok) {
      sum += most * views;
      continue;
    }
    hypothesis.inlier[i] = 1;
    for (int v = 0; v < views; ++v) {
      const double squared = variance * window.point_observations[next++].chi2;
      if (squared > most) hypothesis.inlier[i] = 0;
      sum += std::min(squared, most);
    }
  }
  hypothesis.rms = std::sqrt(sum / (static_cast<double>(tracks.size()) * views));
}

}  // namespace textslam
