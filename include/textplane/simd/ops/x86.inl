// What the x86 targets share, in 128 bits. Include before: ops/common.inl.

TEXTPLANE_SIMD_INLINE __m128i load128(const void* p) noexcept {
  return _mm_loadu_si128(static_cast<const __m128i*>(p));
}
TEXTPLANE_SIMD_INLINE void store128(void* p, __m128i v) noexcept { _mm_storeu_si128(static_cast<__m128i*>(p), v); }

// --- the last steps of reductions ---
TEXTPLANE_SIMD_INLINE float sum_of_four(__m128 a) noexcept {
  const __m128 two = _mm_add_ps(a, _mm_movehl_ps(a, a));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
}
TEXTPLANE_SIMD_INLINE double sum_of_two(__m128d a) noexcept {
  return _mm_cvtsd_f64(_mm_add_sd(a, _mm_unpackhi_pd(a, a)));
}
TEXTPLANE_SIMD_INLINE float min_of_four(__m128 a) noexcept {
  const __m128 two = _mm_min_ps(a, _mm_movehl_ps(a, a));
  return _mm_cvtss_f32(_mm_min_ss(two, _mm_shuffle_ps(two, two, 1)));
}
TEXTPLANE_SIMD_INLINE float max_of_four(__m128 a) noexcept {
  const __m128 two = _mm_max_ps(a, _mm_movehl_ps(a, a));
  return _mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps(two, two, 1)));
}
TEXTPLANE_SIMD_INLINE int sum_of_four(__m128i v) noexcept {
  const __m128i a = _mm_add_epi32(v, _mm_shuffle_epi32(v, 0x4e));
  return _mm_cvtsi128_si32(_mm_add_epi32(a, _mm_shuffle_epi32(a, 0xb1)));
}

// --- gathers: inserts beat the instructions and the way through general registers ---
TEXTPLANE_SIMD_INLINE std::uint64_t two_offsets(const int* offset) noexcept {
  std::uint64_t pair;
  TEXTPLANE_SIMD_COPY(&pair, offset, 8);
  return pair;
}
TEXTPLANE_SIMD_INLINE std::ptrdiff_t first_offset(std::uint64_t pair) noexcept {
  return static_cast<std::int32_t>(pair);
}
TEXTPLANE_SIMD_INLINE std::ptrdiff_t second_offset(std::uint64_t pair) noexcept {
  return static_cast<std::int64_t>(pair) >> 32;
}
TEXTPLANE_SIMD_INLINE __m128i gather_pairs8(const std::uint8_t* p, const int* offset) noexcept {
  __m128i v = _mm_cvtsi32_si128(static_cast<int>(load_u16(p + offset[0])));
  v = _mm_insert_epi16(v, static_cast<short>(load_u16(p + offset[1])), 1);
  v = _mm_insert_epi16(v, static_cast<short>(load_u16(p + offset[2])), 2);
  v = _mm_insert_epi16(v, static_cast<short>(load_u16(p + offset[3])), 3);
  v = _mm_insert_epi16(v, static_cast<short>(load_u16(p + offset[4])), 4);
  v = _mm_insert_epi16(v, static_cast<short>(load_u16(p + offset[5])), 5);
  v = _mm_insert_epi16(v, static_cast<short>(load_u16(p + offset[6])), 6);
  return _mm_insert_epi16(v, static_cast<short>(load_u16(p + offset[7])), 7);
}
TEXTPLANE_SIMD_INLINE void gather_pairs8(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset,
                                         __m128i* first, __m128i* second) noexcept {
  *first = gather_pairs8(upper, offset);
  *second = gather_pairs8(lower, offset);
}
TEXTPLANE_SIMD_INLINE __m128i gather_pairs4(const std::uint16_t* p, const int* offset) noexcept {
  const std::uint64_t a = two_offsets(offset), b = two_offsets(offset + 2);
  __m128i v = _mm_cvtsi32_si128(static_cast<int>(int16_pair(p + first_offset(a))));
  v = _mm_insert_epi32(v, static_cast<int>(int16_pair(p + second_offset(a))), 1);
  v = _mm_insert_epi32(v, static_cast<int>(int16_pair(p + first_offset(b))), 2);
  return _mm_insert_epi32(v, static_cast<int>(int16_pair(p + second_offset(b))), 3);
}
TEXTPLANE_SIMD_INLINE void fetch_four(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset,
                                      std::uint32_t* taps) noexcept {
  const std::ptrdiff_t o0 = offset[0], o1 = offset[1], o2 = offset[2], o3 = offset[3];
  __m128i v = _mm_cvtsi32_si128(static_cast<int>(load_u16(upper + o0)));
  v = _mm_insert_epi16(v, static_cast<short>(load_u16(lower + o0)), 1);
  v = _mm_insert_epi16(v, static_cast<short>(load_u16(upper + o1)), 2);
  v = _mm_insert_epi16(v, static_cast<short>(load_u16(lower + o1)), 3);
  v = _mm_insert_epi16(v, static_cast<short>(load_u16(upper + o2)), 4);
  v = _mm_insert_epi16(v, static_cast<short>(load_u16(lower + o2)), 5);
  v = _mm_insert_epi16(v, static_cast<short>(load_u16(upper + o3)), 6);
  v = _mm_insert_epi16(v, static_cast<short>(load_u16(lower + o3)), 7);
  store128(taps, v);
}
TEXTPLANE_SIMD_INLINE double sqrt_d(double a) noexcept { return _mm_cvtsd_f64(_mm_sqrt_pd(_mm_set1_pd(a))); }
TEXTPLANE_SIMD_INLINE int lowest_bit(std::uint64_t bits) noexcept { return TEXTPLANE_SIMD_LOWEST_BIT(bits); }
