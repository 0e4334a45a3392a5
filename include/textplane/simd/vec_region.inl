// The vectors of the region that includes this file (see foreach_target.inl), after what they share.

// Two and four bytes as a number, the first byte lowest. Compilers make one load of it.
TEXTPLANE_SIMD_INLINE unsigned load_half(const std::uint8_t* p) noexcept {
  return static_cast<unsigned>(p[0]) | static_cast<unsigned>(p[1]) << 8;
}
TEXTPLANE_SIMD_INLINE unsigned load_word(const std::uint8_t* p) noexcept {
  return static_cast<unsigned>(p[0]) | static_cast<unsigned>(p[1]) << 8 | static_cast<unsigned>(p[2]) << 16 |
         static_cast<unsigned>(p[3]) << 24;
}
// The first n of four bytes, zeros above; 0 <= n <= 4. Bytes from n on are not touched.
TEXTPLANE_SIMD_INLINE unsigned load_word_n(const std::uint8_t* p, int n) noexcept {
  unsigned word = 0;
  if (n >= 1) word = p[0];
  if (n >= 2) word |= static_cast<unsigned>(p[1]) << 8;
  if (n >= 3) word |= static_cast<unsigned>(p[2]) << 16;
  if (n >= 4) word |= static_cast<unsigned>(p[3]) << 24;
  return word;
}
// n >= 0 bytes; the two do not overlap.
TEXTPLANE_SIMD_INLINE void copy_bytes(void* to, const void* from, int n) noexcept {
  std::uint8_t* TEXTPLANE_SIMD_RESTRICT target = static_cast<std::uint8_t*>(to);
  const std::uint8_t* TEXTPLANE_SIMD_RESTRICT source = static_cast<const std::uint8_t*>(from);
  for (int i = 0; i < n; ++i) target[i] = source[i];
}

#if TEXTPLANE_SIMD_REGION == 0
#include "textplane/simd/taps_plain.inl"
#include "textplane/simd/vec_scalar.inl"
#elif TEXTPLANE_SIMD_REGION == 1
#include "textplane/simd/taps_x86.inl"
#include "textplane/simd/vec_sse41.inl"
#elif TEXTPLANE_SIMD_REGION == 2
#include "textplane/simd/taps_x86.inl"
#include "textplane/simd/vec_x86.inl"
#include "textplane/simd/vec_avx2.inl"
#elif TEXTPLANE_SIMD_REGION == 3
#include "textplane/simd/taps_x86.inl"
#include "textplane/simd/vec_x86.inl"
#include "textplane/simd/vec_avx512.inl"
#elif TEXTPLANE_SIMD_REGION == 4
#include "textplane/simd/taps_plain.inl"
#include "textplane/simd/vec_neon.inl"
#endif
