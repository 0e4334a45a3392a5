// 32 int16. The operations are defined in words_scalar.inl.

enum : int { k16Lanes = 32 };
using v16 = __m512i;

TEXTPLANE_SIMD_INLINE v16 set16(int value) noexcept { return _mm512_set1_epi16(static_cast<short>(value)); }
TEXTPLANE_SIMD_INLINE v16 load16(const std::int16_t* p) noexcept { return _mm512_loadu_si512(p); }
TEXTPLANE_SIMD_INLINE void store16(std::int16_t* p, v16 v) noexcept { _mm512_storeu_si512(p, v); }
TEXTPLANE_SIMD_INLINE v16 add16(v16 x, v16 y) noexcept { return _mm512_add_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 sub16(v16 x, v16 y) noexcept { return _mm512_sub_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 mul15(v16 x, v16 y) noexcept { return _mm512_mulhrs_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 dot_pair(v16 t, int w0, int w1) noexcept {
  return _mm512_maddubs_epi16(t, _mm512_set1_epi16(static_cast<short>((w0 & 255) | (w1 * 256))));
}
TEXTPLANE_SIMD_INLINE vi add_dot16(vi sum, v16 x, v16 y) noexcept { return _mm512_dpwssd_epi32(sum, x, y); }
// Numbers of words, two a lane: (first, second) in lane 0 and (step, step) more in each lane after it.
TEXTPLANE_SIMD_INLINE __m512i word_order(int first, int second, int step) noexcept {
  return addi(muli(ioti(), seti(step * 0x00010001)), seti(second * 0x00010000 + first));
}
TEXTPLANE_SIMD_INLINE v16 low16(vi a, vi b) noexcept { return _mm512_permutex2var_epi16(a, word_order(0, 2, 4), b); }
TEXTPLANE_SIMD_INLINE v16 high16(vi a, vi b) noexcept { return _mm512_permutex2var_epi16(a, word_order(1, 3, 4), b); }
TEXTPLANE_SIMD_INLINE v16 pack16(vi low, vi high) noexcept { return low16(low, high); }
TEXTPLANE_SIMD_INLINE int hsumi(vi v) noexcept {
  const __m256i q =
      _mm256_add_epi32(_mm512_maskz_extracti64x4_epi64(0xf, v, 0), _mm512_maskz_extracti64x4_epi64(0xf, v, 1));
  const __m128i h = _mm_add_epi32(_mm256_castsi256_si128(q), _mm256_extracti128_si256(q, 1));
  const __m128i a = _mm_add_epi32(h, _mm_shuffle_epi32(h, 0x4e));
  return _mm_cvtsi128_si32(_mm_add_epi32(a, _mm_shuffle_epi32(a, 0xb1)));
}
TEXTPLANE_SIMD_INLINE v16 join_words8(const __m128i* p) noexcept {
  const __m256i a = _mm256_inserti128_si256(_mm256_castsi128_si256(p[0]), p[1], 1);
  const __m256i b = _mm256_inserti128_si256(_mm256_castsi128_si256(p[2]), p[3], 1);
  return _mm512_maskz_inserti64x4(0xff, _mm512_castsi256_si512(a), b, 1);
}
TEXTPLANE_SIMD_INLINE void gather16(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* first,
                                    v16* second) noexcept {
  __m128i u[4], l[4];
  gather_words8(upper, lower, offset, u, l);
  gather_words8(upper, lower, offset + 8, u + 1, l + 1);
  gather_words8(upper, lower, offset + 16, u + 2, l + 2);
  gather_words8(upper, lower, offset + 24, u + 3, l + 3);
  *first = join_words8(u);
  *second = join_words8(l);
}
TEXTPLANE_SIMD_INLINE vi gather_pairs(const std::uint16_t* p, const int* offset) noexcept {
  const __m256i a =
      _mm256_inserti128_si256(_mm256_castsi128_si256(gather_pairs4(p, offset)), gather_pairs4(p, offset + 4), 1);
  const __m256i b =
      _mm256_inserti128_si256(_mm256_castsi128_si256(gather_pairs4(p, offset + 8)), gather_pairs4(p, offset + 12), 1);
  return _mm512_maskz_inserti64x4(0xff, _mm512_castsi256_si512(a), b, 1);
}
TEXTPLANE_SIMD_INLINE vi widen_low16(v16 v) noexcept {
  return _mm512_maskz_cvtepi16_epi32(0xffff, _mm512_maskz_extracti64x4_epi64(0xf, v, 0));
}
TEXTPLANE_SIMD_INLINE vi widen_high16(v16 v) noexcept {
  return _mm512_maskz_cvtepi16_epi32(0xffff, _mm512_maskz_extracti64x4_epi64(0xf, v, 1));
}
