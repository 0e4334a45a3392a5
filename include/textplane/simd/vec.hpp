// Vectors of float and int32 for the bodies of kernels: `vf`, `vi` and `vm` with `kLanes` lanes in every target namespace.
//
// The operations and their meaning are defined once, in plain C++, in vec_scalar.inl; the other vec_*.inl files say the
// same in intrinsics. Only the files in simd/kernels use them: a vector type never crosses the border of a region.
#ifndef TEXTPLANE_SIMD_VEC_HPP
#define TEXTPLANE_SIMD_VEC_HPP

#include <cstdint>

#include "textplane/simd/dispatch.hpp"
#include "textplane/simd/targets.hpp"

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/vec_region.inl"
#include "textplane/simd/foreach_target.inl"

#endif  // TEXTPLANE_SIMD_VEC_HPP
