// FAST-9/16 by rows: the score of every pixel of a row, and the pixels of a row whose score exceeds those of their
// neighbours.
#ifndef TEXTPLANE_SIMD_FAST_HPP
#define TEXTPLANE_SIMD_FAST_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/simd/ops.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace simd {

/// Bytes that fast_maxima() may read beyond the last pixel that it judges.
constexpr int kFastRowPadding = 64;

/// One row of an image, at least 3 rows from its first and from its last one.
struct FastRowArgs {
  const std::uint8_t* row = nullptr;
  std::ptrdiff_t stride = 0;       ///< Bytes from a row to the next.
  int width = 0;                   ///< Pixels of the row, at least 7.
  int threshold = 0;               ///< In [0, 255].
  int less = 0;                    ///< Subtracted from every strength, 0 or 1.
  std::uint8_t* scores = nullptr;  ///< width bytes, of which the first and the last 3 stay as they are.
};

/// Rows of scores as fast_row() writes them.
struct FastMaximaArgs {
  const std::uint8_t* above = nullptr;
  const std::uint8_t* row = nullptr;
  const std::uint8_t* below = nullptr;
  int first = 0, last = 0;  ///< Pixels first <= x < last are judged, within [3, width - 3].
  bool suppress = true;     ///< Otherwise `above` and `below` are not read.
  int* found = nullptr;     ///< last - first elements.
};

}  // namespace simd
TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/fast.inl"
#include "textplane/simd/foreach_target.inl"

TEXTPLANE_BEGIN_NAMESPACE
namespace simd {

/// The strength of a pixel p is the largest d for which 9 consecutive pixels of the circle of 16 round it are all >=
/// I(p) + d or all <= I(p) - d. Sets scores[x] = strength - less where strength > threshold, 0 elsewhere, for 3 <= x <
/// width - 3, and tells whether one of them is not 0. So pixel x is a FAST corner at `threshold` where its strength
/// counts, and its score, the largest such threshold, is strength - 1. The same bytes on every target. Reads the pixels
/// of the row and of the 3 rows on either side alone. No allocation.
TEXTPLANE_KERNEL bool fast_row(const FastRowArgs& args) noexcept TEXTPLANE_SIMD_BODY(fast_row(args));

/// Writes those x, ascending, at which row[x] is not 0 and, where `suppress`, exceeds its eight neighbours; returns
/// their number. Of the rows of scores it reads kFastRowPadding bytes beyond `last`, whatever they hold; where
/// `suppress`, scores are at most 254, and those of the 3 px at either end are 0.
TEXTPLANE_KERNEL int fast_maxima(const FastMaximaArgs& args) noexcept TEXTPLANE_SIMD_BODY(fast_maxima(args));

}  // namespace simd
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_FAST_HPP
