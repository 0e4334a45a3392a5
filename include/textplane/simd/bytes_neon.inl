// Vectors of 16 bytes and of 8 int16: NEON. The operations are defined in bytes_scalar.inl.

constexpr int kBytes = 16;
using vb = uint8x16_t;

TEXTPLANE_SIMD_INLINE vb setb(int value) noexcept { return vdupq_n_u8(static_cast<std::uint8_t>(value)); }
TEXTPLANE_SIMD_INLINE vb loadb(const std::uint8_t* p) noexcept { return vld1q_u8(p); }
TEXTPLANE_SIMD_INLINE void storeb(std::uint8_t* p, vb a) noexcept { vst1q_u8(p, a); }
TEXTPLANE_SIMD_INLINE vb loadb_n(const std::uint8_t* p, int n) noexcept {
  std::uint8_t bytes[16] = {0};
  for (int i = 0; i < n; ++i) bytes[i] = p[i];
  return loadb(bytes);
}
TEXTPLANE_SIMD_INLINE void storeb_n(std::uint8_t* p, vb a, int n) noexcept {
  std::uint8_t bytes[16];
  storeb(bytes, a);
  for (int i = 0; i < n; ++i) p[i] = bytes[i];
}

TEXTPLANE_SIMD_INLINE vb addsb(vb a, vb b) noexcept { return vqaddq_u8(a, b); }
TEXTPLANE_SIMD_INLINE vb subsb(vb a, vb b) noexcept { return vqsubq_u8(a, b); }
TEXTPLANE_SIMD_INLINE vb minb(vb a, vb b) noexcept { return vminq_u8(a, b); }
TEXTPLANE_SIMD_INLINE vb maxb(vb a, vb b) noexcept { return vmaxq_u8(a, b); }
TEXTPLANE_SIMD_INLINE vb andb(vb a, vb b) noexcept { return vandq_u8(a, b); }
TEXTPLANE_SIMD_INLINE vb orb(vb a, vb b) noexcept { return vorrq_u8(a, b); }
TEXTPLANE_SIMD_INLINE vb xorb(vb a, vb b) noexcept { return veorq_u8(a, b); }
TEXTPLANE_SIMD_INLINE vb mean4b(vb upper0, vb upper1, vb lower0, vb lower1) noexcept {
  const uint16x8_t sum0 = vpadalq_u8(vpaddlq_u8(upper0), lower0), sum1 = vpadalq_u8(vpaddlq_u8(upper1), lower1);
  return vcombine_u8(vrshrn_n_u16(sum0, 2), vrshrn_n_u16(sum1, 2));
}

TEXTPLANE_SIMD_INLINE vb geb(vb a, vb b) noexcept { return vcgeq_u8(a, b); }
TEXTPLANE_SIMD_INLINE bool anyb(vb a) noexcept { return vmaxvq_u8(a) != 0; }
TEXTPLANE_SIMD_INLINE std::uint64_t bitsb(vb mask) noexcept {
  const std::uint8_t weights[16] = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
  const uint8x16_t bit = vandq_u8(mask, vld1q_u8(weights));
  return static_cast<std::uint64_t>(vaddv_u8(vget_low_u8(bit))) |
         static_cast<std::uint64_t>(vaddv_u8(vget_high_u8(bit))) << 8;
}
TEXTPLANE_SIMD_INLINE int lowest_lane(std::uint64_t bits) noexcept { return __builtin_ctzll(bits); }

constexpr int kShorts = 8;
constexpr int kPairsReach = 9;
using vh = int16x8_t;

TEXTPLANE_SIMD_INLINE vh seth(int value) noexcept { return vdupq_n_s16(static_cast<std::int16_t>(value)); }
TEXTPLANE_SIMD_INLINE vh loadh(const std::int16_t* p) noexcept { return vld1q_s16(p); }
TEXTPLANE_SIMD_INLINE void storeh(std::int16_t* p, vh a) noexcept { vst1q_s16(p, a); }
TEXTPLANE_SIMD_INLINE vh addh(vh a, vh b) noexcept { return vaddq_s16(a, b); }
TEXTPLANE_SIMD_INLINE vh subh(vh a, vh b) noexcept { return vsubq_s16(a, b); }
TEXTPLANE_SIMD_INLINE vh andh(vh a, vh b) noexcept { return vandq_s16(a, b); }
TEXTPLANE_SIMD_INLINE vh halfh(vh a) noexcept { return vshrq_n_s16(a, 1); }
TEXTPLANE_SIMD_INLINE vh mulhrsh(vh a, vh b) noexcept { return vqrdmulhq_s16(a, b); }
TEXTPLANE_SIMD_INLINE vh firsth(int n) noexcept {
  const std::int16_t lane[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  const int limit = n < 0 ? 0 : (n < kShorts ? n : kShorts);
  return vreinterpretq_s16_u16(vcltq_s16(vld1q_s16(lane), seth(limit)));
}
TEXTPLANE_SIMD_INLINE vh pair_weights(int w0, int w1) noexcept { return seth(w0 | (w1 << 8)); }
TEXTPLANE_SIMD_INLINE vh mix_pairs(const std::uint8_t* p, vh weights) noexcept {
  const int8x8_t w0 = vmovn_s16(weights), w1 = vshrn_n_s16(weights, 8);
  const uint8x8_t middle = vdup_n_u8(128);
  const int8x8_t left = vreinterpret_s8_u8(veor_u8(vld1_u8(p), middle));
  const int8x8_t right = vreinterpret_s8_u8(veor_u8(vld1_u8(p + 1), middle));
  return vmlal_s8(vmull_s8(left, w0), right, w1);
}

TEXTPLANE_SIMD_INLINE vh grey_to_fixed(const float* p) noexcept {
  const float32x4_t scale = vdupq_n_f32(32.0f), half = vdupq_n_f32(0.5f);
  const int32x4_t low = vcvtq_s32_f32(vaddq_f32(vmulq_f32(vld1q_f32(p), scale), half));
  const int32x4_t high = vcvtq_s32_f32(vaddq_f32(vmulq_f32(vld1q_f32(p + 4), scale), half));
  return vsubq_s16(vcombine_s16(vqmovn_s32(low), vqmovn_s32(high)), seth(4096));
}

using vw = int32x4_t;

TEXTPLANE_SIMD_INLINE vw zerow() noexcept { return vdupq_n_s32(0); }
TEXTPLANE_SIMD_INLINE vw dotw(vw sum, vh a, vh b) noexcept {
  const int32x4_t low = vmull_s16(vget_low_s16(a), vget_low_s16(b)), high = vmull_high_s16(a, b);
  return vaddq_s32(sum, vpaddq_s32(low, high));
}
TEXTPLANE_SIMD_INLINE double sumw(vw a) noexcept { return static_cast<double>(vaddlvq_s32(a)); }
