// Partial bytes through a buffer, for targets without masked stores of bytes. Include before: loadb(), storeb().

TEXTPLANE_SIMD_INLINE vb loadb_n(const std::uint8_t* p, int n) noexcept {
  std::uint8_t bytes[kBytes] = {0};
  for (int i = 0; i < n; ++i) bytes[i] = p[i];
  return loadb(bytes);
}
TEXTPLANE_SIMD_INLINE void storeb_n(std::uint8_t* p, vb a, int n) noexcept {
  std::uint8_t bytes[kBytes];
  storeb(bytes, a);
  for (int i = 0; i < n; ++i) p[i] = bytes[i];
}
