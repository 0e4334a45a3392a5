// The robust costs of core/robust.hpp as vectors.
#ifndef TEXTPLANE_SIMD_ROBUST_HPP
#define TEXTPLANE_SIMD_ROBUST_HPP

#include "textplane/core/robust.hpp"
#include "textplane/simd/ops.hpp"

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/robust.inl"
#include "textplane/simd/foreach_target.inl"

#endif  // TEXTPLANE_SIMD_ROBUST_HPP
