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
TEXTPLANE_SIMD_INLINE vi dot16(v16 x, v16 y) noexcept { return _mm256_madd_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 pack16(vi low, vi high) noexcept {
  return _mm256_permute4x64_epi64(_mm256_packs_epi32(low, high), 0xd8);
}
TEXTPLANE_SIMD_INLINE int hsumi(vi v) noexcept {
  const __m128i h = _mm_add_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
  const __m128i a = _mm_add_epi32(h, _mm_shuffle_epi32(h, 0x4e));
  return _mm_cvtsi128_si32(_mm_add_epi32(a, _mm_shuffle_epi32(a, 0xb1)));
}
// Two offsets a load; pinsrw and pinsrd, which beat gathers and the way through general registers.
TEXTPLANE_SIMD_INLINE std::uint64_t two_offsets(const int* offset) noexcept {
  std::uint64_t pair;
  __builtin_memcpy(&pair, offset, 8);
  return pair;
}
TEXTPLANE_SIMD_INLINE std::ptrdiff_t first_offset(std::uint64_t pair) noexcept { return static_cast<std::int32_t>(pair); }
TEXTPLANE_SIMD_INLINE std::ptrdiff_t second_offset(std::uint64_t pair) noexcept {
  return static_cast<std::int64_t>(pair) >> 32;
}
TEXTPLANE_SIMD_INLINE __m128i gather_words8(const std::uint8_t* p, const int* offset) noexcept {
  const std::uint64_t a = two_offsets(offset), b = two_offsets(offset + 2);
  const std::uint64_t c = two_offsets(offset + 4), d = two_offsets(offset + 6);
  __m128i v = _mm_cvtsi32_si128(static_cast<int>(load_half(p + first_offset(a))));
  v = _mm_insert_epi16(v, static_cast<int>(load_half(p + second_offset(a))), 1);
  v = _mm_insert_epi16(v, static_cast<int>(load_half(p + first_offset(b))), 2);
  v = _mm_insert_epi16(v, static_cast<int>(load_half(p + second_offset(b))), 3);
  v = _mm_insert_epi16(v, static_cast<int>(load_half(p + first_offset(c))), 4);
  v = _mm_insert_epi16(v, static_cast<int>(load_half(p + second_offset(c))), 5);
  v = _mm_insert_epi16(v, static_cast<int>(load_half(p + first_offset(d))), 6);
  return _mm_insert_epi16(v, static_cast<int>(load_half(p + second_offset(d))), 7);
}
TEXTPLANE_SIMD_INLINE __m128i gather_pairs4(const std::uint16_t* p, const int* offset) noexcept {
  const std::uint64_t a = two_offsets(offset), b = two_offsets(offset + 2);
  __m128i v = _mm_cvtsi32_si128(static_cast<int>(word_pair(p + first_offset(a))));
  v = _mm_insert_epi32(v, static_cast<int>(word_pair(p + second_offset(a))), 1);
  v = _mm_insert_epi32(v, static_cast<int>(word_pair(p + first_offset(b))), 2);
  return _mm_insert_epi32(v, static_cast<int>(word_pair(p + second_offset(b))), 3);
}
TEXTPLANE_SIMD_INLINE v16 gather16(const std::uint8_t* p, const int* offset) noexcept {
  return _mm256_inserti128_si256(_mm256_castsi128_si256(gather_words8(p, offset)), gather_words8(p, offset + 8), 1);
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
