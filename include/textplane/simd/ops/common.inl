// What the operations of all targets share. The first file of a region.

// Two bytes as a number, the first one low. Compilers make one load of it.
TEXTPLANE_SIMD_INLINE unsigned load_u16(const std::uint8_t* p) noexcept {
  return static_cast<unsigned>(p[0]) | static_cast<unsigned>(p[1]) << 8;
}
// Copies n >= 0 bytes that do not overlap.
TEXTPLANE_SIMD_INLINE void copy_bytes(void* to, const void* from, int n) noexcept {
  std::uint8_t* TEXTPLANE_SIMD_RESTRICT target = static_cast<std::uint8_t*>(to);
  const std::uint8_t* TEXTPLANE_SIMD_RESTRICT source = static_cast<const std::uint8_t*>(from);
  for (int i = 0; i < n; ++i) target[i] = source[i];
}

// Two int16 as a number, the first one low. Compilers make one load of it.
TEXTPLANE_SIMD_INLINE unsigned int16_pair(const std::uint16_t* p) noexcept {
  return static_cast<unsigned>(p[0]) | static_cast<unsigned>(p[1]) << 16;
}
// Zeroes the int16 from..to-1, fewer than 32.
TEXTPLANE_SIMD_INLINE void zero16(std::int16_t* p, int from, int to) noexcept {
  volatile std::int16_t* out = p;  // compilers would call memset, of whose instruction set nothing is known
  for (int i = from; i < to; ++i) out[i] = 0;
}

// fetch_four() word by word.
TEXTPLANE_SIMD_INLINE void fetch_four_words(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset,
                                            std::uint32_t* taps) noexcept {
  const std::ptrdiff_t o0 = offset[0], o1 = offset[1], o2 = offset[2], o3 = offset[3];
  taps[0] = load_u16(upper + o0) | load_u16(lower + o0) << 16;
  taps[1] = load_u16(upper + o1) | load_u16(lower + o1) << 16;
  taps[2] = load_u16(upper + o2) | load_u16(lower + o2) << 16;
  taps[3] = load_u16(upper + o3) | load_u16(lower + o3) << 16;
}
