// Vectors of 16 bytes and of 8 int16: SSE4.1. The operations are defined in bytes_scalar.inl.

constexpr int kBytes = 16;
using vb = __m128i;

TEXTPLANE_SIMD_INLINE vb setb(int value) noexcept { return _mm_set1_epi8(static_cast<char>(value)); }
TEXTPLANE_SIMD_INLINE vb loadb(const std::uint8_t* p) noexcept {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p));
}
TEXTPLANE_SIMD_INLINE void storeb(std::uint8_t* p, vb a) noexcept {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(p), a);
}
TEXTPLANE_SIMD_INLINE vb loadb_n(const std::uint8_t* p, int n) noexcept {
  std::uint8_t bytes[16] = {0};
  for (int i = 0; i < n; ++i) bytes[i] = p[i];
  return loadb(bytes);
}
TEXTPLANE_SIMD_INLINE void storeb_n(std::uint8_t* p, vb a, int n) noexcept {
  std::uint8_t bytes[16];
  storeb(bytes, a);
  for (int i = 0; i < n; ++i) p[i] = bytes[i];
}

TEXTPLANE_SIMD_INLINE vb addsb(vb a, vb b) noexcept { return _mm_adds_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb subsb(vb a, vb b) noexcept { return _mm_subs_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb minb(vb a, vb b) noexcept { return _mm_min_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb maxb(vb a, vb b) noexcept { return _mm_max_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb andb(vb a, vb b) noexcept { return _mm_and_si128(a, b); }
TEXTPLANE_SIMD_INLINE vb orb(vb a, vb b) noexcept { return _mm_or_si128(a, b); }
TEXTPLANE_SIMD_INLINE vb xorb(vb a, vb b) noexcept { return _mm_xor_si128(a, b); }
TEXTPLANE_SIMD_INLINE vb mean4b(vb upper0, vb upper1, vb lower0, vb lower1) noexcept {
  const __m128i one = _mm_set1_epi8(1), two = _mm_set1_epi16(2);
  const __m128i sum0 = _mm_add_epi16(_mm_maddubs_epi16(upper0, one), _mm_maddubs_epi16(lower0, one));
  const __m128i sum1 = _mm_add_epi16(_mm_maddubs_epi16(upper1, one), _mm_maddubs_epi16(lower1, one));
  return _mm_packus_epi16(_mm_srli_epi16(_mm_add_epi16(sum0, two), 2), _mm_srli_epi16(_mm_add_epi16(sum1, two), 2));
}

TEXTPLANE_SIMD_INLINE vb geb(vb a, vb b) noexcept { return _mm_cmpeq_epi8(_mm_max_epu8(a, b), a); }
TEXTPLANE_SIMD_INLINE bool anyb(vb a) noexcept { return _mm_testz_si128(a, a) == 0; }
TEXTPLANE_SIMD_INLINE std::uint64_t bitsb(vb mask) noexcept {
  return static_cast<std::uint32_t>(_mm_movemask_epi8(mask));
}
TEXTPLANE_SIMD_INLINE int lowest_lane(std::uint64_t bits) noexcept { return __builtin_ctzll(bits); }

constexpr int kShorts = 8;
constexpr int kPairsReach = 16;
using vh = __m128i;

TEXTPLANE_SIMD_INLINE vh seth(int value) noexcept { return _mm_set1_epi16(static_cast<short>(value)); }
TEXTPLANE_SIMD_INLINE vh loadh(const std::int16_t* p) noexcept {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p));
}
TEXTPLANE_SIMD_INLINE void storeh(std::int16_t* p, vh a) noexcept {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(p), a);
}
TEXTPLANE_SIMD_INLINE vh addh(vh a, vh b) noexcept { return _mm_add_epi16(a, b); }
TEXTPLANE_SIMD_INLINE vh subh(vh a, vh b) noexcept { return _mm_sub_epi16(a, b); }
TEXTPLANE_SIMD_INLINE vh andh(vh a, vh b) noexcept { return _mm_and_si128(a, b); }
TEXTPLANE_SIMD_INLINE vh halfh(vh a) noexcept { return _mm_srai_epi16(a, 1); }
TEXTPLANE_SIMD_INLINE vh mulhrsh(vh a, vh b) noexcept { return _mm_mulhrs_epi16(a, b); }
TEXTPLANE_SIMD_INLINE vh firsth(int n) noexcept {
  const int limit = n < 0 ? 0 : (n < kShorts ? n : kShorts);
  return _mm_cmplt_epi16(_mm_setr_epi16(0, 1, 2, 3, 4, 5, 6, 7), seth(limit));
}
TEXTPLANE_SIMD_INLINE vh pair_weights(int w0, int w1) noexcept { return seth(w0 | (w1 << 8)); }
TEXTPLANE_SIMD_INLINE vh mix_pairs(const std::uint8_t* p, vh weights) noexcept {
  const __m128i neighbours = _mm_setr_epi8(0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8);
  const __m128i centred = _mm_xor_si128(loadb(p), _mm_set1_epi8(-128));
  return _mm_maddubs_epi16(weights, _mm_shuffle_epi8(centred, neighbours));
}

TEXTPLANE_SIMD_INLINE vh grey_to_fixed(const float* p) noexcept {
  const __m128 scale = _mm_set1_ps(32.0f), half = _mm_set1_ps(0.5f);
  const __m128i low = _mm_cvttps_epi32(_mm_add_ps(_mm_mul_ps(_mm_loadu_ps(p), scale), half));
  const __m128i high = _mm_cvttps_epi32(_mm_add_ps(_mm_mul_ps(_mm_loadu_ps(p + 4), scale), half));
  return _mm_sub_epi16(_mm_packs_epi32(low, high), seth(4096));
}

using vw = __m128i;

TEXTPLANE_SIMD_INLINE vw zerow() noexcept { return _mm_setzero_si128(); }
TEXTPLANE_SIMD_INLINE vw dotw(vw sum, vh a, vh b) noexcept { return _mm_add_epi32(sum, _mm_madd_epi16(a, b)); }
TEXTPLANE_SIMD_INLINE double sumw(vw a) noexcept {
  const __m128d pairs = _mm_add_pd(_mm_cvtepi32_pd(a), _mm_cvtepi32_pd(_mm_unpackhi_epi64(a, a)));
  return _mm_cvtsd_f64(_mm_add_sd(pairs, _mm_unpackhi_pd(pairs, pairs)));
}
