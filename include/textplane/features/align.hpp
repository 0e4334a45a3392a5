// Aligns a PointPatch to an image by translation: inverse compositional, invariant to gain and bias.
//
// Baker and Matthews, "Lucas-Kanade 20 years on", IJCV 2004, on zero-mean unit-norm intensities (point_patch.hpp).
// Hessian and Jacobian belong to the patch, so an iteration is one pass over the samples of the target.
#ifndef TEXTPLANE_FEATURES_ALIGN_HPP
#define TEXTPLANE_FEATURES_ALIGN_HPP

#include <cmath>
#include <cstdint>

#include "textplane/features/point_patch.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Parameters of track_klt() and align_point_patch(). px of the current level unless said otherwise.
struct KltOptions {
  int radius = 9;           ///< A patch has 2 radius + 1 pixels a side; in [1, kMaxPatchRadius]. track_klt() only.
  int levels = 4;           ///< Pyramid levels used, at most those that exist. track_klt() only.
  int max_iterations = 20;  ///< On every level; in [1, 10000].
  float epsilon = 0.01F;    ///< px, above 0: a step shorter than this ends a level.
  /// Intensity, at least 0: smallest standard deviation of the patch and of its image in the target.
  float min_contrast = 1.5F;
  float min_eigenvalue = 0.003F;      ///< 1/px^2: smallest eigenvalue of J~^T J~ (a straight edge has 0).
  float min_zncc = 0.8F;              ///< Smallest correlation of a successful track.
  float max_forward_backward = 1.0F;  ///< px of level 0; 0 or less: no backward pass. track_klt() only.
};

/// A tracked or aligned point. Never holds a NaN.
struct KltResult {
  Vector2<float> px = {0, 0};                ///< Level-0 px for track_klt(); the guess where no estimate exists.
  float zncc = 0;                            ///< Correlation on the finest level, before the last step; 0 if unknown.
  float fb_error = 0;                        ///< Forward-backward error, px; 0 where no backward pass was run.
  Status status = Status::invalid_argument;  ///< Why it ended.
};

namespace detail {

struct Alignment {
  float x = 0, y = 0, zncc = 0;
  Status status = Status::invalid_argument;
};

// The correlation of a patch with the image at (at_x, at_y), the position nearest to (x, y) on the grid of 1/64 px, and
// b = sum J~ I~: the step is -(J~^T J~)^-1 b. Status: ok, out_of_view or no_contrast.
struct Correlation {
  float at_x = 0, at_y = 0;
  float zncc = 0, bx = 0, by = 0;
  Status status = Status::out_of_view;
};

inline Correlation correlate(const PointPatch& t, const ImageView8& image, float x, float y,
                             float min_contrast) noexcept {
  Correlation c;
  const float left = x - t.dx - static_cast<float>(t.left), top = y - t.dy - static_cast<float>(t.top);
  PlacedPatch placed;
  if (!place_patch(image, left, top, t.columns, t.rows, &placed)) return c;
  c.at_x = x + placed.moved_x;
  c.at_y = y + placed.moved_y;
  const simd::KltSums sums = simd::klt_sums(placed.samples, t.patch);
  constexpr double kScale = simd::kKltScale;
  const double n = t.count();
  const double vv = sums.vv - sums.v * sums.v / n;  // kScale^2 ||I - mean||^2
  c.status = Status::no_contrast;
  const double least = static_cast<double>(min_contrast) * static_cast<double>(min_contrast);
  if (!(vv > kScale * kScale * n * least) || !(vv > 1e-6 * kScale * kScale * n)) return c;
  const double inverse = 1.0 / (std::sqrt(vv) * t.norm);
  const double tv = sums.tv - sums.v * t.mean_v;
  c.bx = static_cast<float>((sums.xv - sums.v * t.mean_x - tv * t.along_x) * inverse);
  c.by = static_cast<float>((sums.yv - sums.v * t.mean_y - tv * t.along_y) * inverse);
  c.zncc = static_cast<float>(tv * inverse);
  c.zncc = c.zncc > -1.0F ? (c.zncc < 1.0F ? c.zncc : 1.0F) : -1.0F;
  c.status = Status::ok;
  return c;
}

// Iterates from (x, y) with a patch whose status is ok. out_of_view or no_contrast where the start has no correlation
// (x, y stay); out_of_view where the last step left the image (x, y: the best inside); rank_deficient.
inline Alignment align_translation(const PointPatch& t, const ImageView8& image, float x, float y,
                                   const KltOptions& options) noexcept {
  Alignment result{x, y, 0, Status::iteration_limit};
  const float determinant = t.hxx * t.hyy - t.hxy * t.hxy;
  if (!(t.min_eigenvalue > options.min_eigenvalue) || !(determinant > 0.0F)) {
    result.status = Status::rank_deficient;
    return result;
  }
  const float longest = 0.5F * static_cast<float>(t.columns < t.rows ? t.columns : t.rows);
  float step_x = 0, step_y = 0, last2 = 0;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    const Correlation c = correlate(t, image, x, y, options.min_contrast);
    if (iteration == 0 && !is_ok(c.status)) {
      result.status = c.status;
      return result;
    }
    // A long step that lowers the correlation or leaves the image is halved. Short steps run on to the fixed point:
    // interpolation may put it a few hundredths of a pixel off the largest correlation.
    const bool worse = c.zncc < result.zncc && step_x * step_x + step_y * step_y > 0.0625F;
    if (iteration > 0 && (!is_ok(c.status) || worse)) {
      step_x *= 0.5F;
      step_y *= 0.5F;
      x = result.x + step_x;
      y = result.y + step_y;
      result.status = worse ? Status::iteration_limit : c.status;
      continue;
    }
    step_x = -(t.hyy * c.bx - t.hxy * c.by) / determinant;
    step_y = -(t.hxx * c.by - t.hxy * c.bx) / determinant;
    const float length2 = step_x * step_x + step_y * step_y;
    if (length2 > longest * longest) {
      const float scale = longest / std::sqrt(length2);
      step_x *= scale;
      step_y *= scale;
    }
    // Done where the step is short or rounds to zero, and where the step before was short and did not raise the
    // correlation: otherwise the iteration may cycle among a few neighbours on the grid.
    constexpr float kCell = 1.0F / simd::kKltSubpixels;
    const float longer = std::abs(step_x) > std::abs(step_y) ? std::abs(step_x) : std::abs(step_y);
    const bool done = length2 < options.epsilon * options.epsilon || longer <= 0.5F * kCell ||
                      (iteration > 0 && last2 < 4.0F * kCell * kCell && c.zncc <= result.zncc);
    last2 = length2;
    result = {c.at_x, c.at_y, c.zncc, Status::iteration_limit};
    x = c.at_x + step_x;
    y = c.at_y + step_y;
    if (done) return {x, y, c.zncc, Status::converged};
  }
  return result;
}

inline bool valid_options(const KltOptions& options) noexcept {
  return options.max_iterations >= 1 && options.max_iterations <= 10000 && options.epsilon > 0.0F &&
         is_finite(options.epsilon) && is_finite(options.min_contrast) && options.min_contrast >= 0.0F &&
         is_finite(options.min_eigenvalue) && is_finite(options.min_zncc);
}

}  // namespace detail

/// Refines the position of patch `t` in `target` from `start` (px of that image) by a translation of 2 parameters that
/// minimises || T~ - I~ ||^2 over zero-mean unit-norm intensities. On Status::converged or iteration_limit px is the
/// estimate and zncc its correlation. Otherwise: out_of_view (px = start), no_contrast and rank_deficient (too little
/// texture, px = start), diverged (zncc < min_zncc; px and zncc as found), non_finite (px = 0), invalid_argument, or
/// the status of a patch that was not extracted. No allocation; any number of threads.
inline KltResult align_point_patch(const PointPatch& t, const ImageView8& target, const Vector2<float>& start,
                                   const KltOptions& options = {}) noexcept {
  KltResult result;
  if (!all_finite(start)) {
    result.status = Status::non_finite;
    return result;
  }
  result.px = start;
  if (!target.valid() || !detail::valid_options(options)) return result;
  if (!is_ok(t.status)) {
    result.status = t.status;
    return result;
  }
  if (t.contrast() < options.min_contrast) {
    result.status = Status::no_contrast;
    return result;
  }
  const detail::Alignment a = detail::align_translation(t, target, start[0], start[1], options);
  result.px = {a.x, a.y};
  result.zncc = a.zncc;
  result.status = is_ok(a.status) && a.zncc < options.min_zncc ? Status::diverged : a.status;
  return result;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_FEATURES_ALIGN_HPP
