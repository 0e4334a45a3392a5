// KLT: sparse tracking from one image pyramid to the next, coarse to fine, invariant to gain and bias, checked backwards.
//
// Lucas and Kanade 1981 and Tomasi and Kanade 1991 with the normalised inverse-compositional step of align.hpp on every
// level; pyramid levels as in DESIGN section 2: level l pixel = (x + 0.5) / 2^l - 0.5.
#ifndef TEXTPLANE_FEATURES_KLT_HPP
#define TEXTPLANE_FEATURES_KLT_HPP

#include <cmath>

#include "textplane/features/align.hpp"
#include "textplane/photometry/pyramid.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {

// One direction: the patch round `source` (level 0 of `from`) is looked for in `to`, starting at `guess`. A coarse level
// where patch or target leaves the image, or where the patch has no texture, is skipped; the finest must succeed.
inline Alignment track_one(const PyramidView& from, const PyramidView& to, const Vector2<float>& source,
                           const Vector2<float>& guess, int levels, const KltOptions& options) noexcept {
  PatchTemplate t;
  Alignment found{guess[0], guess[1], 0, Status::out_of_view};
  for (int level = levels - 1; level >= 0; --level) {
    const std::size_t l = static_cast<std::size_t>(level);
    const float scale = 1.0F / static_cast<float>(1 << level);
    Status status = extract_upright_template(from.level[l], (source[0] + 0.5F) * scale - 0.5F,
                                             (source[1] + 0.5F) * scale - 0.5F, options.half_window, &t);
    if (is_ok(status) && t.contrast() < options.min_contrast) status = Status::no_contrast;
    Alignment a{0, 0, 0, status};
    if (is_ok(status))
      a = align_translation(t, to.level[l], (found.x + 0.5F) * scale - 0.5F, (found.y + 0.5F) * scale - 0.5F, options);
    if (is_ok(a.status)) {
      found.x = (a.x + 0.5F) / scale - 0.5F;
      found.y = (a.y + 0.5F) / scale - 0.5F;
    }
    found.zncc = a.zncc;
    found.status = a.status;
  }
  return found;
}

inline bool valid_levels(const PyramidView& pyramid, int levels) noexcept {
  for (int l = 0; l < levels; ++l)
    if (!pyramid.level[static_cast<std::size_t>(l)].valid()) return false;
  return true;
}

}  // namespace detail

/// Tracks n points from one image to another: out[i] is where the patch round from_px[i] is seen in `to`.
/// `from_px`, and `guess` if not null (predicted positions in `to`): px of level 0. Without a guess the search starts at
/// from_px. Points are independent of each other: split the range to use several threads. No allocation.
///
/// A point whose patch (with one more ring of pixels for its gradients) leaves the image at a level skips that level; at
/// level 0 it fails. out[i].status: converged or iteration_limit for a track that passed every check; out_of_view,
/// no_contrast, rank_deficient (texture in one direction only) as they arise at level 0; diverged where the correlation is
/// below min_zncc or the point tracked back is more than max_forward_backward px off (px, zncc and fb_error tell);
/// non_finite (px = 0); invalid_argument for broken pyramids or options. On failures but `diverged`, px is the guess or
/// the estimate of the coarser levels.
inline void track_klt(const PyramidView& from, const PyramidView& to, const Vector2<float>* from_px,
                      const Vector2<float>* guess, int n, const KltOptions& options, KltResult* out) noexcept {
  int levels = options.levels < from.levels ? options.levels : from.levels;
  if (to.levels < levels) levels = to.levels;
  const bool valid = levels >= 1 && levels <= kMaxPyramidLevels && options.half_window >= 1 &&
                     options.half_window <= kMaxPatchHalf && detail::valid_options(options) &&
                     detail::valid_levels(from, levels) && detail::valid_levels(to, levels);
  for (int i = 0; i < n; ++i) {
    KltResult& result = out[i];
    result = KltResult();
    const Vector2<float> source = from_px[i], start = guess ? guess[i] : from_px[i];
    if (!all_finite(source) || !all_finite(start)) {
      result.status = Status::non_finite;
      continue;
    }
    result.px = start;
    if (!valid) continue;
    const detail::Alignment forward = detail::track_one(from, to, source, start, levels, options);
    result.px = {forward.x, forward.y};
    result.zncc = forward.zncc;
    result.status = forward.status;
    if (!is_ok(forward.status)) continue;
    if (forward.zncc < options.min_zncc) {
      result.status = Status::diverged;
      continue;
    }
    if (!(options.max_forward_backward > 0.0F)) continue;
    // The way back starts as far from its goal as the way forth did, so that it is a test of its own.
    const Vector2<float> back_start = result.px - (start - source);
    const detail::Alignment backward = detail::track_one(to, from, result.px, back_start, levels, options);
    const float dx = backward.x - source[0], dy = backward.y - source[1];
    result.fb_error = std::sqrt(dx * dx + dy * dy);
    if (!is_ok(backward.status) || result.fb_error > options.max_forward_backward) result.status = Status::diverged;
  }
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_FEATURES_KLT_HPP
