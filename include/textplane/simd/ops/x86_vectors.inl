// Operations that read the same on every x86 target. Include before: those of the target.

TEXTPLANE_SIMD_INLINE vf inverse_root(vf a) noexcept {
  const vf y = rough_inverse_root(a);
  return y * nmadd(set1(0.5f) * a * y, y, set1(1.5f));
}
TEXTPLANE_SIMD_INLINE vf tap_value(taps_t t) noexcept { return to_float(andi(t.cells, seti(255))); }
TEXTPLANE_SIMD_INLINE vf tap_dx(taps_t t) noexcept { return tap_dot(t, 0x000001ff); }
TEXTPLANE_SIMD_INLINE vf tap_dy(taps_t t) noexcept { return tap_dot(t, 0x000100ff); }
TEXTPLANE_SIMD_INLINE vf tap_dxy(taps_t t) noexcept { return tap_dot(t, 0x01ffff01); }
TEXTPLANE_SIMD_INLINE v16 dot_pair(v16 t, int w0, int w1) noexcept {
  return dot_bytes(t, set16((w0 & 255) | (w1 * 256)));
}
TEXTPLANE_SIMD_INLINE vb mean4b(vb upper0, vb upper1, vb lower0, vb lower1) noexcept {
  const vb one = setb(1);
  const v16 sum0 = add16(dot_bytes(upper0, one), dot_bytes(lower0, one));
  const v16 sum1 = add16(dot_bytes(upper1, one), dot_bytes(lower1, one));
  return pack_bytes(quarter16(add16(sum0, set16(2))), quarter16(add16(sum1, set16(2))));
}

// --- groups: 128 bits of a vector, each for eight int16 ---
constexpr int kGroups = k16Lanes / 8;
TEXTPLANE_SIMD_INLINE void gather16(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* first,
                                    v16* second) noexcept {
  __m128i u[kGroups], l[kGroups];
  TEXTPLANE_SIMD_UNROLL
  for (int i = 0; i < kGroups; ++i) gather_pairs8(upper, lower, offset + 8 * i, u + i, l + i);
  *first = join_groups(u);
  *second = join_groups(l);
}
// load_groups() has the bytes p + 8 i to p + 8 i + 15 in group i.
TEXTPLANE_SIMD_INLINE v16 mix_pairs(const std::uint8_t* p, v16 weights) noexcept {
  const __m128i neighbours = _mm_setr_epi8(0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8);
  return dot_bytes(weights, pick_bytes(xorb(load_groups(p), setb(-128)), repeat_group(neighbours)));
}
