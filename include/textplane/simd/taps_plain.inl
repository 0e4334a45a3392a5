// Four words of taps, each of two bytes of the upper row and, above them, two of the lower.

TEXTPLANE_SIMD_INLINE void fetch_four(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset,
                                      std::uint32_t* taps) noexcept {
  const std::ptrdiff_t o0 = offset[0], o1 = offset[1], o2 = offset[2], o3 = offset[3];
  taps[0] = load_half(upper + o0) | load_half(lower + o0) << 16;
  taps[1] = load_half(upper + o1) | load_half(lower + o1) << 16;
  taps[2] = load_half(upper + o2) | load_half(lower + o2) << 16;
  taps[3] = load_half(upper + o3) | load_half(lower + o3) << 16;
}
