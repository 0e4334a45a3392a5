// FAST-9/16 corners: the positions, responses and order of OpenCV's TYPE_9_16.
//
// A pixel p is a corner where at least 9 consecutive pixels of the circle of 16 around it (radius 3) are all brighter
// than I(p) + threshold or all darker than I(p) - threshold. Rosten and Drummond, "Machine learning for high-speed
// corner detection", ECCV 2006. The score is the largest threshold at which p is still a corner.
#ifndef TEXTPLANE_FEATURES_FAST_HPP
#define TEXTPLANE_FEATURES_FAST_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "textplane/core/image_view.hpp"
#include "textplane/core/status.hpp"
#include "textplane/simd/fast.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A corner at pixel (x, y). `score`: the largest threshold (intensity) at which it is a corner, an integer in
/// [threshold, 254]; 0 without non-maximum suppression, as in OpenCV.
struct Corner {
  float x = 0;      ///< px of the image.
  float y = 0;      ///< Likewise.
  float score = 0;  ///< Intensity.
};

namespace detail {

// Calls emit(x, y, score) for every corner in raster order. `scratch`: fast_scratch_size() bytes where `suppress`.
template <class Emit>
void scan_fast(const ImageView8& image, int threshold, bool suppress, std::uint8_t* scratch, Emit emit) {
  constexpr int kPart = 512;  // pixels of a row in one call
  const int width = image.width(), height = image.height();
  if (width < 7 || height < 7) return;
  threshold = threshold < 0 ? 0 : (threshold > 255 ? 255 : threshold);
  int found[kPart];
  if (!suppress) {
    std::uint8_t strengths[kPart + 6 + simd::kFastRowPadding] = {};
    for (int y = 3; y < height - 3; ++y)
      for (int x = 3; x < width - 3; x += kPart) {
        const int n = width - 3 - x < kPart ? width - 3 - x : kPart;
        if (!simd::fast_row({image.row(y) + x - 3, image.stride(), n + 6, threshold, 0, strengths})) continue;
        const int count = simd::fast_maxima({nullptr, strengths, nullptr, 3, n + 3, false, found});
        for (int i = 0; i < count; ++i) emit(x + found[i] - 3, y, 0);
      }
    return;
  }
  const std::size_t pitch = static_cast<std::size_t>(width + simd::kFastRowPadding);
  std::memset(scratch, 0, 3 * pitch);
  std::uint8_t* above = scratch;
  std::uint8_t* middle = scratch + pitch;
  std::uint8_t* below = scratch + 2 * pitch;
  bool scored = false, next = false;  // rows y - 1 and y have scores
  for (int y = 3; y <= height - 3; ++y, scored = next) {
    // `below` is row y; `middle`, row y - 1, is suppressed.
    if (y < height - 3) {
      next = simd::fast_row({image.row(y), image.stride(), width, threshold, 1, below});
    } else {
      std::memset(below, 0, pitch);
    }
    for (int x = 3; scored && x < width - 3; x += kPart) {
      const int last = width - 3 - x < kPart ? width - 3 : x + kPart;
      const int count = simd::fast_maxima({above, middle, below, x, last, true, found});
      for (int i = 0; i < count; ++i) emit(found[i], y - 1, middle[found[i]]);
    }
    std::uint8_t* const recycled = above;
    above = middle;
    middle = below;
    below = recycled;
  }
}

}  // namespace detail

/// Bytes of scratch that detect_fast() needs for an image of this width.
constexpr std::size_t fast_scratch_size(int width) noexcept {
  return width > 0 ? 3 * (static_cast<std::size_t>(width) + simd::kFastRowPadding) : 0;
}

/// FAST-9/16 corners of `image` in raster order, in the caller's memory. `threshold`: intensity, clamped to [0, 255].
/// `suppress`: keep a corner only where its score exceeds those of its eight neighbours. Corners lie at least 3 px from
/// every border. `scratch`: fast_scratch_size(width) bytes, may be null without `suppress`. Writes at most `capacity`
/// corners to `out`; `*found` is the number of all corners, which may be larger. Status::invalid_argument (and *found =
/// 0) for an invalid view or a missing buffer. No allocation; any number of threads.
TEXTPLANE_DEFERRED
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
TEXTPLANE_DEFERRED
inline Status detect_fast(const ImageView8& image, int threshold, bool suppress, std::vector<Corner>& out) {
  out.clear();
  if (!image.valid()) return Status::invalid_argument;
  std::vector<std::uint8_t> scratch(suppress ? fast_scratch_size(image.width()) : 0);
  detail::scan_fast(image, threshold, suppress, scratch.data(), [&](int x, int y, int score) {
    out.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(score)});
  });
  return Status::ok;
}

/// Keeps the corners that the highest threshold with `enough` corners finds. Thresholds are `first`, lower(first) and
/// so on down to `lowest`, which keeps all; lower(t) that is not below t is `lowest`, too. Detect once at `lowest`: a
/// score is the largest threshold that finds the corner.
template <class Lower>
void keep_enough(std::vector<Corner>* corners, int first, int lowest, int enough, const Lower& lower) {
  for (int threshold = first;;) {
    const auto weak = [threshold](const Corner& c) { return c.score < static_cast<float>(threshold); };
    const auto all = static_cast<int>(corners->size());
    const int strong = all - static_cast<int>(std::count_if(corners->begin(), corners->end(), weak));
    if (strong < enough && threshold > lowest) {
      const int next = lower(threshold);
      threshold = next < threshold ? (std::max)(next, lowest) : lowest;
      continue;
    }
    corners->erase(std::remove_if(corners->begin(), corners->end(), weak), corners->end());
    return;
  }
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_FEATURES_FAST_HPP
