// The operations of windows on 32 words. They are defined in windows_region.inl.

enum : int { kTapWindows = 1 };
TEXTPLANE_SIMD_INLINE v16 load_cells(const std::int16_t* p) noexcept {
  v16 v = load16(p);
#if !defined(TEXTPLANE_EMULATED_AVX512)
  __asm__("" : "+v"(v));
#endif
  return v;
}
TEXTPLANE_SIMD_INLINE v16 group_ends(bool last) noexcept { return set16(last ? 0x0f0e : 0x0100); }
TEXTPLANE_SIMD_INLINE v16 share16(v16 v, v16 ends) noexcept { return _mm512_shuffle_epi8(v, ends); }
TEXTPLANE_SIMD_INLINE v16 above16(v16 v, int n) noexcept { return _mm512_subs_epu16(v, set16(n)); }
TEXTPLANE_SIMD_INLINE v16 picks16(v16 x) noexcept {
  return _mm512_add_epi16(_mm512_mullo_epi16(x, set16(0x0101)), set16(0x0100));
}
TEXTPLANE_SIMD_INLINE v16 pick16(v16 row, v16 picks) noexcept { return _mm512_shuffle_epi8(row, picks); }
TEXTPLANE_SIMD_INLINE __m128i window_row16(const std::uint8_t* p) noexcept {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p));
}
struct TapPlaces {
  std::ptrdiff_t a, b, c, d;
};
TEXTPLANE_SIMD_INLINE TapPlaces find_windows(const std::int16_t* x, const std::int16_t* y,
                                             std::ptrdiff_t stride) noexcept {
  return TapPlaces{y[0] * stride + x[0], y[8] * stride + x[8], y[16] * stride + x[16], y[24] * stride + x[24]};
}
TEXTPLANE_SIMD_INLINE v16 load_rows(const std::uint8_t* p, const TapPlaces& at) noexcept {
  const __m256i ab = _mm256_inserti128_si256(_mm256_castsi128_si256(window_row16(p + at.a)), window_row16(p + at.b), 1);
  const __m256i cd = _mm256_inserti128_si256(_mm256_castsi128_si256(window_row16(p + at.c)), window_row16(p + at.d), 1);
  return _mm512_maskz_inserti64x4(0xff, _mm512_castsi256_si512(ab), cd, 1);
}
TEXTPLANE_SIMD_INLINE v16 either16(v16 y, v16 a, v16 b) noexcept {
  return _mm512_mask_blend_epi16(_mm512_test_epi16_mask(y, y), a, b);
}
TEXTPLANE_SIMD_INLINE v16 below16(v16 v, v16 high) noexcept { return _mm512_min_epu16(v, high); }
TEXTPLANE_SIMD_INLINE v16 or16(v16 a, v16 b) noexcept { return _mm512_or_si512(a, b); }
TEXTPLANE_SIMD_INLINE unsigned any_of_four(v16 v) noexcept { return _mm512_test_epi64_mask(v, v); }
TEXTPLANE_SIMD_INLINE v16 load_group(const std::int16_t* p) noexcept {
  return _mm512_castsi128_si512(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
}
TEXTPLANE_SIMD_INLINE void store_group(std::int16_t* p, v16 v) noexcept {
  const __m256i low = _mm512_maskz_extracti64x4_epi64(0xf, v, 0);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm256_castsi256_si128(low));
}
TEXTPLANE_SIMD_INLINE void fetch_group(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* a,
                                       v16* b) noexcept {
  __m128i u, l;
  gather_words8(upper, lower, offset, &u, &l);
  *a = _mm512_castsi128_si512(u);
  *b = _mm512_castsi128_si512(l);
}
TEXTPLANE_SIMD_INLINE void store_taps(std::uint32_t* p, v16 a, v16 b) noexcept {
  _mm512_storeu_si512(p, _mm512_permutex2var_epi16(a, word_order(0, 32, 1), b));
  _mm512_storeu_si512(p + 16, _mm512_permutex2var_epi16(a, word_order(16, 48, 1), b));
}
