// The rules by which a text is believed, waits, or is dropped.
#ifndef TEXTPLANE_LANDMARKS_TEXT_LIFE_HPP
#define TEXTPLANE_LANDMARKS_TEXT_LIFE_HPP

#include <algorithm>
#include <cmath>
#include <vector>

#include "textplane/landmarks/text_view.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// May a text begin with this quad in an image: convex, of at least min_area, off the border, and on no more than
/// `overlap` of one of the `known` ones?
TEXTPLANE_DEFERRED
inline bool may_begin(const TextOptions& options, const Quad<double>& quad, int width, int height,
                      const std::vector<Quad<double>>& known) noexcept {
  return is_convex(quad) && std::abs(area(quad)) >= options.min_area &&
         inside_image(quad, width, height, options.border) &&
         std::none_of(known.begin(), known.end(),
                      [&](const Quad<double>& other) { return overlap(quad, other) > options.overlap; });
}

/// Counts a key frame that should show the text where its plane says: as a view with a ZNCC of at least `least`; as a
/// failure where it is clearly lower (cull_zncc beside min_zncc) and is_detected() is false: where the detector sees
/// the text, the image is blurred.
template <class IsDetected>
void count_view(const TextOptions& options, int keyframe, double zncc, double least, TextObject& text,
                IsDetected is_detected) {
  if (zncc >= least) {
    text.views.insert(std::upper_bound(text.views.begin(), text.views.end(), keyframe), keyframe);
    text.failures = 0;
  } else if (zncc * options.min_zncc < least * options.cull_zncc && !is_detected()) {
    ++text.failures;
  }
}

/// Did the detector see it often enough: min_detections, and detected_share of the frames that could have shown it?
TEXTPLANE_DEFERRED
inline bool is_detected(const TextObject& text, const TextOptions& options) noexcept {
  return text.detections >= options.min_detections && text.detections >= options.detected_share * text.shown;
}

/// Ready to be mapped: min_observations key frames show it, and it is_detected().
TEXTPLANE_DEFERRED
inline bool is_proven(const TextObject& text, const TextOptions& options) noexcept {
  return static_cast<int>(text.views.size()) + 1 >= options.min_observations && is_detected(text, options);
}

/// Has it waited too long for its plane, or to be mapped, after `age` key frames?
TEXTPLANE_DEFERRED
inline bool is_overdue(const TextObject& text, const TextOptions& options, int age) noexcept {
  return (text.state == TextState::candidate && age > options.patience) ||
         (text.state == TextState::tentative && age > options.tentative_patience);
}

/// Have max_failures key frames in a row, and more than ever showed it, failed to?
TEXTPLANE_DEFERRED
inline bool is_contradicted(const TextObject& text, const TextOptions& options) noexcept {
  return text.failures >= options.max_failures && text.failures > static_cast<int>(text.views.size());
}

/// Is its normal less certain than refine_max_sigma?
TEXTPLANE_DEFERRED
inline bool is_uncertain(const TextObject& text, const TextOptions& options) noexcept {
  return !(normal_sigma(text) <= detail::radians(options.refine_max_sigma));
}

/// Takes it out of use and frees its memory; its id stays.
TEXTPLANE_DEFERRED
inline void drop(TextObject& text) noexcept {
  text.state = TextState::dropped;
  text.patch = TextPatch();
  std::vector<int>().swap(text.views);
  text.votes.clear();
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_LIFE_HPP
