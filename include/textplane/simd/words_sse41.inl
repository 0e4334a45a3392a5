// Eight int16. The operations are defined in words_scalar.inl.

enum : int { k16Lanes = 8 };
using v16 = __m128i;

TEXTPLANE_SIMD_INLINE v16 set16(int value) noexcept { return _mm_set1_epi16(static_cast<short>(value)); }
TEXTPLANE_SIMD_INLINE v16 load16(const std::int16_t* p) noexcept {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p));
}
TEXTPLANE_SIMD_INLINE void store16(std::int16_t* p, v16 v) noexcept {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(p), v);
}
TEXTPLANE_SIMD_INLINE v16 add16(v16 x, v16 y) noexcept { return _mm_add_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 sub16(v16 x, v16 y) noexcept { return _mm_sub_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 mul15(v16 x, v16 y) noexcept { return _mm_mulhrs_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 dot_pair(v16 t, int w0, int w1) noexcept {
  return _mm_maddubs_epi16(t, _mm_set1_epi16(static_cast<short>((w0 & 255) | (w1 * 256))));
}
TEXTPLANE_SIMD_INLINE vi add_dot16(vi sum, v16 x, v16 y) noexcept { return addi(sum, _mm_madd_epi16(x, y)); }
TEXTPLANE_SIMD_INLINE v16 pack16(vi low, vi high) noexcept { return _mm_packs_epi32(low, high); }
TEXTPLANE_SIMD_INLINE int hsumi(vi v) noexcept {
  const vi a = _mm_add_epi32(v, _mm_shuffle_epi32(v, 0x4e));
  return _mm_cvtsi128_si32(_mm_add_epi32(a, _mm_shuffle_epi32(a, 0xb1)));
}
TEXTPLANE_SIMD_INLINE void gather16(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* first,
                                    v16* second) noexcept {
  gather_words8(upper, lower, offset, first, second);
}
TEXTPLANE_SIMD_INLINE vi gather_pairs(const std::uint16_t* p, const int* offset) noexcept {
  return gather_pairs4(p, offset);
}
TEXTPLANE_SIMD_INLINE v16 low16(vi a, vi b) noexcept {
  return _mm_packs_epi32(_mm_srai_epi32(_mm_slli_epi32(a, 16), 16), _mm_srai_epi32(_mm_slli_epi32(b, 16), 16));
}
TEXTPLANE_SIMD_INLINE v16 high16(vi a, vi b) noexcept {
  return _mm_packs_epi32(_mm_srai_epi32(a, 16), _mm_srai_epi32(b, 16));
}
TEXTPLANE_SIMD_INLINE vi widen_low16(v16 v) noexcept { return _mm_cvtepi16_epi32(v); }
TEXTPLANE_SIMD_INLINE vi widen_high16(v16 v) noexcept { return _mm_cvtepi16_epi32(_mm_srli_si128(v, 8)); }
