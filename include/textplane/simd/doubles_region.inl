// The vectors of double of the region that includes this file (see foreach_target.inl).
#if TEXTPLANE_SIMD_REGION == 0
#include "textplane/simd/doubles_scalar.inl"
#elif TEXTPLANE_SIMD_REGION == 1
#include "textplane/simd/doubles_sse41.inl"
#elif TEXTPLANE_SIMD_REGION == 2
#include "textplane/simd/doubles_avx2.inl"
#elif TEXTPLANE_SIMD_REGION == 3
#include "textplane/simd/doubles_avx512.inl"
#elif TEXTPLANE_SIMD_REGION == 4
#include "textplane/simd/doubles_neon.inl"
#endif
