// Vectors of 64 bytes and of 16 int16: AVX-512 BW, VL and VNNI. The operations are defined in bytes_scalar.inl.
//
// int16 stay at 256 bits: the rows of the patches that they serve are no longer.

constexpr int kBytes = 64;
using vb = __m512i;

TEXTPLANE_SIMD_INLINE vb setb(int value) noexcept { return _mm512_set1_epi8(static_cast<char>(value)); }
TEXTPLANE_SIMD_INLINE vb loadb(const std::uint8_t* p) noexcept { return _mm512_loadu_si512(p); }
TEXTPLANE_SIMD_INLINE void storeb(std::uint8_t* p, vb a) noexcept { _mm512_storeu_si512(p, a); }
TEXTPLANE_SIMD_INLINE __mmask64 firstb(int n) noexcept { return n < 64 ? (1ULL << n) - 1 : ~0ULL; }  // 0 <= n
TEXTPLANE_SIMD_INLINE vb loadb_n(const std::uint8_t* p, int n) noexcept {
  return _mm512_maskz_loadu_epi8(firstb(n), p);
}
TEXTPLANE_SIMD_INLINE void storeb_n(std::uint8_t* p, vb a, int n) noexcept { _mm512_mask_storeu_epi8(p, firstb(n), a); }

TEXTPLANE_SIMD_INLINE vb addsb(vb a, vb b) noexcept { return _mm512_adds_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb subsb(vb a, vb b) noexcept { return _mm512_subs_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb minb(vb a, vb b) noexcept { return _mm512_min_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb maxb(vb a, vb b) noexcept { return _mm512_max_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb andb(vb a, vb b) noexcept { return _mm512_and_si512(a, b); }
TEXTPLANE_SIMD_INLINE vb orb(vb a, vb b) noexcept { return _mm512_or_si512(a, b); }
TEXTPLANE_SIMD_INLINE vb xorb(vb a, vb b) noexcept { return _mm512_xor_si512(a, b); }
TEXTPLANE_SIMD_INLINE vb mean4b(vb upper0, vb upper1, vb lower0, vb lower1) noexcept {
  const __m512i one = _mm512_set1_epi8(1), two = _mm512_set1_epi16(2);
  const __m512i sum0 = _mm512_add_epi16(_mm512_maddubs_epi16(upper0, one), _mm512_maddubs_epi16(lower0, one));
  const __m512i sum1 = _mm512_add_epi16(_mm512_maddubs_epi16(upper1, one), _mm512_maddubs_epi16(lower1, one));
  // Packing works within the quarters of a register.
  const __m512i packed = _mm512_packus_epi16(_mm512_srli_epi16(_mm512_add_epi16(sum0, two), 2),
                                             _mm512_srli_epi16(_mm512_add_epi16(sum1, two), 2));
  return _mm512_maskz_permutexvar_epi64(255, _mm512_setr_epi64(0, 2, 4, 6, 1, 3, 5, 7), packed);
}

TEXTPLANE_SIMD_INLINE vb geb(vb a, vb b) noexcept { return _mm512_movm_epi8(_mm512_cmpge_epu8_mask(a, b)); }
TEXTPLANE_SIMD_INLINE bool anyb(vb a) noexcept { return _mm512_test_epi8_mask(a, a) != 0; }
TEXTPLANE_SIMD_INLINE std::uint64_t bitsb(vb mask) noexcept { return _mm512_movepi8_mask(mask); }
TEXTPLANE_SIMD_INLINE int lowest_lane(std::uint64_t bits) noexcept { return __builtin_ctzll(bits); }

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
  const __m128i* words = reinterpret_cast<const __m128i*>(p);
  const __m128i* later = reinterpret_cast<const __m128i*>(p + 8);
  const __m256i bytes =
      _mm256_inserti128_si256(_mm256_castsi128_si256(_mm_loadu_si128(words)), _mm_loadu_si128(later), 1);
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
TEXTPLANE_SIMD_INLINE vw dotw(vw sum, vh a, vh b) noexcept { return _mm256_dpwssd_epi32(sum, a, b); }
TEXTPLANE_SIMD_INLINE double sumw(vw a) noexcept {
  const __m256d four =
      _mm256_add_pd(_mm256_cvtepi32_pd(_mm256_castsi256_si128(a)), _mm256_cvtepi32_pd(_mm256_extracti128_si256(a, 1)));
  const __m128d two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
  return _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)));
}
