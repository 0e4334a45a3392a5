// The byte vectors of the region that includes this file (see foreach_target.inl).
#if TEXTPLANE_SIMD_REGION == 0
#include "textplane/simd/bytes_scalar.inl"
#elif TEXTPLANE_SIMD_REGION == 1
#include "textplane/simd/bytes_sse41.inl"
#elif TEXTPLANE_SIMD_REGION == 2
#include "textplane/simd/bytes_avx2.inl"
#elif TEXTPLANE_SIMD_REGION == 3
#include "textplane/simd/bytes_avx512.inl"
#elif TEXTPLANE_SIMD_REGION == 4
#include "textplane/simd/bytes_neon.inl"
#endif
