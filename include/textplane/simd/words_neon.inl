// Eight int16. The operations are defined in words_scalar.inl.

enum : int { k16Lanes = 8 };
using v16 = int16x8_t;

TEXTPLANE_SIMD_INLINE v16 set16(int value) noexcept { return vdupq_n_s16(static_cast<std::int16_t>(value)); }
TEXTPLANE_SIMD_INLINE v16 load16(const std::int16_t* p) noexcept { return vld1q_s16(p); }
TEXTPLANE_SIMD_INLINE void store16(std::int16_t* p, v16 v) noexcept { vst1q_s16(p, v); }
TEXTPLANE_SIMD_INLINE v16 add16(v16 x, v16 y) noexcept { return vaddq_s16(x, y); }
TEXTPLANE_SIMD_INLINE v16 sub16(v16 x, v16 y) noexcept { return vsubq_s16(x, y); }
TEXTPLANE_SIMD_INLINE v16 mul15(v16 x, v16 y) noexcept { return vqrdmulhq_s16(x, y); }
TEXTPLANE_SIMD_INLINE v16 dot_pair(v16 t, int w0, int w1) noexcept {
  const uint16x8_t u = vreinterpretq_u16_s16(t);
  const int16x8_t low = vreinterpretq_s16_u16(vandq_u16(u, vdupq_n_u16(255)));
  const int16x8_t high = vreinterpretq_s16_u16(vshrq_n_u16(u, 8));
  return vmlaq_n_s16(vmulq_n_s16(low, static_cast<std::int16_t>(w0)), high, static_cast<std::int16_t>(w1));
}
TEXTPLANE_SIMD_INLINE vi add_dot16(vi sum, v16 x, v16 y) noexcept {
  return addi(sum, vpaddq_s32(vmull_s16(vget_low_s16(x), vget_low_s16(y)), vmull_high_s16(x, y)));
}
TEXTPLANE_SIMD_INLINE v16 pack16(vi low, vi high) noexcept { return vcombine_s16(vqmovn_s32(low), vqmovn_s32(high)); }
TEXTPLANE_SIMD_INLINE int hsumi(vi v) noexcept { return vaddvq_s32(v); }
TEXTPLANE_SIMD_INLINE void gather16(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* first,
                                    v16* second) noexcept {
  std::uint16_t u[8], l[8];
  for (int i = 0; i < 8; ++i) {
    u[i] = static_cast<std::uint16_t>(load_half(upper + offset[i]));
    l[i] = static_cast<std::uint16_t>(load_half(lower + offset[i]));
  }
  *first = vreinterpretq_s16_u16(vld1q_u16(u));
  *second = vreinterpretq_s16_u16(vld1q_u16(l));
}
TEXTPLANE_SIMD_INLINE vi gather_pairs(const std::uint16_t* p, const int* offset) noexcept {
  std::uint32_t w[4];
  for (int i = 0; i < 4; ++i) w[i] = word_pair(p + offset[i]);
  return vreinterpretq_s32_u32(vld1q_u32(w));
}
TEXTPLANE_SIMD_INLINE v16 low16(vi a, vi b) noexcept {
  return vuzp1q_s16(vreinterpretq_s16_s32(a), vreinterpretq_s16_s32(b));
}
TEXTPLANE_SIMD_INLINE v16 high16(vi a, vi b) noexcept {
  return vuzp2q_s16(vreinterpretq_s16_s32(a), vreinterpretq_s16_s32(b));
}
TEXTPLANE_SIMD_INLINE vi widen_low16(v16 v) noexcept { return vmovl_s16(vget_low_s16(v)); }
TEXTPLANE_SIMD_INLINE vi widen_high16(v16 v) noexcept { return vmovl_high_s16(v); }
