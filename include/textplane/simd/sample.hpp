// Scattered points through a homography and out of an 8-bit image: raw pointers in, raw pointers out.
//
// Point (x, y) goes to the pixel q_xy / q_z, q = H (x, y, 1). Coordinates are kept relative to two origins: u = x - hx,
// v = y - hy with (hx, hy) the centre of the points, and target pixels relative to the integer pixel (ox, oy) nearest
// to where that centre goes. H is recentred in double and rounded to float once, so that the error grows with the size
// of the patch, not of the image: 1e-5 px for patches of 128 px.
//
// Interpolation is bilinear, its gradient that of the interpolant. The cell is clamped to the image before anything is
// read, whatever the coordinates are: no byte outside of its pixels is touched.
//
// Two forms of the target image: the plain rows, or pairs prepared once a frame, which save one of two loads a point.
#ifndef TEXTPLANE_SIMD_SAMPLE_HPP
#define TEXTPLANE_SIMD_SAMPLE_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/simd/ops.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

/// An 8-bit image of at least 2 x 2 pixels with height * stride below 2^31, and optionally its pairs.
struct Image8 {
  const std::uint8_t* data = nullptr;
  std::ptrdiff_t stride = 0;  ///< Bytes from row to row.
  int width = 0, height = 0;
  const std::uint16_t* pairs = nullptr;  ///< prepare_pair16() of it, or null.
  std::ptrdiff_t pair_stride = 0;        ///< int16 from row to row.
};

/// True where the kernels can read the image.
inline bool readable(const Image8& image) noexcept {
  const std::int64_t most = 0x7fffffff, rows = image.height;  // products of two numbers below `most`, no slow division
  return image.data != nullptr && image.width >= 2 && image.height >= 2 && image.stride >= image.width &&
         image.stride <= most && image.stride * rows <= most &&
         (image.pairs == nullptr ||
          (image.pair_stride >= image.width && image.pair_stride <= most && 2 * (image.pair_stride * rows) <= most));
}

/// A homography between recentred coordinates, in float: with u = x - hx and v = y - hy the target pixel is
/// (ox, oy) + (g0 u + g1 v + g2, g3 u + g4 v + g5) / (g6 u + g7 v + g8), and in front where the divisor is positive.
struct Warp8 {
  float g[9];
  float hx, hy;
  int ox, oy;
};

/// Bounds of n points, so that they need not be found again in every call. n = 0: not known; whatever n, the kernels
/// use them for exactly as many points only, and find them where they are not given.
struct PointBounds {
  float x_low = 0, x_high = 0, y_low = 0, y_high = 0;
  int n = 0;
};

/// Arguments of warp_points() and sample_points(). Outputs may not overlap inputs.
struct PointArgs {
  const float* x = nullptr;  ///< n points.
  const float* y = nullptr;
  int n = 0;
  PointBounds bounds;                         ///< Of the n points, or none.
  double h[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< Row-major; its sign tells front from behind.
  Image8 image;                               ///< warp_points() takes its size alone, to choose the origin.
  float* out_x = nullptr;                     ///< Target px relative to the origin that is returned.
  float* out_y = nullptr;
  std::uint8_t* inside = nullptr;  ///< If not null: 1 in front and inside [0, width - 1] x [0, height - 1], else 0.
  float* value = nullptr;          ///< sample_points(): the interpolant, grey levels, 0 where not inside.
  float* gx = nullptr;             ///< Its gradient, grey levels a px, 0 where not inside.
  float* gy = nullptr;
};

/// What they return: the origin, and how many points are inside; -1 (and nothing is written) for an H that is not
/// finite, a negative n, null pointers, or an image that is not readable().
struct PointResult {
  int ox = 0, oy = 0;
  int inside = -1;
};

}  // namespace simd

namespace detail {
// Points are worked on in strips, so that what passes from one short loop to the next stays in the first cache.
enum : int { kStrip = 256 };

// Between the loops over a strip: position inside the cell, offset of the cell in bytes or pairs, its four pixels; for
// tiles the cell itself.
struct SampleStrip {
  float fx[kStrip], fy[kStrip];
  std::int32_t offset[kStrip];
  std::uint32_t taps[kStrip];
  std::int16_t x[kStrip], y[kStrip];
};

// The origin's pixel, bounds and stride in the units of the target that is read.
struct SampleFrame {
  const std::uint8_t* bytes;
  const std::uint16_t* pairs;
  std::ptrdiff_t stride;
  float x_low, x_high, y_low, y_high;  // of the cell, relative to the origin
  float x_last, y_last;                // of the last pixel, relative to the origin
};
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/sample.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/points.inl"
#include "textplane/simd/foreach_target.inl"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
TEXTPLANE_KERNEL void point_bounds(const float* x, const float* y, int n, simd::PointBounds* out) noexcept
    TEXTPLANE_SIMD_BODY(point_bounds(x, y, n, out));
TEXTPLANE_KERNEL void warp_points(const simd::PointArgs& args, simd::PointResult* result) noexcept
    TEXTPLANE_SIMD_BODY(warp_points(args, result));
TEXTPLANE_KERNEL void sample_points(const simd::PointArgs& args, simd::PointResult* result) noexcept
    TEXTPLANE_SIMD_BODY(sample_points(args, result));
}  // namespace detail

namespace simd {

/// Bounds of n points; of none (n = 0) where a coordinate is not finite, for null pointers and n < 1.
inline PointBounds point_bounds(const float* x, const float* y, int n) noexcept {
  PointBounds out;
  if (x && y && n > 0) detail::point_bounds(x, y, n, &out);
  return out;
}

/// Target pixels of scattered points. Same bits on avx2, avx512 and neon, and on scalar, sse41 and simd128; between the
/// groups, and to the exact value, about 1e-5 px as said above.
inline PointResult warp_points(const PointArgs& args) noexcept {
  PointResult result;
  detail::warp_points(args, &result);
  return result;
}

/// The same with value and gradient of the image there.
inline PointResult sample_points(const PointArgs& args) noexcept {
  PointResult result;
  detail::sample_points(args, &result);
  return result;
}

/// Writes pairs(x, y) = I(x, y) | I(x, y + 1) << 8, y < height - 1, to `pairs`, `pair_stride` int16 from row to row.
/// The caller guarantees an image that is readable() and room for (height - 2) * pair_stride + width int16. Costs about
/// what a copy of the image does.
TEXTPLANE_KERNEL void prepare_pair16(const Image8& image, std::uint16_t* pairs, std::ptrdiff_t pair_stride) noexcept
    TEXTPLANE_SIMD_BODY(prepare_pair16(image, pairs, pair_stride));

}  // namespace simd

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_SAMPLE_HPP
