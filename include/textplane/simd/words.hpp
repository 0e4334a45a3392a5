// Vectors of int16 for the bodies of kernels: `v16` with `k16Lanes` = 2 kLanes lanes in every target namespace, beside the vf and
// vi of vec.hpp. Fixed-point interpolation and exact integer sums are made of them: their results are the same bits on all
// targets. words_scalar.inl is the definition of the operations.
#ifndef TEXTPLANE_SIMD_WORDS_HPP
#define TEXTPLANE_SIMD_WORDS_HPP

#include "textplane/simd/vec.hpp"

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/words_region.inl"
#include "textplane/simd/foreach_target.inl"

#endif  // TEXTPLANE_SIMD_WORDS_HPP
