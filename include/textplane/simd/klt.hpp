// KLT by fixed point: bilinear windows of an 8-bit image, their gradients, and the sums that an alignment needs.
//
// Sub-pixel positions are multiples of 1/64 px, samples and gradients int16 in units of 1/32 grey level, sums exact
// integers: the same on every target. A position that is rounded to the grid costs an iteration no accuracy where its
// step is taken from the rounded one.
#ifndef TEXTPLANE_SIMD_KLT_HPP
#define TEXTPLANE_SIMD_KLT_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/simd/ops.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace simd {

constexpr int kKltSide = 21;       ///< Largest columns and rows of a patch.
constexpr int kKltStride = 32;     ///< int16 from a row of samples to the next.
constexpr int kKltSubpixels = 64;  ///< Positions a px.
constexpr int kKltScale = 32;      ///< Units of a sample a grey level.
constexpr int kKltSlack = 32;      ///< int16 past the last row that vectors read.
/// Elements of a patch with a border of one sample on all sides.
constexpr int kKltPadded = (kKltSide + 2) * kKltStride + kKltSlack;

/// columns x rows samples v = kKltScale (I - 128), rounded down, of the bilinear interpolant; the first one (fx, fy) /
/// 64 px from the pixel at `data`. The columns + 1 pixels of rows + 1 rows from there on exist.
struct KltWindow {
  const std::uint8_t* data = nullptr;
  std::ptrdiff_t stride = 0;  ///< Bytes.
  int readable = 0;  ///< Bytes that may be read from the first pixel of each of the rows on; at least columns + 1.
  int columns = 0, rows = 0;  ///< In [1, kKltSide].
  int fx = 0, fy = 0;         ///< In [0, 64].
};

/// Samples v and gradients x, y (half of the central differences, rounded down; units of a sample a px) of a patch,
/// rows kKltStride apart. What lies past the last column is unspecified.
struct KltPatch {
  static constexpr int kCapacity = kKltSide * kKltStride;
  std::int16_t value[kCapacity], gx[kCapacity], gy[kCapacity];
};

/// Sums over a patch: v, v^2, x, y, v x, v y, x^2, x y, y^2. Integers.
struct KltPatchSums {
  double v = 0, vv = 0, x = 0, y = 0, vx = 0, vy = 0, xx = 0, xy = 0, yy = 0;
};

/// Sums of the samples v of a window, and of their products with the samples t and the gradients x, y of a patch.
/// Integers.
struct KltSums {
  double v = 0, vv = 0, tv = 0, xv = 0, yv = 0;
};

}  // namespace simd
TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/klt.inl"
#include "textplane/simd/foreach_target.inl"

TEXTPLANE_BEGIN_NAMESPACE
namespace simd {

/// A patch from grey levels in [0, 255] that the caller sampled, rounded to samples: (columns + 2) x (rows + 2) of
/// them, the patch with a border of one on all sides, kKltStride apart in kKltPadded elements that are all initialised.
/// No allocation.
TEXTPLANE_KERNEL KltPatchSums klt_from_grey(const float* padded, int columns, int rows, KltPatch& patch) noexcept
    TEXTPLANE_SIMD_BODY(klt_from_grey(padded, columns, rows, patch));

/// A patch from an image. `window` is that of the patch with its border: 2 more columns and rows than the patch,
/// whose own are within [1, kKltSide]. Reads the window's pixels, and others of their rows only within `readable`.
TEXTPLANE_KERNEL KltPatchSums klt_extract(const KltWindow& window, KltPatch& patch) noexcept
    TEXTPLANE_SIMD_BODY(klt_extract(window, patch));

/// One evaluation of an alignment: the window has the size of the patch. Reads as klt_extract(). No allocation.
TEXTPLANE_KERNEL KltSums klt_sums(const KltWindow& window, const KltPatch& patch) noexcept
    TEXTPLANE_SIMD_BODY(klt_sums(window, patch));

}  // namespace simd
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_KLT_HPP
