// Vectors for the bodies of kernels, in every target namespace, and the operations on them:
//
//   vf, vi, vm  kLanes floats, int32 and truth values
//   v16         k16Lanes = 2 kLanes int16, for fixed-point interpolation and exact integer sums
//   vw          sums of products of int16
//   vb          kBytes bytes: integer kernels, exact on every target
//   vp, vd      kDoubles doubles; 8 doubles
//   taps_t      the four pixels around each of kLanes positions
//
// Tiles: bilinear taps of pixels that follow each other closely. Eight cells in a row that lie in a tile of 16 x 3
// pixels take one shuffle for each of its rows in place of two loads a pixel (kernels/tiles.inl).
//
// ops/scalar.inl defines each operation in plain C++; the files of the other targets say the same in intrinsics.
// ops/derived.inl has those that read the same on all of them. Only kernels use them: a vector type never crosses the
// border of a region.
#ifndef TEXTPLANE_SIMD_OPS_HPP
#define TEXTPLANE_SIMD_OPS_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/simd/dispatch.hpp"
#include "textplane/simd/targets.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
// The direction in which the groups of a call run, and whether tiles are likely to hold them.
struct TileGuess {
  bool likely, leftwards, upwards;
};

// Tiles of one image. Cells are relative to `origin`; up to (x_high, y_high) their tiles lie in the image's rows.
struct ImageTiles {
  const std::uint8_t* origin;
  std::ptrdiff_t stride;
  int x_high, y_high;
  TileGuess guess;
};
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/ops/region.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/tiles.inl"
#include "textplane/simd/foreach_target.inl"

#endif  // TEXTPLANE_SIMD_OPS_HPP
