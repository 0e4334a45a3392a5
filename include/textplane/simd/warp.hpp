// Homography warp onto a regular output grid: raw pointers in, raw pointers out. photometry/warp_patch.hpp is the typed
// form.
//
// Output pixel (x, y) gets the bilinear interpolant of the source at q_xy / q_z, q = H (x, y, 1), where q_z > 0 and the
// point lies in [0, width - 1] x [0, height - 1], and `fill` elsewhere. No byte is read outside the source's rows.
//
// Coordinates are affine before the one division a pixel. Each block of the output is worked on around its own centre,
// in float relative to an integer origin near it, so that their error does not grow with the size of image or patch:
// below 2e-5 px, 0.005 grey levels, while a step in the output moves at most two pixels in the source.
#ifndef TEXTPLANE_SIMD_WARP_HPP
#define TEXTPLANE_SIMD_WARP_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/simd/ops.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

/// Arguments of the warps. Strides are in bytes. The caller guarantees: pointers not null, output sizes >= 0, `fill` in
/// the output's range, strides that hold a row. All else is checked.
struct WarpArgs {
  const void* source = nullptr;  ///< std::uint8_t or float, as the function's name says first.
  int width = 0, height = 0;     ///< Each at least 2, and height * source_stride below 2^31.
  std::ptrdiff_t source_stride = 0;
  void* out = nullptr;  ///< float or std::uint8_t, as the function's name says last. May not overlap the source.
  int out_width = 0, out_height = 0;
  std::ptrdiff_t out_stride = 0;
  std::uint8_t* mask =
      nullptr;  ///< If not null: 1 where the source was sampled, 0 where filled; out_width bytes a row.
  std::ptrdiff_t mask_stride = 0;
  double h[9] = {1, 0, 0, 0, 1,
                 0, 0, 0, 1};  ///< Row-major, output pixel to source pixel; its sign tells front from behind.
  float fill = 0.0F;
};

}  // namespace simd

namespace detail {
// A block of the output, u and v relative to its centre: source x - ox = (x[0] + u x[1] + v x[2]) / (z[0] + u z[1] + v
// z[2]).
struct WarpBlock {
  double x[3], y[3], z[3];
  int ox, oy;
  int columns, rows;
  bool dense;               // all pixels lie inside the source, clear of its borders
  bool tiles;               // and neighbours in a row lie close together
  bool leftwards, upwards;  // how they follow each other
};

// Results of the coordinate pass for one row of a block, for the pass that samples.
constexpr int kWarpBlockWidth = 128, kWarpBlockHeight = 32;
struct WarpStrip {
  float dx[kWarpBlockWidth], dy[kWarpBlockWidth];       // in the cell
  std::int32_t x[kWarpBlockWidth], y[kWarpBlockWidth];  // the cell, relative to the block's origin
  std::int32_t offset[kWarpBlockWidth];                 // the cell, in bytes from the origin
  std::int32_t inside[kWarpBlockWidth];                 // 1 or 0
  std::uint32_t taps[kWarpBlockWidth];
  float upper[2 * kWarpBlockWidth], lower[2 * kWarpBlockWidth];
};
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/warp.inl"
#include "textplane/simd/foreach_target.inl"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

/// 8-bit source, float output. Returns how many output pixels lie inside the source; -1, and nothing is written, for a
/// source below 2 x 2 or too large, or an H that is not finite.
TEXTPLANE_KERNEL int warp_u8_f32(const WarpArgs& args) noexcept TEXTPLANE_SIMD_BODY(warp_u8_f32(args));

/// 8-bit source and output, rounded to the nearest integer. Returns as warp_u8_f32().
TEXTPLANE_KERNEL int warp_u8_u8(const WarpArgs& args) noexcept TEXTPLANE_SIMD_BODY(warp_u8_u8(args));

/// Float source and output. Pixels of the source that are not finite spread to what they touch. Returns as
/// warp_u8_f32().
TEXTPLANE_KERNEL int warp_f32_f32(const WarpArgs& args) noexcept TEXTPLANE_SIMD_BODY(warp_f32_f32(args));

}  // namespace simd

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_WARP_HPP
