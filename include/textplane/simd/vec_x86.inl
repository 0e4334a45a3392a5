// What the vectors of AVX2 and AVX-512 share, the steps of sums across lanes: join_lanes(), then join_pairs(), then join_halves()
// make of eight vectors one, of the sum of each.

// vhaddps takes twice the time of its two shuffles and one sum.
TEXTPLANE_SIMD_INLINE __m256 join_lanes(__m256 a, __m256 b) noexcept {
  return _mm256_add_ps(_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
}
TEXTPLANE_SIMD_INLINE __m256 join_pairs(__m256 a, __m256 b) noexcept {
  return _mm256_add_ps(_mm256_shuffle_ps(a, b, 0x44), _mm256_shuffle_ps(a, b, 0xee));
}
TEXTPLANE_SIMD_INLINE __m256 join_halves(__m256 a, __m256 b) noexcept {
  return _mm256_add_ps(_mm256_permute2f128_ps(a, b, 0x20), _mm256_permute2f128_ps(a, b, 0x31));
}
