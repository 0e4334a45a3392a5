// KLT: sparse tracking from one image pyramid to another, coarse to fine, invariant to gain and bias, with a backward
// check.
//
// Lucas and Kanade 1981 and Tomasi and Kanade 1991 with the normalised inverse-compositional step of align.hpp on every
// level; pyramid levels as in docs/conventions.md: level l pixel = (x + 0.5) / 2^l - 0.5.
#ifndef TEXTPLANE_FEATURES_KLT_HPP
#define TEXTPLANE_FEATURES_KLT_HPP

#include <cmath>
#include <cstddef>

#include "textplane/features/align.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/photometry/pyramid.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {

// Size of a patch on a coarse level: cut at the borders of both images, so that points near a border keep their coarse
// levels. `at` and `start` are the point and its estimate in px of the level.
inline void cut_extents(const Vector2<float>& at, const Vector2<float>& start, const ImageView8& from,
                        const ImageView8& to, int radius, PointPatch* t) noexcept {
  const auto room = [radius](float a, float b) {
    const float least = a - 1.0F < b ? a - 1.0F : b;  // the gradients of the patch need one pixel more
    return least < static_cast<float>(radius) ? (least > 0.0F ? static_cast<int>(least) : 0) : radius;
  };
  t->left = room(at[0], start[0]);
  t->top = room(at[1], start[1]);
  const auto beyond = [&room](int from_size, float a, int to_size, float b) {
    return room(static_cast<float>(from_size - 1) - a, static_cast<float>(to_size - 1) - b);
  };
  t->columns = t->left + 1 + beyond(from.width(), at[0], to.width(), start[0]);
  t->rows = t->top + 1 + beyond(from.height(), at[1], to.height(), start[1]);
}

// The second try on a coarse level: aligns from the best correlation on a grid round the start. Returns that alignment
// or `missed`, the one with the larger correlation.
inline Alignment search(const PointPatch& t, const ImageView8& image, const Vector2<float>& start,
                        const Alignment& missed, const KltOptions& options) noexcept {
  constexpr int kRadius = 3;
  constexpr float kSpacing = 1.5F;
  float best = -2.0F, best_x = 0, best_y = 0;
  for (int j = -kRadius; j <= kRadius; ++j)
    for (int i = -kRadius; i <= kRadius; ++i) {
      const float x = start[0] + kSpacing * static_cast<float>(i), y = start[1] + kSpacing * static_cast<float>(j);
      const Correlation c = correlate(t, image, x, y, options.min_contrast);
      if (!is_ok(c.status) || c.zncc <= best) continue;
      best = c.zncc;
      best_x = x;
      best_y = y;
    }
  if (best < -1.0F) return missed;
  const Alignment found = align_translation(t, image, best_x, best_y, options);
  return is_ok(found.status) && found.zncc > missed.zncc ? found : missed;
}

// One direction: finds the patch round `source` (level 0 of `from`) in `to`, starting at `guess`. A coarse level that
// fails is skipped; the finest must succeed.
TEXTPLANE_DEFERRED
Alignment track_one(const PyramidView& from, const PyramidView& to, const Vector2<float>& source,
                    const Vector2<float>& guess, int levels, const KltOptions& options) noexcept {
  constexpr int kMinSide = 7;             // of a cut patch, px
  constexpr float kMinCoarseZncc = 0.3F;  // below it a coarse estimate does not help
  constexpr float kCoarseEpsilon = 0.1F;  // px of its level: the next level does the rest
  PointPatch t;
  KltOptions coarse = options;
  coarse.epsilon = coarse.epsilon > kCoarseEpsilon ? coarse.epsilon : kCoarseEpsilon;
  Alignment found{guess[0], guess[1], 0, Status::out_of_view};
  for (int level = levels - 1; level >= 0; --level) {
    const ImageView8& from_image = from.level[static_cast<std::size_t>(level)];
    const ImageView8& to_image = to.level[static_cast<std::size_t>(level)];
    const Vector2<float> at = point_to_level(source, level);
    const Vector2<float> start = point_to_level(Vector2<float>(found.x, found.y), level);
    if (level == 0) {
      t.left = t.top = options.radius;
      t.columns = t.rows = 2 * options.radius + 1;
    } else {
      cut_extents(at, start, from_image, to_image, options.radius, &t);
      if (t.columns < kMinSide || t.rows < kMinSide) continue;
    }
    Alignment a{start[0], start[1], 0, extract_upright_patch(from_image, at[0], at[1], &t)};
    if (is_ok(a.status) && t.contrast() < options.min_contrast) a.status = Status::no_contrast;
    if (is_ok(a.status)) a = align_translation(t, to_image, start[0], start[1], level > 0 ? coarse : options);
    bool usable = is_ok(a.status);
    if (level > 0) {
      const bool aligned = is_ok(t.status) && (usable || a.status == Status::out_of_view);
      if (aligned && a.zncc < options.min_zncc) a = search(t, to_image, start, a, coarse);
      usable = aligned && a.zncc > kMinCoarseZncc;
    }
    if (usable) {
      const Vector2<float> px = point_from_level(Vector2<float>(a.x, a.y), level);
      found.x = px[0];
      found.y = px[1];
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

/// Tracks n points from one image to another: out[i] is where the patch round from_px[i] is seen in `to`. `from_px` and
/// `guess` (predicted positions in `to`, or null: from_px) are in px of level 0. Points are independent of each other:
/// split the range to use several threads. No allocation.
///
/// The patch, with one more ring of pixels for its gradients, must lie inside the image at level 0. On coarser levels
/// it is cut at the borders; a level is skipped where fewer than 7 px a side remain or where it does not align.
/// out[i].status: converged or iteration_limit for a track that passed every check; out_of_view, no_contrast or
/// rank_deficient (texture in one direction only) at level 0; diverged where the correlation is below min_zncc or the
/// point tracked back is more than max_forward_backward px off (see zncc and fb_error); non_finite (px = 0);
/// invalid_argument for broken pyramids or options. On every failure but `diverged`, px is the guess or the estimate of
/// the coarser levels.
TEXTPLANE_DEFERRED
void track_klt(const PyramidView& from, const PyramidView& to, const Vector2<float>* from_px,
               const Vector2<float>* guess, int n, const KltOptions& options, KltResult* out) noexcept {
  int levels = options.levels < from.levels ? options.levels : from.levels;
  if (to.levels < levels) levels = to.levels;
  const bool valid = levels >= 1 && levels <= kMaxPyramidLevels && options.radius >= 1 &&
                     options.radius <= kMaxPatchRadius && is_finite(options.max_forward_backward) &&
                     detail::valid_options(options) && detail::valid_levels(from, levels) &&
                     detail::valid_levels(to, levels);
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
    // The backward pass starts as far from its goal as the forward pass did: otherwise it would test little.
    const Vector2<float> back_start(result.px[0] - (start[0] - source[0]), result.px[1] - (start[1] - source[1]));
    const detail::Alignment backward = detail::track_one(to, from, result.px, back_start, levels, options);
    const float dx = backward.x - source[0], dy = backward.y - source[1];
    result.fb_error = std::sqrt(dx * dx + dy * dy);
    if (!is_ok(backward.status) || result.fb_error > options.max_forward_backward) result.status = Status::diverged;
  }
}

TEXTPLANE_INSTANCE(void track_klt<>(const PyramidView&, const PyramidView&, const Vector2<float>*,
                                    const Vector2<float>*, int, const KltOptions&, KltResult*) noexcept);

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_FEATURES_KLT_HPP
