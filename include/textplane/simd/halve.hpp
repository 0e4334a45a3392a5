// Halving of 8-bit images: the step from one pyramid level to the next.
#ifndef TEXTPLANE_SIMD_HALVE_HPP
#define TEXTPLANE_SIMD_HALVE_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/simd/ops.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace simd {

/// Rows of the two images; strides in bytes.
struct HalveArgs {
  const std::uint8_t* src = nullptr;
  std::ptrdiff_t src_stride = 0;
  std::uint8_t* dst = nullptr;
  std::ptrdiff_t dst_stride = 0;
  int width = 0, height = 0;  ///< Of dst, >= 0; src has at least twice as many columns and rows.
};

}  // namespace simd
TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/halve.inl"
#include "textplane/simd/foreach_target.inl"

TEXTPLANE_BEGIN_NAMESPACE
namespace simd {

/// dst(x, y) = (a + b + c + d + 2) / 4, rounded down, over the 2 x 2 block of src that begins at (2 x, 2 y). The same
/// bytes on every target. Reads and writes those pixels alone; src and dst must not overlap. No checks, no allocation,
/// any number of threads.
TEXTPLANE_KERNEL void halve(const HalveArgs& args) noexcept TEXTPLANE_SIMD_BODY(halve(args));

}  // namespace simd
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_HALVE_HPP
