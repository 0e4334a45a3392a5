// Sixteen int16. The operations are defined in words_scalar.inl.

enum : int { k16Lanes = 16 };
using v16 = __m256i;

TEXTPLANE_SIMD_INLINE v16 set16(int value) noexcept { return _mm256_set1_epi16(static_cast<short>(value)); }
TEXTPLANE_SIMD_INLINE v16 load16(const std::int16_t* p) noexcept {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
}
TEXTPLANE_SIMD_INLINE void store16(std::int16_t* p, v16 v) noexcept {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), v);
}
TEXTPLANE_SIMD_INLINE v16 add16(v16 x, v16 y) noexcept { return _mm256_add_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 sub16(v16 x, v16 y) noexcept { return _mm256_sub_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 mul15(v16 x, v16 y) noexcept { return _mm256_mulhrs_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 dot_pair(v16 t, int w0, int w1) noexcept {
  return _mm256_maddubs_epi16(t, _mm256_set1_epi16(static_cast<short>((w0 & 255) | (w1 * 256))));
}
TEXTPLANE_SIMD_INLINE vi add_dot16(vi sum, v16 x, v16 y) noexcept { return addi(sum, _mm256_madd_epi16(x, y)); }
TEXTPLANE_SIMD_INLINE v16 pack16(vi low, vi high) noexcept {
  return _mm256_permute4x64_epi64(_mm256_packs_epi32(low, high), 0xd8);
}
TEXTPLANE_SIMD_INLINE int hsumi(vi v) noexcept {
  const __m128i h = _mm_add_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
  const __m128i a = _mm_add_epi32(h, _mm_shuffle_epi32(h, 0x4e));
  return _mm_cvtsi128_si32(_mm_add_epi32(a, _mm_shuffle_epi32(a, 0xb1)));
}
TEXTPLANE_SIMD_INLINE void gather16(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* first,
                                    v16* second) noexcept {
  __m128i u0, l0, u1, l1;
  gather_words8(upper, lower, offset, &u0, &l0);
  gather_words8(upper, lower, offset + 8, &u1, &l1);
  *first = _mm256_inserti128_si256(_mm256_castsi128_si256(u0), u1, 1);
  *second = _mm256_inserti128_si256(_mm256_castsi128_si256(l0), l1, 1);
}
TEXTPLANE_SIMD_INLINE vi gather_pairs(const std::uint16_t* p, const int* offset) noexcept {
  return _mm256_inserti128_si256(_mm256_castsi128_si256(gather_pairs4(p, offset)), gather_pairs4(p, offset + 4), 1);
}
TEXTPLANE_SIMD_INLINE v16 low16(vi a, vi b) noexcept {
  const __m256i low = _mm256_set1_epi32(65535);
  return _mm256_permute4x64_epi64(_mm256_packus_epi32(_mm256_and_si256(a, low), _mm256_and_si256(b, low)), 0xd8);
}
TEXTPLANE_SIMD_INLINE v16 high16(vi a, vi b) noexcept {
  return _mm256_permute4x64_epi64(_mm256_packs_epi32(_mm256_srai_epi32(a, 16), _mm256_srai_epi32(b, 16)), 0xd8);
}
TEXTPLANE_SIMD_INLINE vi widen_low16(v16 v) noexcept { return _mm256_cvtepi16_epi32(_mm256_castsi256_si128(v)); }
TEXTPLANE_SIMD_INLINE vi widen_high16(v16 v) noexcept { return _mm256_cvtepi16_epi32(_mm256_extracti128_si256(v, 1)); }
