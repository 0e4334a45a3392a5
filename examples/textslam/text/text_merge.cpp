#include "textslam/text/text_merge.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/quad.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/culling.hpp"
#include "textslam/map/text_geometry.hpp"
#include "textslam/map/text_words.hpp"

namespace textslam {
namespace {

// b's plane beside a's, in a's host.
bool planes_agree(const Map& map, const Parameters& parameters, const TextObject& a, const TextObject& b) {
  const SE3d T_a_b = map.T_c_h(map.keyframe(a.host).T_w_c.inverse(), b.host);
  TextObject moved;
  Eigen::Matrix3d J;
  if (!textplane::is_ok(textplane::reanchor_plane<double>(b.theta, T_a_b, &moved.theta, &J))) return false;
  moved.covariance = J * b.covariance * J.transpose();

  const Vec3 normal_a = textplane::plane_normal(a.theta), normal_b = textplane::plane_normal(moved.theta);
  const double angle = std::atan2(normal_a.cross(normal_b).norm(), normal_a.dot(normal_b));
  const double angle_sigma = std::hypot(normal_sigma(a), normal_sigma(moved));
  if (!(angle <= radians(parameters.merge_angle) + parameters.merge_sigmas * angle_sigma)) return false;

  const Vec3 m = map.camera.unproject(textplane::centroid(a.patch.quad));
  const double rho_a = textplane::inverse_depth(a.theta, m), rho_b = textplane::inverse_depth(moved.theta, m);
  const double rho_sigma = std::sqrt(std::max(0.0, m.dot((a.covariance + moved.covariance) * m)));
  return std::abs(rho_a - rho_b) <= parameters.merge_depth * std::abs(rho_a) + parameters.merge_sigmas * rho_sigma;
}

bool overlaps_in_host(const Map& map, const Parameters& parameters, const TextObject& a, const TextObject& b) {
  const SE3d T_a_w = map.keyframe(a.host).T_w_c.inverse();
  Quad<double> quad;
  return facing(map, b, T_a_w) > 0 && project_text(map, b, T_a_w, &quad) &&
         textplane::iou(a.patch.quad, quad) >= parameters.merge_overlap;
}

}  // namespace

void add_observations_of(const TextObject& other, int first_keyframe, const Parameters& parameters, TextObject& kept) {
  kept.views.push_back(first_keyframe + other.host);
  for (const int id : other.views) kept.views.push_back(first_keyframe + id);
  for (const auto& [word, count] : other.votes) vote(&kept.votes, word, count, parameters);
  kept.detections += other.detections;
  kept.shown += other.shown;
}

bool same_text(const Map& map, const Parameters& parameters, const TextObject& a, const TextObject& b) {
  return words_agree(a.word(), b.word(), parameters) && overlaps_in_host(map, parameters, a, b) &&
         overlaps_in_host(map, parameters, b, a) && planes_agree(map, parameters, a, b) &&
         planes_agree(map, parameters, b, a);
}

void merge_texts(Map& map, const Parameters& parameters, int a, int b) {
  if (map.text(b).views.size() > map.text(a).views.size()) std::swap(a, b);
  TextObject &to = map.text(a), &from = map.text(b);
  add_observations_of(from, 0, parameters, to);
  std::sort(to.views.begin(), to.views.end());
  to.views.erase(std::unique(to.views.begin(), to.views.end()), to.views.end());
  erase(to.views, to.host);
  to.failures = 0;
  drop(from);
}

int merge_duplicate_texts(Map& map, const Parameters& parameters) {
  int merged = 0;
  for (std::size_t i = 0; i < map.texts.size(); ++i)
    for (std::size_t j = i + 1; j < map.texts.size(); ++j) {
      const TextObject &a = map.texts[i], &b = map.texts[j];
      if (a.state != TextState::mapped || b.state != TextState::mapped || !same_text(map, parameters, a, b)) continue;
      merge_texts(map, parameters, a.id, b.id);
      ++merged;
    }
  return merged;
}

}  // namespace textslam
