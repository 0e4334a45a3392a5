// The operations of windows on sixteen words. They are defined in windows_region.inl.

enum : int { kTapWindows = 1 };
TEXTPLANE_SIMD_INLINE v16 load_cells(const std::int16_t* p) noexcept { return load16(p); }
TEXTPLANE_SIMD_INLINE v16 group_ends(bool last) noexcept { return set16(last ? 0x0f0e : 0x0100); }
TEXTPLANE_SIMD_INLINE v16 share16(v16 v, v16 ends) noexcept { return _mm256_shuffle_epi8(v, ends); }
TEXTPLANE_SIMD_INLINE v16 above16(v16 v, int n) noexcept { return _mm256_subs_epu16(v, set16(n)); }
TEXTPLANE_SIMD_INLINE v16 picks16(v16 x) noexcept {
  return _mm256_add_epi16(_mm256_or_si256(x, _mm256_slli_epi16(x, 8)), set16(0x0100));
}
TEXTPLANE_SIMD_INLINE v16 pick16(v16 row, v16 picks) noexcept { return _mm256_shuffle_epi8(row, picks); }
struct TapPlaces {
  std::ptrdiff_t a, b;
};
TEXTPLANE_SIMD_INLINE TapPlaces find_windows(const std::int16_t* x, const std::int16_t* y,
                                             std::ptrdiff_t stride) noexcept {
  return TapPlaces{y[0] * stride + x[0], y[8] * stride + x[8]};
}
TEXTPLANE_SIMD_INLINE v16 load_rows(const std::uint8_t* p, const TapPlaces& at) noexcept {
  return _mm256_inserti128_si256(_mm256_castsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p + at.a))),
                                 _mm_loadu_si128(reinterpret_cast<const __m128i*>(p + at.b)), 1);
}
TEXTPLANE_SIMD_INLINE v16 either16(v16 y, v16 a, v16 b) noexcept {
  return _mm256_blendv_epi8(a, b, _mm256_sub_epi16(_mm256_setzero_si256(), y));
}
TEXTPLANE_SIMD_INLINE v16 below16(v16 v, v16 high) noexcept { return _mm256_min_epu16(v, high); }
TEXTPLANE_SIMD_INLINE v16 or16(v16 a, v16 b) noexcept { return _mm256_or_si256(a, b); }
TEXTPLANE_SIMD_INLINE unsigned any_of_four(v16 v) noexcept {
  const __m256i none = _mm256_cmpeq_epi64(v, _mm256_setzero_si256());
  return static_cast<unsigned>(_mm256_movemask_pd(_mm256_castsi256_pd(none))) ^ 15U;
}
TEXTPLANE_SIMD_INLINE v16 load_group(const std::int16_t* p) noexcept {
  return _mm256_castsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
}
TEXTPLANE_SIMD_INLINE void store_group(std::int16_t* p, v16 v) noexcept {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm256_castsi256_si128(v));
}
TEXTPLANE_SIMD_INLINE void fetch_group(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* a,
                                       v16* b) noexcept {
  __m128i u, l;
  gather_words8(upper, lower, offset, &u, &l);
  *a = _mm256_castsi128_si256(u);
  *b = _mm256_castsi128_si256(l);
}
TEXTPLANE_SIMD_INLINE void store_taps(std::uint32_t* p, v16 a, v16 b) noexcept {
  const __m256i low = _mm256_unpacklo_epi16(a, b), high = _mm256_unpackhi_epi16(a, b);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm256_permute2x128_si256(low, high, 0x20));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p + 8), _mm256_permute2x128_si256(low, high, 0x31));
}
