// TextMapping: what key frames make of the texts: proposal, planes, observations, better hosts, merging, dropping.
#ifndef TEXTPLANE_LANDMARKS_TEXT_MAPPING_HPP
#define TEXTPLANE_LANDMARKS_TEXT_MAPPING_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "textplane/landmarks/keyframe_store.hpp"
#include "textplane/landmarks/text_finder.hpp"
#include "textplane/landmarks/text_hosting.hpp"
#include "textplane/landmarks/text_map_input.hpp"
#include "textplane/landmarks/text_merge.hpp"
#include "textplane/landmarks/text_refiner.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// How often a text disagreed with all the rest in the frames since the last key frame.
struct TextConflict {
  int id = -1;      ///< Of the text.
  int balance = 0;  ///< Frames in which it disagreed, less those in which it took part.
};

/// The objects of a TextMap, and their life from key frame to key frame.
TEXTPLANE_DEFERRED
class BasicTextMapping {
 public:
  /// Both must outlive it.
  BasicTextMapping(const TextOptions& options, const KeyframeStore& store)
      : options_(options),
        store_(store),
        keyframes_(store),
        refiner_(options_, keyframes_),
        finder_(options_, store_) {}

  const std::vector<TextObject>& objects() const noexcept { return objects_; }  ///< None is dropped. By their ids.

  /// Before a key frame: what the frames since the last one say of the texts. One that disagreed with all the rest in
  /// most of the frames that it was compared in, through max_failures key frames in a row, is dropped.
  void judge(const std::vector<TextConflict>& conflicts) {
    for (const TextConflict& conflict : conflicts) {
      const int index = index_of(conflict.id);
      if (index < 0) continue;
      int& count = notes_[static_cast<std::size_t>(index)].conflicts;
      count = conflict.balance > 0 ? count + 1 : 0;
      if (count >= options_.max_failures) drop(objects_[static_cast<std::size_t>(index)]);
    }
    erase_dropped();
  }

  /// After key frame `id` was added to the store.
  void update(int id, const std::vector<TextDetection>& detections, const std::vector<TextPoint>& points);

  /// Before a key frame leaves the store: texts no longer count it, and those that it hosts get another host or are
  /// dropped.
  void keyframe_left(int id);

  /// A plane from elsewhere: see TextMap::set_plane(). The text's index in objects(), or -1 where it was refused.
  int set_plane(int id, const Vector3<double>& theta) {
    const int index = index_of(id);
    if (index < 0 || !all_finite(theta)) return -1;
    TextObject& text = objects_[static_cast<std::size_t>(index)];
    if (!text.has_plane() || !is_plausible_plane(options_, text.patch.camera, text.patch.quad, theta)) return -1;
    text.theta = theta;
    return index;
  }

  /// A text of an earlier map. Its host is in the store. False, and nothing changed, where it has no plane or pixels,
  /// numbers that are not finite, or an id that is not higher than all before.
  bool restore(TextObject text) {
    if (!text.has_plane() || text.id < next_id_ || text.patch.level_count() < 1 || !is_ok(text.patch.status) ||
        !text.patch.camera.valid() || !all_finite(text.patch.quad) || !all_finite(text.theta) ||
        !all_finite(text.covariance) || !(text.variance_factor > 0) || !is_finite(text.variance_factor))
      return false;
    TextNotes notes;
    if (text.state == TextState::mapped) notes.refined_views = text.views.size();
    next_id_ = text.id + 1;
    objects_.push_back(std::move(text));
    notes_.push_back(std::move(notes));
    return true;
  }

  /// Whether a text needs the pose of this key frame.
  bool needs(int id) const {
    return std::any_of(objects_.begin(), objects_.end(), [id](const TextObject& text) { return text.host == id; });
  }

 private:
  // Place in objects_, or -1.
  int index_of(int id) const {
    const auto text = std::lower_bound(objects_.begin(), objects_.end(), id,
                                       [](const TextObject& other, int wanted) { return other.id < wanted; });
    return text != objects_.end() && text->id == id ? static_cast<int>(text - objects_.begin()) : -1;
  }

  // The largest whole view becomes the host. False where there is none with an image.
  bool find_host(TextObject& text) {
    if (text.state != TextState::mapped) return false;
    const TextKeyframe host = store_.text_keyframe(text.host);
    double largest = 0;
    TextObject best;
    for (const int id : with_images(text.views)) {
      const TextKeyframe keyframe = store_.text_keyframe(id);
      TextObject moved = text;
      Quad<double> quad;
      const SE3d T_k_h = keyframe.from(host);
      if (!is_in_view(options_, text, T_k_h, keyframe, options_.min_area, 1, &quad) || area(quad) <= largest) continue;
      moved.host = id;
      moved.patch = make_text_patch(options_, keyframe, quad);
      moved.views.erase(std::remove(moved.views.begin(), moved.views.end(), id), moved.views.end());
      if (!is_ok(moved.patch.status) || !transport_plane(T_k_h, &moved.theta, &moved.covariance)) continue;
      largest = area(quad);
      best = std::move(moved);
    }
    if (largest > 0) text = std::move(best);
    return largest > 0;
  }

  void erase_dropped() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (objects_[i].state == TextState::dropped) continue;
      if (kept != i) {
        objects_[kept] = std::move(objects_[i]);
        notes_[kept] = std::move(notes_[i]);
      }
      ++kept;
    }
    objects_.resize(kept);
    notes_.resize(kept);
  }

  // Where a text is in a key frame: by its plane, or by the guess of it.
  bool locate(const TextObject& text, const TextNotes& notes, const TextKeyframe& keyframe, Quad<double>* quad) const {
    const SE3d T_k_h = keyframe.from(store_.text_keyframe(text.host));
    if (text.has_plane()) return facing(text, T_k_h) > 0 && project_text(text, T_k_h, keyframe.camera, quad);
    if (!(notes.guess.norm() > 0)) return false;
    return project_text(outline_of(text.patch, notes.guess), T_k_h, keyframe.camera, quad);
  }

  // Counts detections for the texts that they fall on. Returns which of them are of known texts, or no quads of use.
  std::vector<char> associate(const TextKeyframe& keyframe, const std::vector<TextDetection>& detections) {
    std::vector<char> taken(detections.size(), 0);
    std::vector<Quad<double>> known;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      TextObject& text = objects_[i];
      Quad<double> quad;
      if (!locate(text, notes_[i], keyframe, &quad)) continue;
      known.push_back(quad);
      bool shown = inside_image(quad, keyframe.width(), keyframe.height(), options_.border) &&
                   std::abs(area(quad)) >= options_.min_area && !detections.empty();
      for (const TextDetection& detection : detections) {
        if (!(iou(quad, detection.quad) >= options_.confirm_iou)) continue;
        ++text.detections;
        shown = true;
        if (is_read(detection.word)) vote(&text.votes, detection.word, detection.score, options_);
        break;
      }
      text.shown += shown ? 1 : 0;
    }
    for (std::size_t d = 0; d < detections.size(); ++d) {
      taken[d] = !may_begin(options_, detections[d].quad, keyframe.width(), keyframe.height(), known);
      if (!taken[d]) known.push_back(detections[d].quad);  // of detections on one another, the first counts
    }
    return taken;
  }

  void propose(int id, const TextKeyframe& keyframe, const TextDetection& detection,
               const std::vector<TextPoint>& points) {
    TextObject text;
    text.patch = make_text_patch(options_, keyframe, detection.quad);
    if (!is_ok(text.patch.status)) return;
    text.id = next_id_++;
    text.host = id;
    text.detections = text.shown = 1;
    if (is_read(detection.word)) vote(&text.votes, detection.word, detection.score, options_);
    TextNotes notes;
    const SE3d T_c_w = keyframe.T_c_w();
    for (const TextPoint& point : points) {
      if (!contains(detection.quad, point.px)) continue;
      const double depth = depth_of(point, T_c_w);
      Vector3<Real> ray;
      if (!is_ok(keyframe.camera.unproject(point.px, &ray))) continue;
      if (depth > 0) notes.inside.push_back(depth * ray);
      if (point.id >= 0) notes.rays.emplace_back(point.id, ray);
    }
    const double depth = depth_about(points, T_c_w, detection.quad, options_.min_corners);
    if (depth > 0) notes.guess = frontal_plane(text.patch.camera.unproject(centroid(text.patch.quad)), depth);
    objects_.push_back(std::move(text));
    notes_.push_back(std::move(notes));
    finder_.find(objects_.back(), notes_.back(), id, keyframe, points);
  }

  void advance(TextObject& text, TextNotes& notes, int id, const TextKeyframe& keyframe,
               const std::vector<TextDetection>& detections, const std::vector<TextPoint>& points) {
    ++notes.age;
    const std::size_t before = text.views.size();
    if (text.has_plane()) finder_.observe(text, id, keyframe, detections, 1);
    if (!text.has_plane() || (text.state == TextState::tentative && text.views.size() == before))
      finder_.find(text, notes, id, keyframe, points);
    if (text.has_plane() && text.views.size() > before) settle(text, notes, id);
    if (is_contradicted(text, options_) || is_overdue(text, options_, notes.age)) drop(text);
  }

  // After new observations: a better plane, a better host, a place in the map.
  void settle(TextObject& text, TextNotes& notes, int id) {
    if (text.state == TextState::tentative) {
      refine_text_plane(options_, keyframes_,
                        evenly_spaced(with_images(text.views), static_cast<std::size_t>(options_.views)), text.theta,
                        options_.cull_zncc, text);
      if (!is_proven(text, options_) || !has_grown(text, notes) || !refined(text, notes)) return;
      text.state = TextState::mapped;
      notes.mapped_by = id;
      notes.refined_views = text.views.size();
      notes.rays.clear();
      notes.inside.clear();
      return;
    }
    if (rehost(options_, keyframes_, id, text)) notes.refined_views = 0;
    if (!has_grown(text, notes)) return;
    notes.refined_views = text.views.size();
    if (!refined(text, notes)) ++text.failures;
  }

  // Has it half as many views again as when it was last looked at?
  static bool has_grown(const TextObject& text, const TextNotes& notes) noexcept {
    return 2 * text.views.size() >= 3 * notes.refined_views;
  }

  // Whether its plane is worth having; how well it is known, its covariance says. What is bent never enters the map,
  // or leaves it; as long as it waits, its place is taken.
  bool refined(TextObject& text, TextNotes& notes) {
    const Refinement result = refiner_.refine(text);
    if (result == Refinement::bent) {
      notes.refined_views = text.views.size();
      if (text.state == TextState::mapped) drop(text);
    }
    return (result == Refinement::refined || result == Refinement::uncertain) &&
           normal_sigma(text) <= detail::radians(kMostSigma);
  }

  std::vector<int> with_images(const std::vector<int>& ids) const {
    std::vector<int> out;
    for (const int id : ids)
      if (store_.has_image(id)) out.push_back(id);
    return out;
  }

  static constexpr double kMostSigma = 45;  // degrees

  const TextOptions& options_;
  const KeyframeStore& store_;
  const KeyframeLookup keyframes_;
  TextRefiner refiner_;
  TextFinder finder_;
  std::vector<TextObject> objects_;
  std::vector<TextNotes> notes_;
  int next_id_ = 0;
};
using TextMapping = BasicTextMapping<>;  ///< It is compiled only where it is used.

template <class Real>
void BasicTextMapping<Real>::update(int id, const std::vector<TextDetection>& detections,
                                    const std::vector<TextPoint>& points) {
  const TextKeyframe keyframe = store_.text_keyframe(id);
  std::vector<char> taken = associate(keyframe, detections);
  for (std::size_t i = 0; i < objects_.size(); ++i) advance(objects_[i], notes_[i], id, keyframe, detections, points);
  for (std::size_t d = 0; d < detections.size(); ++d)
    if (!taken[d]) propose(id, keyframe, detections[d], points);
  merge_duplicate_texts(options_, keyframes_, objects_, [this, id](const TextObject& text) {
    const TextNotes& notes = notes_[static_cast<std::size_t>(&text - objects_.data())];
    return text.host == id || notes.mapped_by == id || (!text.views.empty() && text.views.back() == id);
  });
  erase_dropped();
}

template <class Real>
void BasicTextMapping<Real>::keyframe_left(int id) {
  for (TextObject& text : objects_) {
    if (text.host == id && !find_host(text)) drop(text);
    text.views.erase(std::remove(text.views.begin(), text.views.end(), id), text.views.end());
  }
  erase_dropped();
}

TEXTPLANE_INSTANCE(class BasicTextMapping<double>);

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_MAPPING_HPP
