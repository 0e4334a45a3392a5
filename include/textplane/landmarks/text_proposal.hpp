// The first plane of a new text: by points in its quad, by matches, or by its pixels alone.
#ifndef TEXTPLANE_LANDMARKS_TEXT_PROPOSAL_HPP
#define TEXTPLANE_LANDMARKS_TEXT_PROPOSAL_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "textplane/landmarks/text_map_input.hpp"
#include "textplane/landmarks/text_plane.hpp"
#include "textplane/landmarks/text_surface.hpp"
#include "textplane/photometry/text_batch.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A plane across the ray of `centre` (m~), at a depth.
TEXTPLANE_DEFERRED
inline Vector3<double> frontal_plane(const Vector3<double>& centre, double depth) noexcept {
  const double divisor = depth * centre.squaredNorm();
  return {centre[0] / divisor, centre[1] / divisor, centre[2] / divisor};
}

/// Depth of a point in a camera's frame; 0 where it is not known or not in front.
TEXTPLANE_DEFERRED
inline double depth_of(const TextPoint& point, const SE3d& T_c_w) noexcept {
  const double depth = point.has_position ? (T_c_w * point.p_w).z() : point.depth;
  return depth > 0 && is_finite(depth) ? depth : 0;
}

/// Median depth of the points within a quad's longer side of its centre, of all points where those are fewer than
/// `least`; 0 where these are, too.
TEXTPLANE_DEFERRED
double depth_about(const std::vector<TextPoint>& points, const SE3d& T_c_w, const Quad<double>& quad, int least) {
  const std::array<Vector2<Real>, 4>& c = quad.corner;
  const double reach = (std::max)((c[1] - c[0]).norm(), (c[3] - c[0]).norm());
  const Vector2<Real> middle = centroid(quad);
  std::vector<double> close, all;
  for (const TextPoint& point : points) {
    const double depth = depth_of(point, T_c_w);
    if (!(depth > 0)) continue;
    all.push_back(depth);
    if ((point.px - middle).norm() <= reach) close.push_back(depth);
  }
  std::vector<double>& used = static_cast<int>(close.size()) < least ? all : close;
  return static_cast<int>(used.size()) < least ? 0 : median(used);
}

/// The plane of points in a quad, robustly: from a guess across the ray at their median depth, with the scatter of the
/// points about the plane as their sigma. `inside`: in the host's frame. False with fewer than min_corners, or where
/// the plane is implausible.
TEXTPLANE_DEFERRED
bool plane_from_inside_points(const TextOptions& options, const std::vector<Vector3<double>>& inside,
                              const TextPatch& patch, Vector3<double>* theta) {
  if (inside.empty() || static_cast<int>(inside.size()) < options.min_corners) return false;
  std::vector<double> depths;
  for (const Vector3<Real>& p : inside) depths.push_back(p.z());
  const double depth = median(depths);
  const Vector3<Real> ray = patch.camera.unproject(centroid(patch.quad)), centre = depth * ray;
  const Vector3<Real> guess = frontal_plane(ray, depth);
  if (!(guess.norm() > 0)) return false;  // too far for a number
  const Matrix3<Real> doubt = detail::guessed(guess, centre, options.surface_guess_turn, options.surface_guess_depth);
  std::vector<SurfacePoint> points;
  for (const Vector3<Real>& p : inside) points.push_back({p, 0.02 * depth, 0});
  TextOptions fit = options;
  fit.surface_min_points = 0.5 * options.min_corners;
  std::vector<double> off(inside.size());
  *theta = guess;
  for (int round = 0; round < options.plane_rounds; ++round) {
    *theta = guess;
    Matrix3<Real> covariance = doubt;
    if (!fit_to_surface(points, centre, fit, theta, &covariance)) return false;
    for (std::size_t i = 0; i < inside.size(); ++i) off[i] = std::abs(1 - theta->dot(inside[i])) / theta->norm();
    const double sigma = std::clamp(1.4826 * median_in_place(off), 1e-4 * depth, 0.05 * depth);
    for (SurfacePoint& point : points) point.sigma = sigma;
  }
  return is_plausible_plane(options, patch.camera, patch.quad, *theta);
}

/// The plane across the ray to the text whose image in `target` is most like the text, of inverse depths between
/// 1 / `farthest` and 1 / `nearest`; by one batch on a coarse level. `zncc` receives its likeness, -1 where none can be
/// compared.
TEXTPLANE_DEFERRED
Vector3<double> sweep_depths(const TextPatch& patch, const TextImage& target, const SE3d& T_t_h, double nearest,
                             double farthest, double* zncc) {
  constexpr int kDepths = 64;
  *zncc = -1;
  const int level = (std::min)({1, patch.level_count() - 1, target.pyramid.levels - 1});
  const Vector3<Real> ray = patch.camera.unproject(centroid(patch.quad));
  Vector3<Real> best = frontal_plane(ray, nearest);
  if (level < 0) return best;
  std::vector<TextBatchItem> items;
  for (int i = 0; i < kDepths; ++i) {
    const double share = (i + 0.5) / kDepths, rho = (1 - share) / nearest + share / farthest;
    items.push_back({patch.levels[static_cast<std::size_t>(level)].view(), patch.camera.at_level(level),
                     frontal_plane(ray, 1 / rho), patch.rows});
  }
  const std::vector<SE3d> poses(items.size(), T_t_h);
  const TextBatch batch(items.data(), kDepths);
  TextBatchResult result(batch);
  if (!is_ok(evaluate_batch(batch, target.pyramid.level[static_cast<std::size_t>(level)], target.camera.at_level(level),
                            poses.data(), PhotometricOptions{}, result, level)))
    return best;
  for (int i = 0; i < kDepths; ++i) {
    if (!is_ok(result.status(i)) || !(result.zncc(i) > *zncc)) continue;
    *zncc = result.zncc(i);
    best = items[static_cast<std::size_t>(i)].theta;
  }
  return best;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_PROPOSAL_HPP
