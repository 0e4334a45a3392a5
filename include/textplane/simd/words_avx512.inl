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
TEXTPLANE_SIMD_INLINE vi dot16(v16 x, v16 y) noexcept { return _mm512_madd_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 pack16(vi low, vi high) noexcept {
  const __m512i order = _mm512_set_epi64(7, 5, 3, 1, 6, 4, 2, 0);
  return _mm512_maskz_permutexvar_epi64(0xff, order, _mm512_packs_epi32(low, high));
}
TEXTPLANE_SIMD_INLINE int hsumi(vi v) noexcept {
  const __m256i q =
      _mm256_add_epi32(_mm512_maskz_extracti64x4_epi64(0xf, v, 0), _mm512_maskz_extracti64x4_epi64(0xf, v, 1));
  const __m128i h = _mm_add_epi32(_mm256_castsi256_si128(q), _mm256_extracti128_si256(q, 1));
  const __m128i a = _mm_add_epi32(h, _mm_shuffle_epi32(h, 0x4e));
  return _mm_cvtsi128_si32(_mm_add_epi32(a, _mm_shuffle_epi32(a, 0xb1)));
}
// pinsrw and pinsrd, which beat gathers and the way through general registers.
TEXTPLANE_SIMD_INLINE std::uint64_t two_offsets(const int* offset) noexcept {
  std::uint64_t pair;
  __builtin_memcpy(&pair, offset, 8);
  return pair;
}
TEXTPLANE_SIMD_INLINE std::ptrdiff_t first_offset(std::uint64_t pair) noexcept { return static_cast<std::int32_t>(pair); }
TEXTPLANE_SIMD_INLINE std::ptrdiff_t second_offset(std::uint64_t pair) noexcept {
  return static_cast<std::int64_t>(pair) >> 32;
}
TEXTPLANE_SIMD_INLINE void gather_words8(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset,
                                         __m128i* first, __m128i* second) noexcept {
  const std::ptrdiff_t o0 = offset[0], o1 = offset[1], o2 = offset[2], o3 = offset[3];
  const std::ptrdiff_t o4 = offset[4], o5 = offset[5], o6 = offset[6], o7 = offset[7];
  __m128i u = _mm_cvtsi32_si128(static_cast<int>(load_half(upper + o0)));
  u = _mm_insert_epi16(u, static_cast<int>(load_half(upper + o1)), 1);
  u = _mm_insert_epi16(u, static_cast<int>(load_half(upper + o2)), 2);
  u = _mm_insert_epi16(u, static_cast<int>(load_half(upper + o3)), 3);
  u = _mm_insert_epi16(u, static_cast<int>(load_half(upper + o4)), 4);
  u = _mm_insert_epi16(u, static_cast<int>(load_half(upper + o5)), 5);
  u = _mm_insert_epi16(u, static_cast<int>(load_half(upper + o6)), 6);
  u = _mm_insert_epi16(u, static_cast<int>(load_half(upper + o7)), 7);
  __m128i l = _mm_cvtsi32_si128(static_cast<int>(load_half(lower + o0)));
  l = _mm_insert_epi16(l, static_cast<int>(load_half(lower + o1)), 1);
  l = _mm_insert_epi16(l, static_cast<int>(load_half(lower + o2)), 2);
  l = _mm_insert_epi16(l, static_cast<int>(load_half(lower + o3)), 3);
  l = _mm_insert_epi16(l, static_cast<int>(load_half(lower + o4)), 4);
  l = _mm_insert_epi16(l, static_cast<int>(load_half(lower + o5)), 5);
  l = _mm_insert_epi16(l, static_cast<int>(load_half(lower + o6)), 6);
  l = _mm_insert_epi16(l, static_cast<int>(load_half(lower + o7)), 7);
  *first = u;
  *second = l;
}
TEXTPLANE_SIMD_INLINE __m128i gather_pairs4(const std::uint16_t* p, const int* offset) noexcept {
  const std::uint64_t a = two_offsets(offset), b = two_offsets(offset + 2);
  __m128i v = _mm_cvtsi32_si128(static_cast<int>(word_pair(p + first_offset(a))));
  v = _mm_insert_epi32(v, static_cast<int>(word_pair(p + second_offset(a))), 1);
  v = _mm_insert_epi32(v, static_cast<int>(word_pair(p + first_offset(b))), 2);
  return _mm_insert_epi32(v, static_cast<int>(word_pair(p + second_offset(b))), 3);
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
  const __m256i a = _mm256_inserti128_si256(_mm256_castsi128_si256(gather_pairs4(p, offset)), gather_pairs4(p, offset + 4), 1);
  const __m256i b =
      _mm256_inserti128_si256(_mm256_castsi128_si256(gather_pairs4(p, offset + 8)), gather_pairs4(p, offset + 12), 1);
  return _mm512_maskz_inserti64x4(0xff, _mm512_castsi256_si512(a), b, 1);
}
TEXTPLANE_SIMD_INLINE v16 low16(vi a, vi b) noexcept {
  return _mm512_maskz_inserti64x4(0xff, _mm512_castsi256_si512(_mm512_maskz_cvtepi32_epi16(0xffff, a)),
                                  _mm512_maskz_cvtepi32_epi16(0xffff, b), 1);
}
TEXTPLANE_SIMD_INLINE v16 high16(vi a, vi b) noexcept {
  return low16(_mm512_maskz_srli_epi32(0xffff, a, 16), _mm512_maskz_srli_epi32(0xffff, b, 16));
}
TEXTPLANE_SIMD_INLINE vi widen_low16(v16 v) noexcept {
  return _mm512_maskz_cvtepi16_epi32(0xffff, _mm512_maskz_extracti64x4_epi64(0xf, v, 0));
}
TEXTPLANE_SIMD_INLINE vi widen_high16(v16 v) noexcept {
  return _mm512_maskz_cvtepi16_epi32(0xffff, _mm512_maskz_extracti64x4_epi64(0xf, v, 1));
}
