// taps_plain.inl for the x86 targets: inserts beat gathers and the way through general registers.

TEXTPLANE_SIMD_INLINE void fetch_four(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset,
                                      std::uint32_t* taps) noexcept {
  const std::ptrdiff_t o0 = offset[0], o1 = offset[1], o2 = offset[2], o3 = offset[3];
  __m128i v = _mm_cvtsi32_si128(static_cast<int>(load_half(upper + o0)));
  v = _mm_insert_epi16(v, static_cast<short>(load_half(lower + o0)), 1);
  v = _mm_insert_epi16(v, static_cast<short>(load_half(upper + o1)), 2);
  v = _mm_insert_epi16(v, static_cast<short>(load_half(lower + o1)), 3);
  v = _mm_insert_epi16(v, static_cast<short>(load_half(upper + o2)), 4);
  v = _mm_insert_epi16(v, static_cast<short>(load_half(lower + o2)), 5);
  v = _mm_insert_epi16(v, static_cast<short>(load_half(upper + o3)), 6);
  v = _mm_insert_epi16(v, static_cast<short>(load_half(lower + o3)), 7);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(taps), v);
}
