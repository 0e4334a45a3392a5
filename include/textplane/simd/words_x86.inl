// What the int16 vectors of the x86 targets share: gathers of eight words, or of four pairs, into 128 bits.

// pinsrw and pinsrd beat gathers and the way through general registers.
TEXTPLANE_SIMD_INLINE std::uint64_t two_offsets(const int* offset) noexcept {
  std::uint64_t pair;
  __builtin_memcpy(&pair, offset, 8);
  return pair;
}
TEXTPLANE_SIMD_INLINE std::ptrdiff_t first_offset(std::uint64_t pair) noexcept {
  return static_cast<std::int32_t>(pair);
}
TEXTPLANE_SIMD_INLINE std::ptrdiff_t second_offset(std::uint64_t pair) noexcept {
  return static_cast<std::int64_t>(pair) >> 32;
}
TEXTPLANE_SIMD_INLINE void gather_words8(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset,
                                         __m128i* first, __m128i* second) noexcept {
  const std::ptrdiff_t o0 = offset[0], o1 = offset[1], o2 = offset[2], o3 = offset[3];
  const std::ptrdiff_t o4 = offset[4], o5 = offset[5], o6 = offset[6], o7 = offset[7];
  __m128i u = _mm_cvtsi32_si128(static_cast<int>(load_half(upper + o0)));
  u = _mm_insert_epi16(u, static_cast<short>(load_half(upper + o1)), 1);
  u = _mm_insert_epi16(u, static_cast<short>(load_half(upper + o2)), 2);
  u = _mm_insert_epi16(u, static_cast<short>(load_half(upper + o3)), 3);
  u = _mm_insert_epi16(u, static_cast<short>(load_half(upper + o4)), 4);
  u = _mm_insert_epi16(u, static_cast<short>(load_half(upper + o5)), 5);
  u = _mm_insert_epi16(u, static_cast<short>(load_half(upper + o6)), 6);
  u = _mm_insert_epi16(u, static_cast<short>(load_half(upper + o7)), 7);
  __m128i l = _mm_cvtsi32_si128(static_cast<int>(load_half(lower + o0)));
  l = _mm_insert_epi16(l, static_cast<short>(load_half(lower + o1)), 1);
  l = _mm_insert_epi16(l, static_cast<short>(load_half(lower + o2)), 2);
  l = _mm_insert_epi16(l, static_cast<short>(load_half(lower + o3)), 3);
  l = _mm_insert_epi16(l, static_cast<short>(load_half(lower + o4)), 4);
  l = _mm_insert_epi16(l, static_cast<short>(load_half(lower + o5)), 5);
  l = _mm_insert_epi16(l, static_cast<short>(load_half(lower + o6)), 6);
  l = _mm_insert_epi16(l, static_cast<short>(load_half(lower + o7)), 7);
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
