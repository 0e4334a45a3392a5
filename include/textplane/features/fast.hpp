// FAST-9/16 corners, the definition and order of OpenCV's TYPE_9_16: same positions, same responses, same order.
//
// A pixel p is a corner where at least 9 consecutive pixels of the circle of 16 around it (radius 3) are all brighter
// than I(p) + threshold or all darker than I(p) - threshold. Rosten and Drummond, "Machine learning for high-speed
// corner detection", ECCV 2006. The score is the largest threshold at which p is still a corner.
#ifndef TEXTPLANE_FEATURES_FAST_HPP
#define TEXTPLANE_FEATURES_FAST_HPP

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "textplane/core/image_view.hpp"
#include "textplane/core/status.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A corner at pixel (x, y) of the image it was found in. `score` is an integer in [threshold, 254]; 0 where the
/// detector was asked not to suppress (as in OpenCV, which does not compute it then; see fast_score()).
struct Corner {
  float x = 0, y = 0;
  float score = 0;
};

namespace detail {

// Byte offsets of the circle, clockwise from the pixel below the centre.
struct FastCircle {
  std::ptrdiff_t offset[16];

  explicit FastCircle(std::ptrdiff_t stride) noexcept {
    constexpr int dx[16] = {0, 1, 2, 3, 3, 3, 2, 1, 0, -1, -2, -3, -3, -3, -2, -1};
    constexpr int dy[16] = {3, 3, 2, 1, 0, -1, -2, -3, -3, -3, -2, -1, 0, 1, 2, 3};
    for (int k = 0; k < 16; ++k) offset[k] = dx[k] + dy[k] * stride;
  }
};

// A cyclic run of 9 set bits among 16.
inline bool has_run_of_nine(std::uint32_t bits) noexcept {
  const std::uint32_t m = bits | (bits << 16);
  std::uint32_t run = m & (m >> 1);
  run &= run >> 2;
  run &= run >> 4;
  return (run & (m >> 8)) != 0;
}

inline bool is_fast_corner(const std::uint8_t* p, const FastCircle& circle, int threshold) noexcept {
  const int high = *p + threshold, low = *p - threshold;
  // A run of 9 covers one of each pair of opposite pixels, and at least two neighbours of every four compass pixels.
  const int p0 = p[circle.offset[0]], p8 = p[circle.offset[8]];
  const bool bright = (p0 > high) | (p8 > high), dark = (p0 < low) | (p8 < low);
  if (!(bright | dark)) return false;
  const int p4 = p[circle.offset[4]], p12 = p[circle.offset[12]];
  if (!((bright & ((p4 > high) | (p12 > high))) | (dark & ((p4 < low) | (p12 < low))))) return false;
  std::uint32_t brighter = 0, darker = 0;
  for (int k = 0; k < 16; ++k) {
    const int v = p[circle.offset[k]];
    brighter |= static_cast<std::uint32_t>(v > high) << k;
    darker |= static_cast<std::uint32_t>(v < low) << k;
  }
  return has_run_of_nine(brighter) || has_run_of_nine(darker);
}

// Largest over the 16 arcs of 9 pixels of the smallest difference along the arc, for brighter and for darker arcs, less
// one: the largest threshold (the comparison is strict) that leaves the pixel a corner. At least -1.
inline int fast_score(const std::uint8_t* p, const FastCircle& circle) noexcept {
  int low[24], high[24];  // running minimum and maximum of the differences, arcs doubled in length at every pass
  for (int k = 0; k < 16; ++k) low[k] = high[k] = *p - p[circle.offset[k]];
  for (int k = 16; k < 24; ++k) low[k] = high[k] = low[k - 16];
  int first_low[16], first_high[16];
  for (int k = 0; k < 16; ++k) {
    first_low[k] = low[k + 8];
    first_high[k] = high[k + 8];
  }
  const auto minimum = [](int a, int b) { return a < b ? a : b; };
  const auto maximum = [](int a, int b) { return a > b ? a : b; };
  int best = 0;
  for (int k = 0; k < 23; ++k) {
    low[k] = minimum(low[k], low[k + 1]);
    high[k] = maximum(high[k], high[k + 1]);
  }
  for (int k = 0; k < 21; ++k) {
    low[k] = minimum(low[k], low[k + 2]);
    high[k] = maximum(high[k], high[k + 2]);
  }
  for (int k = 0; k < 16; ++k) {
    const int least = minimum(minimum(low[k], low[k + 4]), first_low[k]);
    const int most = maximum(maximum(high[k], high[k + 4]), first_high[k]);
    best = maximum(best, maximum(least, -most));
  }
  return best - 1;
}

// Calls emit(x, y, score) for every corner in raster order. `scratch`: 3 * width bytes, used where `suppress`.
template <class Emit>
void scan_fast(const ImageView8& image, int threshold, bool suppress, std::uint8_t* scratch, Emit emit) {
  const int width = image.width(), height = image.height();
  if (width < 7 || height < 7) return;
  threshold = threshold < 0 ? 0 : (threshold > 255 ? 255 : threshold);
  const FastCircle circle(image.stride());
  if (!suppress) {
    for (int y = 3; y < height - 3; ++y) {
      const std::uint8_t* row = image.row(y);
      for (int x = 3; x < width - 3; ++x)
        if (is_fast_corner(row + x, circle, threshold)) emit(x, y, 0);
    }
    return;
  }
  const std::size_t row_bytes = static_cast<std::size_t>(width);
  std::memset(scratch, 0, 3 * row_bytes);
  std::uint8_t* above = scratch;
  std::uint8_t* middle = scratch + row_bytes;
  std::uint8_t* below = scratch + 2 * row_bytes;
  for (int y = 3; y <= height - 3; ++y) {  // `below` is row y; the row judged is y - 1
    std::memset(below, 0, row_bytes);
    if (y < height - 3) {
      const std::uint8_t* row = image.row(y);
      for (int x = 3; x < width - 3; ++x)
        if (is_fast_corner(row + x, circle, threshold))
          below[x] = static_cast<std::uint8_t>(fast_score(row + x, circle));
    }
    for (int x = 3; x < width - 3; ++x) {
      const int s = middle[x];
      if (s == 0) continue;
      if (s > middle[x - 1] && s > middle[x + 1] && s > above[x - 1] && s > above[x] && s > above[x + 1] &&
          s > below[x - 1] && s > below[x] && s > below[x + 1])
        emit(x, y - 1, s);
    }
    std::uint8_t* const recycled = above;
    above = middle;
    middle = below;
    below = recycled;
  }
}

}  // namespace detail

/// FAST score of pixel (x, y), at least 3 px from every border: the largest threshold at which it is a corner, -1 where
/// it is none at any. No allocation.
inline int fast_score(const ImageView8& image, int x, int y) noexcept {
  if (!image.valid() || x < 3 || y < 3 || x >= image.width() - 3 || y >= image.height() - 3) return -1;
  return detail::fast_score(image.row(y) + x, detail::FastCircle(image.stride()));
}

/// Bytes of scratch that detect_fast() on caller buffers needs for an image of this width.
constexpr std::size_t fast_scratch_size(int width) noexcept { return 3 * static_cast<std::size_t>(width); }

/// FAST-9/16 corners of `image` in raster order, on the caller's memory. `threshold`: intensity, clamped to [0, 255].
/// `suppress`: keep a corner only where its score exceeds those of its eight neighbours. Corners lie at least 3 px from
/// every border. `scratch`: fast_scratch_size(width) bytes, may be null without `suppress`. Writes at most `capacity`
/// corners to `out`; `*found` is the number there are, which may be larger. Status::invalid_argument (and *found = 0)
/// for a broken view or a missing buffer. No allocation; any number of threads.
inline Status detect_fast(const ImageView8& image, int threshold, bool suppress, std::uint8_t* scratch, Corner* out,
                          int capacity, int* found) noexcept {
  *found = 0;
  if (!image.valid() || capacity < 0 || (capacity > 0 && !out) || (suppress && !scratch))
    return Status::invalid_argument;
  int n = 0;
  detail::scan_fast(image, threshold, suppress, scratch, [&](int x, int y, int score) {
    if (n < capacity) out[n] = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(score)};
    ++n;
  });
  *found = n;
  return Status::ok;
}

/// The same into a vector, whose content is replaced. Allocates.
inline Status detect_fast(const ImageView8& image, int threshold, bool suppress, std::vector<Corner>& out) {
  out.clear();
  if (!image.valid()) return Status::invalid_argument;
  std::vector<std::uint8_t> scratch(suppress ? fast_scratch_size(image.width()) : 0);
  detail::scan_fast(image, threshold, suppress, scratch.data(), [&](int x, int y, int score) {
    out.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(score)});
  });
  return Status::ok;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_FEATURES_FAST_HPP
