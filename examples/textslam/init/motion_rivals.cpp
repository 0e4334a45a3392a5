#include "textslam/init/motion_rivals.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/geometry/triangulate.hpp"
#include "textplane/solver/pose.hpp"
#include "textplane/solver/window.hpp"

namespace textslam {
namespace {

constexpr int kIterations = 10;
constexpr double kSameRotation = 0.01;   // radians, and
constexpr double kSameDirection = 0.05;  // of the translation: below both two rivals are one
constexpr double kHopeless = 1e9;        // px: of a rival whose views cannot be adjusted

// Point of a corner in the reference's frame; not ok where its rays do not meet in front.
struct Point {
  Vec3 p_a = Vec3::Zero();
  bool ok = false;
};

std::vector<Point> triangulate(const std::vector<Track>& tracks, const Pinhole<double>& camera,
                               const std::vector<SE3d>& T_c_a) {
  std::vector<Point> points(tracks.size());
  std::vector<Vec3> rays(T_c_a.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (std::size_t v = 0; v < T_c_a.size(); ++v) rays[v] = camera.unproject(tracks[i].observations[v].px);
    points[i].ok = textplane::is_ok(
        textplane::triangulate_views(T_c_a.data(), rays.data(), static_cast<int>(rays.size()), &points[i].p_a));
  }
  return points;
}

bool same_motion(const SE3d& x, const SE3d& y) {
  return textplane::so3_log<double>(x.R * y.R.transpose()).norm() < kSameRotation &&
         x.t.normalized().dot(y.t.normalized()) > std::cos(kSameDirection);
}

}  // namespace

double clear_ratio(double degrees_of_freedom, double sigmas) {
  return degrees_of_freedom > 0 ? 1 + sigmas * 2 / std::sqrt(degrees_of_freedom) : 1e9;
}

void MotionRivals::begin(const std::vector<SE3d>& T_b_a) {
  rivals_.clear();
  for (const SE3d& T : T_b_a) {
    Rival rival;
    rival.T_c_a = {SE3d{}, T};
    rivals_.push_back(std::move(rival));
  }
}

void MotionRivals::judge(const std::vector<Track>& tracks, const Pinhole<double>& camera, bool replaced) {
  for (Rival& rival : rivals_) {
    if (replaced && rival.T_c_a.size() > 2) rival.T_c_a.pop_back();
    add_view(tracks, camera, rival);
    adjust(tracks, camera, rival);
  }
  std::stable_sort(rivals_.begin(), rivals_.end(), [](const Rival& x, const Rival& y) { return x.rms < y.rms; });
  const double views = static_cast<double>(rivals_.front().T_c_a.size()), corners = static_cast<double>(tracks.size());
  const double limit = clear_ratio(2 * views * corners - 3 * corners - 6 * views + 7, parameters_.init_clear);
  std::size_t kept = 1;
  for (std::size_t i = 1; i < rivals_.size(); ++i) {
    const double ratio = rivals_[i].rms / rivals_.front().rms;
    if (ratio * ratio > limit) break;
    const bool known =
        std::any_of(rivals_.begin(), rivals_.begin() + static_cast<std::ptrdiff_t>(kept),
                    [&](const Rival& better) { return same_motion(better.T_c_a[1], rivals_[i].T_c_a[1]); });
    if (known) continue;
    if (kept != i) rivals_[kept] = std::move(rivals_[i]);
    ++kept;
  }
  rivals_.resize(kept);
}

// The newest view's pose, by the points of the views before.
void MotionRivals::add_view(const std::vector<Track>& tracks, const Pinhole<double>& camera, Rival& rival) const {
  const std::vector<Point> points = triangulate(tracks, camera, rival.T_c_a);
  std::vector<textplane::PosePointTerm> terms;
  for (std::size_t i = 0; i < tracks.size(); ++i)
    if (points[i].ok) terms.push_back({points[i].p_a, tracks[i].observations.back().px, parameters_.point_sigma});
  const int count = static_cast<int>(terms.size());
  SE3d pose = rival.T_c_a.back();
  textplane::PoseWorkspace workspace;
  workspace.reserve(nullptr, 0, count);
  const auto fit = textplane::refine_pose(nullptr, 0, terms.data(), count, textplane::PyramidView(), camera, pose,
                                          textplane::PoseOptions{}, workspace, nullptr, nullptr);
  if (textplane::is_ok(fit.status)) pose = textplane::renormalised(fit.T_t_w);
  rival.T_c_a.push_back(pose);
}

void MotionRivals::adjust(const std::vector<Track>& tracks, const Pinhole<double>& camera, Rival& rival) const {
  const std::vector<Point> points = triangulate(tracks, camera, rival.T_c_a);
  textplane::Window window;
  window.camera = camera;
  for (const SE3d& T_c_a : rival.T_c_a) {
    textplane::WindowFrame frame;
    frame.T_w_c = T_c_a.inverse();
    frame.fixed = window.frames.empty();
    window.frames.push_back(frame);
  }
  const int views = static_cast<int>(window.frames.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!points[i].ok) continue;
    for (int v = 0; v < views; ++v) {
      textplane::WindowPointObservation observation;
      observation.frame = v;
      observation.point = static_cast<int>(window.points.size());
      observation.px = tracks[i].observations[static_cast<std::size_t>(v)].px;
      observation.sigma = parameters_.window_point_sigma;
      window.point_observations.push_back(observation);
    }
    textplane::WindowPoint point;
    point.p_w = points[i].p_a;
    window.points.push_back(point);
  }
  textplane::WindowOptions options;
  options.max_iterations = kIterations;
  options.scale_frame_a = 0;
  options.scale_frame_b = 1;
  options.covariance = false;
  const textplane::Status solved = textplane::solve_window(window, options).status;
  if (!textplane::is_ok(solved) && solved != textplane::Status::diverged) {
    rival.inlier.assign(tracks.size(), 0);
    rival.rms = kHopeless;
    return;
  }
  for (std::size_t v = 0; v < rival.T_c_a.size(); ++v)
    rival.T_c_a[v] = textplane::renormalised(window.frames[v].T_w_c.inverse());

  // A corner without a point counts as one that is as far off as max_reprojection in every view.
  const double most = parameters_.max_reprojection * parameters_.max_reprojection;
  const double variance = parameters_.window_point_sigma * parameters_.window_point_sigma;
  rival.inlier.assign(tracks.size(), 0);
  double sum = 0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!points[i].ok) {
      sum += most * views;
      continue;
    }
    rival.inlier[i] = 1;
    for (int v = 0; v < views; ++v) {
      const double squared = variance * window.point_observations[next++].chi2;
      if (squared > most) rival.inlier[i] = 0;
      sum += std::min(squared, most);
    }
  }
  rival.rms = std::sqrt(sum / (static_cast<double>(tracks.size()) * views));
}

}  // namespace textslam
