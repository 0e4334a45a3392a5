// Warp onto a regular output grid out of an image behind a lens: raw pointers in, raw pointers out.
// photometry/lens/warp_lens.hpp is the typed form.
//
// Output pixel (x, y) has the ray q = H (x, y, 1) of the source's camera, and gets the bilinear interpolant where that
// ray meets the image. A call is for one block of the output, of at most 128 x 32 pixels, with the lens as it is there.
#ifndef TEXTPLANE_SIMD_WARP_LENS_HPP
#define TEXTPLANE_SIMD_WARP_LENS_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/simd/lens.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

constexpr int kLensBlockWidth = 128;  ///< Of the largest block, px.
constexpr int kLensBlockHeight = 32;  ///< Likewise.

/// A block of the output. The caller guarantees: a source that is readable(), pointers not null, a block of 1 px to the
/// largest size.
struct WarpLensArgs {
  Image8 source;
  double h[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< Row-major, output pixel to ray; its sign tells front from behind.
  double camera[4] = {1, 1, 0, 0};            ///< fx, fy, cx, cy of the source.
  const LensFit* lens = nullptr;              ///< Of the block's rays.
  int x = 0, y = 0, columns = 0, rows = 0;    ///< The block.
  void* out = nullptr;                        ///< First pixel of the block; float, or std::uint8_t where `bytes`.
  std::ptrdiff_t out_stride = 0;              ///< Bytes.
  bool bytes = false;                         ///< The output is rounded to bytes.
  std::uint8_t* mask = nullptr;               ///< If not null: 1 where the source was sampled, 0 where filled.
  std::ptrdiff_t mask_stride = 0;
  float fill = 0.0F;
};

}  // namespace simd

TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/warp_lens.inl"
#include "textplane/simd/foreach_target.inl"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
TEXTPLANE_KERNEL void warp_lens_block(const simd::WarpLensArgs& args, int* inside) noexcept
    TEXTPLANE_SIMD_BODY(warp_lens_block(args, inside));
}  // namespace detail

namespace simd {

/// How many pixels of the block are inside the source; -1, and nothing is written, where float does not carry the case.
inline int warp_lens_block(const WarpLensArgs& args) noexcept {
  int inside = -1;
  detail::warp_lens_block(args, &inside);
  return inside;
}

}  // namespace simd

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_WARP_LENS_HPP
