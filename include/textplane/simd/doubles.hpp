// Vectors of double for the bodies of kernels: `vp` with `kDoubles` lanes in every target namespace. Geometry of many objects at
// once is done in them. doubles_scalar.inl is the definition of the operations.
#ifndef TEXTPLANE_SIMD_DOUBLES_HPP
#define TEXTPLANE_SIMD_DOUBLES_HPP

#include "textplane/simd/vec.hpp"

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/doubles_region.inl"
#include "textplane/simd/foreach_target.inl"

#endif  // TEXTPLANE_SIMD_DOUBLES_HPP
