// Vectors of bytes and of int16 for the bodies of integer kernels: `vb` with kBytes lanes, `vh` with kShorts lanes and
// the int32 sums `vw`, in every target namespace.
//
// The operations and their meaning are defined once, in plain C++, in bytes_scalar.inl; the other bytes_*.inl files say
// the same in intrinsics. All of them are exact: whatever is built of them gives the same result on every target.
#ifndef TEXTPLANE_SIMD_BYTES_HPP
#define TEXTPLANE_SIMD_BYTES_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/simd/dispatch.hpp"
#include "textplane/simd/targets.hpp"

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/bytes_region.inl"
#include "textplane/simd/foreach_target.inl"

#endif  // TEXTPLANE_SIMD_BYTES_HPP
