// Bilinear taps of pixels that follow each other closely, for the bodies of kernels: where eight cells in a row lie in a window of
// 16 x 3 pixels, a shuffle for each row of the window replaces two loads a pixel. kernels/windows.inl says what there is.
#ifndef TEXTPLANE_SIMD_WINDOWS_HPP
#define TEXTPLANE_SIMD_WINDOWS_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/simd/words.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
// How the groups of a call run, and whether windows are worth while there.
struct TapGuess {
  bool likely, leftwards, upwards;
};

// Windows of one image. Cells are relative to `origin`; those up to (x_high, y_high) have windows in the image's rows.
struct TapWindows {
  const std::uint8_t* origin;
  std::ptrdiff_t stride;
  int x_high, y_high;
  TapGuess guess;
};
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/windows_region.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/windows.inl"
#include "textplane/simd/foreach_target.inl"

#endif  // TEXTPLANE_SIMD_WINDOWS_HPP
