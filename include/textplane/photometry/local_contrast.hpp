// Intensities as they compare with those around them: what light that changes over a few strokes' width leaves alone.
//
// The photometric residual removes one gain and one bias of a whole patch. The edge of a shadow, a highlight or a lamp
// from the side changes them within it. Here the mean of a square round every pixel is subtracted and its deviation
// divided out, on both sides. Noise grows where contrast is low, so this pays where the light differs between the
// views.
#ifndef TEXTPLANE_PHOTOMETRY_LOCAL_CONTRAST_HPP
#define TEXTPLANE_PHOTOMETRY_LOCAL_CONTRAST_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"
#include "textplane/photometry/patch.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// How LocalContrast compares a pixel with its surroundings.
struct LocalContrastOptions {
  int radius = 6;  ///< px: the square has 2 radius + 1 a side, cut where the image ends; in [1, kMaxRadius].
  /// Grey levels, in [0.01, 1e6]: deviations well below this are taken for noise and not made larger. Means are in
  /// float: below 0.01 their rounding would be seen.
  double floor = 4.0;
  double scale = 40.0;                   ///< Grey levels that one deviation becomes; above 0, at most 1e6.
  static constexpr int kMaxRadius = 64;  ///< px, of the largest square.

  /// Whether the numbers make sense.
  bool valid() const noexcept {
    return radius >= 1 && radius <= kMaxRadius && is_finite(floor) && floor >= 0.01 && floor <= 1e6 &&
           is_finite(scale) && scale > 0 && scale <= 1e6;
  }
};

/// Replaces I by 128 + scale (I - mean) / sqrt(variance + floor^2), mean and variance being those of a square round the
/// pixel; cut to [0, 255], rounded. The cost a pixel does not depend on the radius. Keeps the memory that this takes:
/// use one a thread.
class LocalContrast {
 public:
  LocalContrast() = default;  ///< With the default options.
  /// With these: what is not valid() shows in the status of every call.
  explicit LocalContrast(const LocalContrastOptions& options) : options_(options) {}

  /// Fills `to` with what becomes of the pixels of `from` that begin at (x0, y0). invalid_argument for options or views
  /// that are not valid() and where `to` reaches beyond the image. Allocates while it meets a wider `to` than before.
  Status operator()(const ImageView8& from, int x0, int y0, const ImageView<std::uint8_t>& to) {
    if (!options_.valid() || !from.valid() || !to.valid() || x0 < 0 || y0 < 0 || x0 > from.width() - to.width() ||
        y0 > from.height() - to.height())
      return Status::invalid_argument;
    const int r = options_.radius, x1 = x0 + to.width();
    const int left = (std::max)(x0 - r, 0), right = (std::min)(x1 + r, from.width());
    const auto n = static_cast<std::size_t>(right - left);
    // Made anew, not grown: the function that grows a vector would be shared between translation units (see
    // config.hpp).
    if (sums_.size() < 2 * n) sums_ = std::vector<std::int32_t>(2 * n);
    if (means_.size() < 2 * n) means_ = std::vector<float>(2 * n);
    for (std::size_t i = 0; i < 2 * n; ++i) sums_[i] = 0;

    int top = (std::max)(y0 - r, 0), bottom = top;  // rows [top, bottom) are in the sums of the columns
    for (int y = y0; y < y0 + to.height(); ++y) {
      for (; bottom < (std::min)(y + r, from.height()); ++bottom) exchange_rows(from.row(bottom) + left, nullptr, n);
      const bool in = bottom < (std::min)(y + r + 1, from.height()), out = top < y - r;
      exchange_rows(in ? from.row(bottom) + left : nullptr, out ? from.row(top) + left : nullptr, n);
      bottom += in;
      top += out;
      write_row(from.row(y), bottom - top, left, n, x0, x1, from.width(), to.row(y - y0));
    }
    return Status::ok;
  }

  /// The intensities and gradients of a patch's level taken anew from an image that begins at (x0, y0) of the level, as
  /// the operator fills it. Pixels outside of it keep what they had. `camera`: of the level, for its lens.
  TEXTPLANE_DEFERRED
  static void take(const ImageView8& image, int x0, int y0, PatchLevel* level, const CameraView& camera = {}) noexcept {
    for (std::size_t i = 0; i < level->x.size(); ++i) {
      const Vector2<float> px = level->taken(i);
      const float x = px[0] - static_cast<float>(x0), y = px[1] - static_cast<float>(y0);
      if (!sample_bilinear(image, x, y, &level->intensity[i])) continue;
      if (i >= level->gx.size() || i >= level->gy.size()) continue;
      host_gradient(image, x, y, &level->gx[i], &level->gy[i]);
      float straight_x = px[0], straight_y = px[1];
      if (camera.lens) (void)detail::straighten(camera, &straight_x, &straight_y, &level->gx[i], &level->gy[i]);
    }
  }

 private:
  // Takes a row into the sums of the n columns and another out of them, at once: where either is missing it is null.
  void exchange_rows(const std::uint8_t* in, const std::uint8_t* out, std::size_t n) noexcept {
    if (in && out) exchange<true, true>(in, out, n);
    if (in && !out) exchange<true, false>(in, out, n);
    if (!in && out) exchange<false, true>(in, out, n);
  }
  template <bool In, bool Out>
  void exchange(const std::uint8_t* in, const std::uint8_t* out, std::size_t n) noexcept {
    std::int32_t *values = sums_.data(), *squares = values + n;
    for (std::size_t i = 0; i < n; ++i) {
      const std::int32_t a = In ? in[i] : 0, b = Out ? out[i] : 0;
      values[i] += a - b;
      squares[i] += (a - b) * (a + b);
    }
  }

  // Pixels [x0, x1) of a row, from the sums over its square's `rows` rows of the n columns from `left` on.
  void write_row(const std::uint8_t* row, int rows, int left, std::size_t n, int x0, int x1, int width,
                 std::uint8_t* to) noexcept {
    const int r = options_.radius;
    const std::int32_t *values = sums_.data(), *squares = values + n;
    const auto count = static_cast<std::size_t>(x1 - x0);
    float *value = means_.data(), *square = value + count;
    std::int32_t v = 0, s = 0;
    float share = 0;
    int columns = 0, first = left, last = left;  // columns [first, last) are in these
    for (int x = x0; x < x1; ++x) {
      for (; last < (std::min)(x + r + 1, width); ++last) v += values[last - left], s += squares[last - left];
      for (; first < x - r; ++first) v -= values[first - left], s -= squares[first - left];
      if (columns != last - first) {
        columns = last - first;
        share = 1.0F / static_cast<float>(rows * columns);
      }
      value[x - x0] = static_cast<float>(v) * share;
      square[x - x0] = static_cast<float>(s) * share;
    }
    const auto scale = static_cast<float>(options_.scale), least = static_cast<float>(options_.floor * options_.floor);
    for (std::size_t i = 0; i < count; ++i) {
      const float variance = (std::max)(square[i] - value[i] * value[i], 0.0F);
      const float out =
          128.5F + scale * (static_cast<float>(row[x0 + static_cast<int>(i)]) - value[i]) / std::sqrt(variance + least);
      to[i] = static_cast<std::uint8_t>((std::min)((std::max)(out, 0.0F), 255.0F));
    }
  }

  LocalContrastOptions options_;
  std::vector<std::int32_t> sums_;  // of the square's rows, a column each: values, then squares
  std::vector<float> means_;        // of the square of each pixel of a row: values, then squares
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_LOCAL_CONTRAST_HPP
