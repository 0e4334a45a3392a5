// Merging of texts: a sign that came to be mapped twice becomes one object.
//
// That happens after drift, and where its detections fell on different parts.
#ifndef TEXTPLANE_LANDMARKS_TEXT_MERGE_HPP
#define TEXTPLANE_LANDMARKS_TEXT_MERGE_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "textplane/landmarks/text_life.hpp"
#include "textplane/landmarks/text_plane.hpp"
#include "textplane/landmarks/words.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {

// b's plane beside a's, in a's host.
TEXTPLANE_DEFERRED
inline bool planes_agree(const TextOptions& options, const SE3d& T_a_b, const TextObject& a,
                         const TextObject& b) noexcept {
  Vector3<Real> theta = b.theta;
  Matrix3<Real> covariance = b.covariance;
  if (!transport_plane(T_a_b, &theta, &covariance)) return false;
  const Vector3<Real> normal_a = plane_normal(a.theta), normal_b = plane_normal(theta);
  const double angle = std::atan2(normal_a.cross(normal_b).norm(), normal_a.dot(normal_b));
  const double angle_sigma = std::hypot(normal_sigma(a), normal_sigma(theta, covariance));
  if (!(angle <= radians(options.merge_angle) + options.merge_sigmas * angle_sigma)) return false;

  const Vector3<Real> m = a.patch.camera.unproject(centroid(a.patch.quad));
  const double rho_a = inverse_depth<double>(a.theta, m), rho_b = inverse_depth<double>(theta, m);
  const double rho_sigma = std::sqrt((std::max)(0.0, m.dot((a.covariance + covariance) * m)));
  return std::abs(rho_a - rho_b) <= options.merge_depth * std::abs(rho_a) + options.merge_sigmas * rho_sigma;
}

TEXTPLANE_DEFERRED
inline bool overlaps_in_host(const TextOptions& options, const SE3d& T_a_b, const TextObject& a,
                             const TextObject& b) noexcept {
  Quad<Real> quad;
  return facing(b, T_a_b) > 0 && project_text(b, T_a_b, a.patch.camera, &quad) &&
         iou(a.patch.quad, quad) >= options.merge_overlap;
}

}  // namespace detail

/// What `other` saw counts for `kept`; its key-frame ids are `first_keyframe` higher in kept's map.
TEXTPLANE_DEFERRED
inline void add_observations_of(const TextObject& other, int first_keyframe, const TextOptions& options,
                                TextObject& kept) {
  kept.views.push_back(first_keyframe + other.host);
  for (const int id : other.views) kept.views.push_back(first_keyframe + id);
  for (const auto& [word, count] : other.votes) vote(&kept.votes, word, count, options);
  kept.detections += other.detections;
  kept.shown += other.shown;
}

/// Do two texts with planes stand for one sign? Words, planes (angle and inverse depth at the centres, within a
/// tolerance beside merge_sigmas standard deviations) and quads, in the host of either, must agree.
TEXTPLANE_DEFERRED
inline bool same_text(const TextOptions& options, const KeyframeLookup& keyframes, const TextObject& a,
                      const TextObject& b) {
  const TextKeyframe host_a = keyframes(a.host), host_b = keyframes(b.host);
  const SE3d T_a_b = host_a.from(host_b), T_b_a = host_b.from(host_a);
  return detail::overlaps_in_host(options, T_a_b, a, b) && detail::overlaps_in_host(options, T_b_a, b, a) &&
         words_agree(consensus(a.votes), consensus(b.votes), options) && detail::planes_agree(options, T_a_b, a, b) &&
         detail::planes_agree(options, T_b_a, b, a);
}

/// Merges two texts into the one with more views, `a` among equals. Its plane stays; the other text is dropped.
TEXTPLANE_DEFERRED
inline void merge_texts(const TextOptions& options, TextObject& a, TextObject& b) {
  TextObject &to = b.views.size() > a.views.size() ? b : a, &from = &to == &a ? b : a;
  add_observations_of(from, 0, options, to);
  std::sort(to.views.begin(), to.views.end());
  to.views.erase(std::unique(to.views.begin(), to.views.end()), to.views.end());
  to.views.erase(std::remove(to.views.begin(), to.views.end(), to.host), to.views.end());
  to.failures = 0;
  drop(from);
}

/// Merges the mapped texts that are the same, and returns how many are gone. A pair is compared where was_seen(text)
/// holds for one of the two: the time is the number of texts seen times that of all.
template <class Predicate>
int merge_duplicate_texts(const TextOptions& options, const KeyframeLookup& keyframes, std::vector<TextObject>& texts,
                          Predicate was_seen) {
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (texts[i].state == TextState::mapped && was_seen(texts[i])) seen.push_back(i);
  int merged = 0;
  for (const std::size_t i : seen)
    for (std::size_t j = 0; j < texts.size(); ++j) {
      if (j <= i && (j == i || std::binary_search(seen.begin(), seen.end(), j))) continue;  // that pair had its turn
      TextObject &a = texts[(std::min)(i, j)], &b = texts[(std::max)(i, j)];
      if (a.state != TextState::mapped || b.state != TextState::mapped || !same_text(options, keyframes, a, b))
        continue;
      merge_texts(options, a, b);
      ++merged;
    }
  return merged;
}

/// The same of all pairs.
TEXTPLANE_DEFERRED
int merge_duplicate_texts(const TextOptions& options, const KeyframeLookup& keyframes, std::vector<TextObject>& texts) {
  return merge_duplicate_texts(options, keyframes, texts, [](const TextObject&) { return true; });
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_MERGE_HPP
