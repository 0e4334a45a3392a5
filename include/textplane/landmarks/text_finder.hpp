// TextFinder: the plane of a new text, and the key frames that agree with it.
#ifndef TEXTPLANE_LANDMARKS_TEXT_FINDER_HPP
#define TEXTPLANE_LANDMARKS_TEXT_FINDER_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "textplane/landmarks/keyframe_store.hpp"
#include "textplane/landmarks/text_life.hpp"
#include "textplane/landmarks/text_map_input.hpp"
#include "textplane/landmarks/text_plane.hpp"
#include "textplane/landmarks/text_proposal.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// What a text needs until it is mapped, and when it was last refined.
struct TextNotes {
  std::vector<std::pair<int, Vector3<double>>> rays;  ///< Tracks in the quad, and their rays in the host.
  std::vector<Vector3<double>> inside;                ///< Known points in the quad, in the host.
  Vector3<double> guess = Vector3<double>::Zero();    ///< A plane by the depths about it, or zero.
  int age = 0;                                        ///< Key frames since.
  int conflicts = 0;                                  ///< Key frames in a row before which it mostly disagreed.
  int mapped_by = -1;                                 ///< The key frame that made it a mapped text.
  std::size_t refined_views = 0;                      ///< Views at the last refinement.
};

/// Finds planes and views in the key frames of a store.
TEXTPLANE_DEFERRED
class BasicTextFinder {
 public:
  /// Both must outlive it.
  BasicTextFinder(const TextOptions& options, const KeyframeStore& store)
      : options_(options), store_(store), keyframes_(store) {}

  /// The first plane of a text, or a better one, from what key frame `id` adds: by points in the quad, by matches, or
  /// by its pixels alone. True where the image of the key frame with most parallax agrees with it; text.views are then
  /// all that do, and it is at least tentative. False, and the text as it was, otherwise, and where no more views agree
  /// than with the plane that it has.
  bool find(TextObject& text, TextNotes& notes, int id, const TextKeyframe& keyframe,
            const std::vector<TextPoint>& points) {
    const TextKeyframe host = store_.text_keyframe(text.host);
    std::vector<Vector3<Real>> from, to;
    if (id != text.host) learn(host, keyframe, points, text.patch, notes, &from, &to);
    Vector3<Real> theta;
    if (plane_from_inside_points(options_, notes.inside, text.patch, &theta) && confirm(text, theta, id)) return true;
    const Vector3<Real> middle = text.patch.camera.unproject(centroid(text.patch.quad));
    if (id != text.host &&
        plane_from_text_matches(options_, from, to, keyframe.from(host), keyframe.camera.pinhole.fx, middle, &theta) &&
        confirm(text, theta, id))
      return true;
    // By its pixels alone.
    const Vector3<Real> about = notes.guess.norm() > 0 ? notes.guess : frontal_plane(middle, unknown_depth(host));
    const int other = widest(text, about, id);
    if (other < 0) return false;
    const TextKeyframe seen = store_.text_keyframe(other);
    const double depth = 1 / inverse_depth<double>(about, middle);
    double zncc = -1;
    theta = sweep_depths(text.patch, seen, seen.from(host), kSweepNearest * depth, kSweepFarthest * depth, &zncc);
    return zncc > 0 && confirm(text, theta, id);
  }

  /// Does the key frame show the text where its plane says? It becomes a view, or counts as a failure. `min_share` of
  /// the quad must be inside the image.
  void observe(TextObject& text, int id, const TextKeyframe& keyframe, const std::vector<TextDetection>& detections,
               double min_share) {
    const TextKeyframe host = store_.text_keyframe(text.host);
    const SE3d T_k_h = keyframe.from(host);
    Quad<Real> quad;
    if (keyframe.pyramid.levels < 1 ||
        !is_in_view(options_, text, T_k_h, keyframe, options_.seen_area * options_.min_area, min_share, &quad))
      return;
    const int level = text.patch.level_count() > 1 ? 1 : 0;
    const auto cost = compare_text(text, level, keyframe, T_k_h, scale_shift(text, quad), photometric_);
    if (!is_ok(cost.status)) return;
    const double least =
        text_zncc_limit(options_, options_.min_zncc, text.patch, level, text.theta, host, keyframe, T_k_h);
    count_view(options_, id, cost.zncc, least, text, [&] {
      return std::any_of(detections.begin(), detections.end(), [&](const TextDetection& detection) {
        return iou(quad, detection.quad) >= options_.confirm_iou;
      });
    });
  }

 private:
  // The key frame that shows most of another side of the text's surroundings; -1 where none does.
  int widest(const TextObject& text, const Vector3<Real>& theta, int newest) const {
    if (!(theta.norm() > 0)) return -1;
    const TextKeyframe host = store_.text_keyframe(text.host);
    const Vector3<Real> centre =
        host.T_w_c * plane_point(theta, text.patch.camera.unproject(centroid(text.patch.quad)));
    int best = -1;
    double widest = 0;
    const TextObject guess = outline_of(text.patch, theta);
    store_.for_each([&](int id, const TextKeyframe& keyframe) {
      Quad<Real> quad;
      if (id == text.host || id > newest || keyframe.pyramid.levels < 1 ||
          !is_in_view(options_, guess, keyframe.from(host), keyframe, options_.min_area, 1, &quad))
        return;
      const double parallax = detail::degrees_between(centre - host.T_w_c.t, centre - keyframe.T_w_c.t);
      if (parallax <= widest) return;
      widest = parallax;
      best = id;
    });
    return widest >= options_.min_parallax ? best : -1;
  }

  bool confirm(TextObject& text, const Vector3<Real>& theta, int newest) {
    const int other = widest(text, theta, newest);
    TextObject found = text;
    if (other < 0 || !refine_text_plane(options_, keyframes_, {other}, theta, options_.min_zncc, found)) return false;
    found.state = TextState::tentative;
    found.views.clear();
    store_.for_each([&](int id, const TextKeyframe& keyframe) {
      if (id != found.host && id <= newest) observe(found, id, keyframe, {}, 1);
    });
    if (text.has_plane() && found.views.size() <= text.views.size()) return false;
    found.failures = 0;
    text = std::move(found);
    return true;
  }

  // What a later key frame tells of the points in a text's host: depths that were not known then, and matches.
  void learn(const TextKeyframe& host, const TextKeyframe& keyframe, const std::vector<TextPoint>& points,
             const TextPatch& patch, TextNotes& notes, std::vector<Vector3<Real>>* from,
             std::vector<Vector3<Real>>* to) const {
    const SE3d T_h_k = host.from(keyframe), T_h_w = host.T_c_w();
    std::vector<Vector3<Real>> inside;
    std::vector<TextPoint> in_host;
    for (const TextPoint& point : points) {
      const auto at = std::find_if(notes.rays.begin(), notes.rays.end(),
                                   [&](const auto& ray) { return point.id >= 0 && ray.first == point.id; });
      Vector3<Real> ray;
      if (!is_ok(keyframe.camera.unproject(point.px, &ray))) continue;
      if (at != notes.rays.end()) {
        from->push_back(at->second);
        to->push_back(ray);
      }
      if (!point.has_position && !(point.depth > 0)) continue;
      const Vector3<Real> p = point.has_position ? T_h_w * point.p_w : T_h_k * Vector3<Real>(point.depth * ray);
      if (!(p.z() > 0)) continue;
      const Vector2<Real> px = patch.camera.project(p);
      in_host.push_back(TextPoint::with_depth(px, p.z()));
      if (at != notes.rays.end() || (point.id < 0 && contains(patch.quad, px))) inside.push_back(p);
    }
    if (inside.size() > notes.inside.size()) notes.inside = std::move(inside);
    if (notes.guess.norm() > 0) return;
    const double depth = depth_about(in_host, SE3d{}, patch.quad, options_.min_corners);
    if (depth > 0) notes.guess = frontal_plane(patch.camera.unproject(centroid(patch.quad)), depth);
  }

  // Where nothing is known of depths: where the newest key frames have some parallax.
  double unknown_depth(const TextKeyframe& host) const {
    double baseline = 0;
    store_.for_each([&](int, const TextKeyframe& keyframe) {
      if (keyframe.pyramid.levels > 0) baseline = (std::max)(baseline, (keyframe.T_w_c.t - host.T_w_c.t).norm());
    });
    return baseline > 0 ? kUnknownBaselines * baseline : 1;
  }

  static constexpr double kSweepNearest = 0.4, kSweepFarthest = 2.5, kUnknownBaselines = 12;

  const TextOptions& options_;
  const KeyframeStore& store_;
  const KeyframeLookup keyframes_;
  PhotometricWorkspace photometric_;
};
using TextFinder = BasicTextFinder<>;  ///< It is compiled only where it is used.

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_FINDER_HPP
