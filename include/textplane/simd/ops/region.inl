// The operations of one region: see ops.hpp.
// clang-format off
#define TEXTPLANE_SIMD_OPS TEXTPLANE_SIMD_TEXT(textplane/simd/ops/TEXTPLANE_SIMD_REGION.inl)
// clang-format on
#include "textplane/simd/ops/common.inl"
#include TEXTPLANE_SIMD_OPS
#include "textplane/simd/ops/derived.inl"
#undef TEXTPLANE_SIMD_OPS
