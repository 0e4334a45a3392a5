// The int16 vectors of the region that includes this file (see foreach_target.inl), after what they share.

// Two words as a number, the first one low. Compilers make one load of it.
TEXTPLANE_SIMD_INLINE unsigned word_pair(const std::uint16_t* p) noexcept {
  return static_cast<unsigned>(p[0]) | static_cast<unsigned>(p[1]) << 16;
}
// Zeroes the words from..to-1, fewer than 32.
TEXTPLANE_SIMD_INLINE void zero16(std::int16_t* p, int from, int to) noexcept {
  volatile std::int16_t* out = p;  // compilers would call memset, of whose instruction set nothing is known
  for (int i = from; i < to; ++i) out[i] = 0;
}

#if TEXTPLANE_SIMD_REGION == 0
#include "textplane/simd/words_scalar.inl"
#elif TEXTPLANE_SIMD_REGION == 1
#include "textplane/simd/words_x86.inl"
#include "textplane/simd/words_sse41.inl"
#elif TEXTPLANE_SIMD_REGION == 2
#include "textplane/simd/words_x86.inl"
#include "textplane/simd/words_avx2.inl"
#elif TEXTPLANE_SIMD_REGION == 3
#include "textplane/simd/words_x86.inl"
#include "textplane/simd/words_avx512.inl"
#elif TEXTPLANE_SIMD_REGION == 4
#include "textplane/simd/words_neon.inl"
#endif
