// What the operations of all targets share. The first file of a region.

// Two and four bytes as a number, the first byte lowest. Compilers make one load of it.
TEXTPLANE_SIMD_INLINE unsigned load_u16(const std::uint8_t* p) noexcept {
  return static_cast<unsigned>(p[0]) | static_cast<unsigned>(p[1]) << 8;
}
TEXTPLANE_SIMD_INLINE unsigned load_u32(const std::uint8_t* p) noexcept {
  return static_cast<unsigned>(p[0]) | static_cast<unsigned>(p[1]) << 8 | static_cast<unsigned>(p[2]) << 16 |
         static_cast<unsigned>(p[3]) << 24;
}
// The first n of four bytes, zeros above; 0 <= n <= 4. Bytes from n on are not touched.
TEXTPLANE_SIMD_INLINE unsigned load_u32_n(const std::uint8_t* p, int n) noexcept {
  unsigned word = 0;
  if (n >= 1) word = p[0];
  if (n >= 2) word |= static_cast<unsigned>(p[1]) << 8;
  if (n >= 3) word |= static_cast<unsigned>(p[2]) << 16;
  if (n >= 4) word |= static_cast<unsigned>(p[3]) << 24;
  return word;
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
