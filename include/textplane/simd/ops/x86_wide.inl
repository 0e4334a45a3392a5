// What avx2 and avx512 share, in 256 bits. Include before: ops/common.inl.

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

// --- int16 beside bytes ---
constexpr int kShorts = 16;
constexpr int kPairsReach = 24;
using vh = __m256i;

TEXTPLANE_SIMD_INLINE vh seth(int value) noexcept { return _mm256_set1_epi16(static_cast<short>(value)); }
TEXTPLANE_SIMD_INLINE vh loadh(const std::int16_t* p) noexcept {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
}
TEXTPLANE_SIMD_INLINE void storeh(std::int16_t* p, vh a) noexcept {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), a);
}
TEXTPLANE_SIMD_INLINE vh addh(vh a, vh b) noexcept { return _mm256_add_epi16(a, b); }
TEXTPLANE_SIMD_INLINE vh subh(vh a, vh b) noexcept { return _mm256_sub_epi16(a, b); }
TEXTPLANE_SIMD_INLINE vh andh(vh a, vh b) noexcept { return _mm256_and_si256(a, b); }
TEXTPLANE_SIMD_INLINE vh halfh(vh a) noexcept { return _mm256_srai_epi16(a, 1); }
TEXTPLANE_SIMD_INLINE vh mulhrsh(vh a, vh b) noexcept { return _mm256_mulhrs_epi16(a, b); }
TEXTPLANE_SIMD_INLINE vh firsth(int n) noexcept {
  const int limit = n < 0 ? 0 : (n < kShorts ? n : kShorts);
  const __m256i lane = _mm256_setr_epi16(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  return _mm256_cmpgt_epi16(seth(limit), lane);
}
TEXTPLANE_SIMD_INLINE vh pair_weights(int w0, int w1) noexcept { return seth(w0 | (w1 << 8)); }
TEXTPLANE_SIMD_INLINE vh mix_pairs(const std::uint8_t* p, vh weights) noexcept {
  const __m128i* groups = reinterpret_cast<const __m128i*>(p);
  const __m128i* later = reinterpret_cast<const __m128i*>(p + 8);
  const __m256i bytes =
      _mm256_inserti128_si256(_mm256_castsi128_si256(_mm_loadu_si128(groups)), _mm_loadu_si128(later), 1);
  const __m256i neighbours = _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8));
  const __m256i centred = _mm256_xor_si256(bytes, _mm256_set1_epi8(-128));
  return _mm256_maddubs_epi16(weights, _mm256_shuffle_epi8(centred, neighbours));
}

TEXTPLANE_SIMD_INLINE vh grey_to_fixed(const float* p) noexcept {
  const __m256 scale = _mm256_set1_ps(32.0f), half = _mm256_set1_ps(0.5f);
  const __m256i low = _mm256_cvttps_epi32(_mm256_add_ps(_mm256_mul_ps(_mm256_loadu_ps(p), scale), half));
  const __m256i high = _mm256_cvttps_epi32(_mm256_add_ps(_mm256_mul_ps(_mm256_loadu_ps(p + 8), scale), half));
  return _mm256_sub_epi16(_mm256_permute4x64_epi64(_mm256_packs_epi32(low, high), 0xD8), seth(4096));
}

using vw = __m256i;

TEXTPLANE_SIMD_INLINE vw zerow() noexcept { return _mm256_setzero_si256(); }
TEXTPLANE_SIMD_INLINE double sumw(vw a) noexcept {
  const __m256d four =
      _mm256_add_pd(_mm256_cvtepi32_pd(_mm256_castsi256_si128(a)), _mm256_cvtepi32_pd(_mm256_extracti128_si256(a, 1)));
  const __m128d two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
  return _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)));
}
