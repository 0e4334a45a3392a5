#include "textslam/text/loose_planes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/plane_fit.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/landmarks/text_life.hpp"

namespace textslam {
namespace {

using Draw = std::array<std::size_t, 3>;

// All triples where they are few, else `most` by a generator that is the same with every compiler.
std::vector<Draw> draws_of(std::size_t n, std::size_t most) {
  std::vector<Draw> draws;
  if (n * (n - 1) * (n - 2) / 6 <= most) {
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        for (std::size_t k = j + 1; k < n; ++k) draws.push_back({i, j, k});
    return draws;
  }
  std::mt19937 random(1);
  while (draws.size() < most) {
    const Draw draw = {random() % n, random() % n, random() % n};
    if (draw[0] != draw[1] && draw[0] != draw[2] && draw[1] != draw[2]) draws.push_back(draw);
  }
  return draws;
}

double depth_error(const Vec3& theta, const Vec3& m, double rho) {
  return std::abs(textplane::inverse_depth(theta, m) / rho - 1);
}

// The map points in the quad of a text's host, as rays and inverse depths of the host.
struct PointsOfText {
  std::vector<int> ids;
  std::vector<Vec3> m;
  std::vector<double> rho;
};

PointsOfText points_in_quad(const Map& map, const TextObject& text) {
  PointsOfText found;
  const SE3d T_h_w = map.keyframe(text.host).T_w_c.inverse();
  for (std::size_t id = 0; id < map.points.size(); ++id) {
    if (map.points[id].bad) continue;
    const Vec3 p = T_h_w * map.points[id].p_w;
    if (!(p.z() > 0) || !textplane::contains(text.patch.quad, text.patch.camera.project(p))) continue;
    found.ids.push_back(static_cast<int>(id));
    found.m.push_back(p / p.z());
    found.rho.push_back(1 / p.z());
  }
  return found;
}

// Takes the plane of the points; *on_plane are the ids of its inliers, rising. False, and nothing changed, without one.
bool fit_text(const Map& map, const Parameters& parameters, TextObject& text, std::vector<int>* on_plane) {
  const PointsOfText points = points_in_quad(map, text);
  const LoosePlane plane = fit_loose_plane(points.m, points.rho, parameters);
  if (!plane.ok || !is_plausible_plane(parameters.text, text.patch.camera, text.patch.quad, plane.theta)) return false;
  text.theta = plane.theta;
  text.covariance = plane.covariance;
  on_plane->clear();
  for (const int i : plane.inliers) on_plane->push_back(points.ids[static_cast<std::size_t>(i)]);
  return true;
}

bool observes(const Map& map, const Parameters& parameters, const TextObject& text, const std::vector<int>& on_plane,
              int keyframe) {
  Quad<double> quad;
  const textplane::TextKeyframe target = map.text_keyframe(keyframe);
  if (!is_in_view(parameters.text, text, target.from(map.text_keyframe(text.host)), target,
                  parameters.text.seen_area * parameters.text.min_area, 1, &quad))
    return false;
  int seen = 0;
  for (const int point : map.keyframe(keyframe).points)
    seen += std::binary_search(on_plane.begin(), on_plane.end(), point) ? 1 : 0;
  return seen >= parameters.loose_seen_points;
}

}  // namespace

LoosePlane fit_loose_plane(const std::vector<Vec3>& m, const std::vector<double>& rho, const Parameters& parameters) {
  LoosePlane best;
  if (m.size() < 3) return best;
  double least = 0;
  for (const Draw& draw : draws_of(m.size(), static_cast<std::size_t>(parameters.loose_draws))) {
    const Vec3 rays[3] = {m[draw[0]], m[draw[1]], m[draw[2]]};
    const double depths[3] = {rho[draw[0]], rho[draw[1]], rho[draw[2]]};
    const auto plane = textplane::plane_from_inverse_depths(rays, depths, nullptr, 3);
    if (!textplane::is_ok(plane.status)) continue;
    double cost = 0;
    for (std::size_t i = 0; i < m.size(); ++i) {
      const double e = std::min(depth_error(plane.value, m[i], rho[i]), parameters.loose_inlier);
      cost += e * e;
    }
    if (best.theta.isZero() || cost < least) {
      least = cost;
      best.theta = plane.value;
    }
  }
  if (best.theta.isZero()) return best;
  for (int round = 0; round < parameters.loose_rounds; ++round) {
    std::vector<Vec3> rays;
    std::vector<double> depths;
    best.inliers.clear();
    for (std::size_t i = 0; i < m.size(); ++i) {
      if (depth_error(best.theta, m[i], rho[i]) > parameters.loose_inlier) continue;
      best.inliers.push_back(static_cast<int>(i));
      rays.push_back(m[i]);
      depths.push_back(rho[i]);
    }
    const auto plane = textplane::plane_from_inverse_depths(rays, depths);
    if (!textplane::is_ok(plane.status)) return best;
    best.theta = plane.value;
    best.covariance = plane.sigma * plane.sigma * plane.covariance;
  }
  const auto inliers = static_cast<double>(best.inliers.size());
  best.ok =
      inliers >= parameters.loose_min_points && inliers >= parameters.loose_min_share * static_cast<double>(m.size());
  return best;
}

void update_loose_planes(Map& map, const Parameters& parameters, int id) {
  for (TextObject& text : map.texts) {
    if (text.host == id || text.state == TextState::dropped) continue;
    std::vector<int> on_plane;
    if (fit_text(map, parameters, text, &on_plane)) {
      text.failures = 0;
      int first = id;
      if (text.state == TextState::candidate) {
        text.state = TextState::tentative;
        first = text.host + 1;
      }
      for (int keyframe = first; keyframe <= id; ++keyframe)
        if (observes(map, parameters, text, on_plane, keyframe)) text.views.push_back(keyframe);
    } else if (text.has_plane()) {
      ++text.failures;
    }
    if (text.state == TextState::tentative && is_proven(text, parameters.text)) text.state = TextState::mapped;
    // What the points contradict is dropped even if many key frames showed it.
    if (is_overdue(text, parameters.text, id - text.host) || text.failures >= parameters.text.max_failures) drop(text);
  }
}

void refresh_loose_planes(Map& map, const Parameters& parameters) {
  std::vector<int> on_plane;
  for (TextObject& text : map.texts)
    if (text.has_plane()) fit_text(map, parameters, text, &on_plane);
}

}  // namespace textslam
