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

// Four words of taps, of two bytes of the upper row and, above them, two of the lower.
#if TEXTPLANE_SIMD_REGION >= 1 && TEXTPLANE_SIMD_REGION <= 3
TEXTPLANE_SIMD_INLINE void fetch_four(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset,
                                      std::uint32_t* taps) noexcept {
  const std::ptrdiff_t o0 = offset[0], o1 = offset[1], o2 = offset[2], o3 = offset[3];
  __m128i v = _mm_cvtsi32_si128(static_cast<int>(load_half(upper + o0)));
  v = _mm_insert_epi16(v, static_cast<short>(load_half(lower + o0)), 1);
  v = _mm_insert_epi16(v, static_cast<short>(load_half(upper + o1)), 2);
  v = _mm_insert_epi16(v, static_cast<short>(load_half(lower + o1)), 3);
  v = _mm_insert_epi16(v, static_cast<short>(load_half(upper + o2)), 4);
  v = _mm_insert_epi16(v, static_cast<short>(load_half(lower + o2)), 5);
  v = _mm_insert_epi16(v, static_cast<short>(load_half(upper + o3)), 6);
  v = _mm_insert_epi16(v, static_cast<short>(load_half(lower + o3)), 7);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(taps), v);
}
#else
TEXTPLANE_SIMD_INLINE void fetch_four(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset,
                                      std::uint32_t* taps) noexcept {
  const std::ptrdiff_t o0 = offset[0], o1 = offset[1], o2 = offset[2], o3 = offset[3];
  taps[0] = load_half(upper + o0) | load_half(lower + o0) << 16;
  taps[1] = load_half(upper + o1) | load_half(lower + o1) << 16;
  taps[2] = load_half(upper + o2) | load_half(lower + o2) << 16;
  taps[3] = load_half(upper + o3) | load_half(lower + o3) << 16;
}
#endif

#if TEXTPLANE_SIMD_REGION == 0
#include "textplane/simd/vec_scalar.inl"
#elif TEXTPLANE_SIMD_REGION == 1
#include "textplane/simd/vec_sse41.inl"
#elif TEXTPLANE_SIMD_REGION == 2
#include "textplane/simd/vec_avx2.inl"
#elif TEXTPLANE_SIMD_REGION == 3
#include "textplane/simd/vec_avx512.inl"
#elif TEXTPLANE_SIMD_REGION == 4
#include "textplane/simd/vec_neon.inl"
#endif
