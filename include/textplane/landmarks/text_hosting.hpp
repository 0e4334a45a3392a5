// A better host for a mapped text: a new key frame that shows it whole, much larger than its host does, and as sharp.
//
// A sign is first detected from afar, often aslant, so its first host is its poorest view. The plane and its covariance
// move to the better view and are refined there; the plane gives the quad in the new image; the old host becomes a
// view. Each change needs a view that is larger by a pyramid level, so changes are few.
#ifndef TEXTPLANE_LANDMARKS_TEXT_HOSTING_HPP
#define TEXTPLANE_LANDMARKS_TEXT_HOSTING_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "textplane/landmarks/text_plane.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {

// Its whole quad in a key frame that shows clearly more of it than the host; false where that does not.
TEXTPLANE_DEFERRED
inline bool shown_better(const TextOptions& options, const TextKeyframe& host, const TextKeyframe& keyframe,
                         const TextObject& text, Quad<double>* quad) noexcept {
  const SE3d T_k_h = keyframe.from(host);
  if (!project_text(text, T_k_h, keyframe.camera, quad) || !is_convex(*quad) ||
      !inside_image(*quad, keyframe.width(), keyframe.height(), options.border))
    return false;
  if (!(area(*quad) >= options.rehost_area * area_in_host(text.patch))) return false;
  const auto slant = [&](const SE3d& T) { return std::acos(std::clamp(facing(text, T), -1.0, 1.0)); };
  return slant(T_k_h) <= slant(host.from(host)) + radians(options.rehost_slant);
}

// Mean of 1 - ZNCC between the text's patch and these key frames, on the finest level.
TEXTPLANE_DEFERRED
double dissimilarity(const KeyframeLookup& keyframes, const TextObject& text, const std::vector<int>& ids) {
  const TextKeyframe host = keyframes(text.host);
  PhotometricWorkspace workspace;
  double sum = 0;
  for (const int id : ids) {
    const TextKeyframe keyframe = keyframes(id);
    const SE3d T_k_h = keyframe.from(host);
    Quad<double> quad;
    if (!project_text(text, T_k_h, keyframe.camera, &quad)) return 2;
    const auto cost = compare_text(text, 0, keyframe, T_k_h, scale_shift(text, quad), workspace);
    sum += is_ok(cost.status) ? 1 - cost.zncc : 2;
  }
  return sum / static_cast<double>(ids.size());
}

}  // namespace detail

/// Makes key frame `id`, one of the mapped text's views, its host. False, and the text as it was, where it shows the
/// text less than rehost_area times as large, more slanted by rehost_slant, or not whole; or where the other views
/// agree with its patch clearly less (rehost_max_dissimilarity), as with a blurred one.
TEXTPLANE_DEFERRED
bool rehost(const TextOptions& options, const KeyframeLookup& keyframes, int id, TextObject& text) {
  const auto at = std::find(text.views.begin(), text.views.end(), id);
  Quad<double> quad;
  if (text.state != TextState::mapped || at == text.views.end()) return false;
  const TextKeyframe host = keyframes(text.host), keyframe = keyframes(id);
  if (!detail::shown_better(options, host, keyframe, text, &quad)) return false;
  std::vector<int> others = text.views;
  others.erase(others.begin() + (at - text.views.begin()));
  if (others.empty()) return false;

  TextObject moved = text;
  moved.host = id;
  moved.patch = make_text_patch(options, keyframe, quad);
  if (!is_ok(moved.patch.status) || !transport_plane(keyframe.from(host), &moved.theta, &moved.covariance))
    return false;
  moved.views = others;
  moved.views.insert(std::upper_bound(moved.views.begin(), moved.views.end(), text.host), text.host);
  const auto most = static_cast<std::size_t>(options.views);
  if (!refine_text_plane(options, keyframes, evenly_spaced(moved.views, most), moved.theta, options.min_zncc, moved))
    return false;
  // The same key frames speak for either host.
  const std::vector<int> both = evenly_spaced(others, most);
  if (detail::dissimilarity(keyframes, moved, both) >
      options.rehost_max_dissimilarity * detail::dissimilarity(keyframes, text, both))
    return false;
  text = std::move(moved);
  return true;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_HOSTING_HPP
