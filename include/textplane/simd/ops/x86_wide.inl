// What avx2 and avx512 share: operations on 256 bits, and those on their own vectors that read the same. Include
// before: ops/x86.inl, and the types of the target.

TEXTPLANE_SIMD_INLINE __m256i load256(const void* p) noexcept {
  return _mm256_loadu_si256(static_cast<const __m256i*>(p));
}
TEXTPLANE_SIMD_INLINE void store256(void* p, __m256i v) noexcept { _mm256_storeu_si256(static_cast<__m256i*>(p), v); }
TEXTPLANE_SIMD_INLINE __m256i join128(__m128i low, __m128i high) noexcept {
  return _mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1);
}
TEXTPLANE_SIMD_INLINE __m256i gather_pairs8(const std::uint16_t* p, const int* offset) noexcept {
  return join128(gather_pairs4(p, offset), gather_pairs4(p, offset + 4));
}

// Steps of sums across lanes: join_lanes(), then join_pairs(), then join_halves() make of eight vectors one, of the sum
// of each.
TEXTPLANE_SIMD_INLINE __m256 join_lanes(__m256 a, __m256 b) noexcept {
  return _mm256_add_ps(_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
}
TEXTPLANE_SIMD_INLINE __m256 join_pairs(__m256 a, __m256 b) noexcept {
  return _mm256_add_ps(_mm256_shuffle_ps(a, b, 0x44), _mm256_shuffle_ps(a, b, 0xee));
}
TEXTPLANE_SIMD_INLINE __m256 join_halves(__m256 a, __m256 b) noexcept {
  return _mm256_add_ps(_mm256_permute2f128_ps(a, b, 0x20), _mm256_permute2f128_ps(a, b, 0x31));
}
TEXTPLANE_SIMD_INLINE float sum_of_eight(__m256 a) noexcept {
  return sum_of_four(_mm_add_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1)));
}
TEXTPLANE_SIMD_INLINE float min_of_eight(__m256 a) noexcept {
  return min_of_four(_mm_min_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1)));
}
TEXTPLANE_SIMD_INLINE float max_of_eight(__m256 a) noexcept {
  return max_of_four(_mm_max_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1)));
}
TEXTPLANE_SIMD_INLINE int sum_of_eight(__m256i a) noexcept {
  return sum_of_four(_mm_add_epi32(_mm256_castsi256_si128(a), _mm256_extracti128_si256(a, 1)));
}
TEXTPLANE_SIMD_INLINE double sum_of_four(__m256d a) noexcept {
  return sum_of_two(_mm_add_pd(_mm256_castpd256_pd128(a), _mm256_extractf128_pd(a, 1)));
}

#if TEXTPLANE_SIMD_HIDE_MINIMA
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept {
  __asm__("vminps %2, %1, %0" : "=v"(a) : "v"(a), "v"(b));
  return a;
}
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept {
  __asm__("vmaxps %2, %1, %0" : "=v"(a) : "v"(a), "v"(b));
  return a;
}
#endif
