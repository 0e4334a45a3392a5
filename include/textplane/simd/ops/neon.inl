// Operations of the neon target: vectors of 128 bits. ops/scalar.inl defines them.
// Include before: ops/common.inl.

// --- floats ---
constexpr int kLanes = 4;
constexpr bool kManyRegisters = true;  // 32
using vf = float32x4_t;
using vi = int32x4_t;
using vm = uint32x4_t;  // all bits of a lane

// --- make, load, store ---
TEXTPLANE_SIMD_INLINE vf set1(float value) noexcept { return vdupq_n_f32(value); }
TEXTPLANE_SIMD_INLINE vi seti(int value) noexcept { return vdupq_n_s32(value); }
TEXTPLANE_SIMD_INLINE vi ioti() noexcept { return vi{0, 1, 2, 3}; }
TEXTPLANE_SIMD_INLINE vf iota() noexcept { return vf{0.0f, 1.0f, 2.0f, 3.0f}; }
TEXTPLANE_SIMD_INLINE vf load(const float* p) noexcept { return vld1q_f32(p); }
TEXTPLANE_SIMD_INLINE vf hold(vf v) noexcept { return v; }
TEXTPLANE_SIMD_INLINE void store(float* p, vf v) noexcept { vst1q_f32(p, v); }
TEXTPLANE_SIMD_INLINE vi loadi(const int* p) noexcept { return vld1q_s32(p); }
TEXTPLANE_SIMD_INLINE void storei(int* p, vi v) noexcept { vst1q_s32(p, v); }
TEXTPLANE_SIMD_INLINE vf load_n(const float* p, int n) noexcept {
  if (n >= 4) return vld1q_f32(p);
  vf v = set1(0.0f);
  if (n >= 1) v = vld1q_lane_f32(p, v, 0);
  if (n >= 2) v = vld1q_lane_f32(p + 1, v, 1);
  if (n >= 3) v = vld1q_lane_f32(p + 2, v, 2);
  return v;
}
TEXTPLANE_SIMD_INLINE void store_n(float* p, vf v, int n) noexcept {
  if (n >= 4) {
    vst1q_f32(p, v);
    return;
  }
  if (n >= 1) vst1q_lane_f32(p, v, 0);
  if (n >= 2) vst1q_lane_f32(p + 1, v, 1);
  if (n >= 3) vst1q_lane_f32(p + 2, v, 2);
}
TEXTPLANE_SIMD_INLINE vf gather(const float* p, const int* at) noexcept {
  return vf{p[at[0]], p[at[1]], p[at[2]], p[at[3]]};
}

// --- float arithmetic ---
TEXTPLANE_SIMD_INLINE vf madd(vf a, vf b, vf c) noexcept { return vfmaq_f32(c, a, b); }
TEXTPLANE_SIMD_INLINE vf nmadd(vf a, vf b, vf c) noexcept { return vfmsq_f32(c, a, b); }
// NEON's own minimum gives NaN for either operand and orders the zeros.
#if TEXTPLANE_SIMD_HIDE_MINIMA
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept {
  vm less;
  __asm__("fcmgt %0.4s, %2.4s, %1.4s" : "=w"(less) : "w"(a), "w"(b));
  return vbslq_f32(less, a, b);
}
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept {
  vm greater;
  __asm__("fcmgt %0.4s, %1.4s, %2.4s" : "=w"(greater) : "w"(a), "w"(b));
  return vbslq_f32(greater, a, b);
}
#else
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept { return vbslq_f32(vcltq_f32(a, b), a, b); }
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept { return vbslq_f32(vcgtq_f32(a, b), a, b); }
#endif
TEXTPLANE_SIMD_INLINE vf sqrt_(vf a) noexcept { return vsqrtq_f32(a); }
TEXTPLANE_SIMD_INLINE vf inverse_root(vf a) noexcept {
  vf y = vrsqrteq_f32(a);
  y = y * vrsqrtsq_f32(a * y, y);
  return y * vrsqrtsq_f32(a * y, y);
}
TEXTPLANE_SIMD_INLINE vf abs_(vf a) noexcept { return vabsq_f32(a); }
TEXTPLANE_SIMD_INLINE vf floor_(vf a) noexcept { return vrndmq_f32(a); }

// --- conversions ---
TEXTPLANE_SIMD_INLINE vi to_int(vf a) noexcept { return vcvtq_s32_f32(a); }
TEXTPLANE_SIMD_INLINE vf to_float(vi a) noexcept { return vcvtq_f32_s32(a); }
TEXTPLANE_SIMD_INLINE vi as_int(vf a) noexcept { return vreinterpretq_s32_f32(a); }
TEXTPLANE_SIMD_INLINE vf as_float(vi a) noexcept { return vreinterpretq_f32_s32(a); }

// --- int32 arithmetic ---
TEXTPLANE_SIMD_INLINE vi addi(vi a, vi b) noexcept { return vaddq_s32(a, b); }
TEXTPLANE_SIMD_INLINE vi subi(vi a, vi b) noexcept { return vsubq_s32(a, b); }
TEXTPLANE_SIMD_INLINE vi muli(vi a, vi b) noexcept { return vmulq_s32(a, b); }
TEXTPLANE_SIMD_INLINE vi mini(vi a, vi b) noexcept { return vminq_s32(a, b); }
TEXTPLANE_SIMD_INLINE vi maxi(vi a, vi b) noexcept { return vmaxq_s32(a, b); }
TEXTPLANE_SIMD_INLINE vi shl(vi a, int bits) noexcept { return vshlq_s32(a, seti(bits)); }
TEXTPLANE_SIMD_INLINE vi shr(vi a, int bits) noexcept { return vshlq_s32(a, seti(-bits)); }
TEXTPLANE_SIMD_INLINE vi andi(vi a, vi b) noexcept { return vandq_s32(a, b); }
TEXTPLANE_SIMD_INLINE vi ori(vi a, vi b) noexcept { return vorrq_s32(a, b); }

// --- masks ---
TEXTPLANE_SIMD_INLINE vm lt(vf a, vf b) noexcept { return vcltq_f32(a, b); }
TEXTPLANE_SIMD_INLINE vm le(vf a, vf b) noexcept { return vcleq_f32(a, b); }
TEXTPLANE_SIMD_INLINE vm gt(vf a, vf b) noexcept { return vcgtq_f32(a, b); }
TEXTPLANE_SIMD_INLINE vm ge(vf a, vf b) noexcept { return vcgeq_f32(a, b); }
TEXTPLANE_SIMD_INLINE vm eq(vf a, vf b) noexcept { return vceqq_f32(a, b); }
TEXTPLANE_SIMD_INLINE vm eqi(vi a, vi b) noexcept { return vceqq_s32(a, b); }
TEXTPLANE_SIMD_INLINE vm and_(vm a, vm b) noexcept { return vandq_u32(a, b); }
TEXTPLANE_SIMD_INLINE vm andnot_(vm a, vm b) noexcept { return vbicq_u32(b, a); }
TEXTPLANE_SIMD_INLINE vf select(vm m, vf a, vf b) noexcept { return vbslq_f32(m, a, b); }
TEXTPLANE_SIMD_INLINE vf keep(vm m, vf a) noexcept {
  return vreinterpretq_f32_u32(vandq_u32(m, vreinterpretq_u32_f32(a)));
}
TEXTPLANE_SIMD_INLINE vm first_n(int n) noexcept { return vcltq_s32(ioti(), seti(n)); }
TEXTPLANE_SIMD_INLINE unsigned bits_from_mask(vm m) noexcept { return vaddvq_u32(vandq_u32(m, vm{1u, 2u, 4u, 8u})); }
TEXTPLANE_SIMD_INLINE int count_true(vm m) noexcept { return static_cast<int>(vaddvq_u32(vshrq_n_u32(m, 31))); }
TEXTPLANE_SIMD_INLINE bool all_true(vm m) noexcept { return vminvq_u32(m) != 0; }

// --- reductions ---
TEXTPLANE_SIMD_INLINE float reduce_sum(vf a) noexcept {
  const float32x2_t two = vadd_f32(vget_low_f32(a), vget_high_f32(a));
  return vget_lane_f32(two, 0) + vget_lane_f32(two, 1);
}
TEXTPLANE_SIMD_INLINE double reduce_sum_double(vf a) noexcept {
  const float64x2_t two = vaddq_f64(vcvt_f64_f32(vget_low_f32(a)), vcvt_high_f64_f32(a));
  return vgetq_lane_f64(two, 0) + vgetq_lane_f64(two, 1);
}
TEXTPLANE_SIMD_INLINE float reduce_min(vf a) noexcept { return vminvq_f32(a); }
TEXTPLANE_SIMD_INLINE float reduce_max(vf a) noexcept { return vmaxvq_f32(a); }

// --- bilinear taps ---
struct taps_t {
  uint32x4_t cells;
};
TEXTPLANE_SIMD_INLINE taps_t load_taps(const std::uint32_t* p) noexcept { return taps_t{vld1q_u32(p)}; }
TEXTPLANE_SIMD_INLINE vi low_bytes(uint32x4_t cells) noexcept {
  return vreinterpretq_s32_u32(vandq_u32(cells, vdupq_n_u32(255u)));
}
TEXTPLANE_SIMD_INLINE vi tap_00(taps_t t) noexcept { return low_bytes(t.cells); }
TEXTPLANE_SIMD_INLINE vi tap_10(taps_t t) noexcept { return low_bytes(vshrq_n_u32(t.cells, 8)); }
TEXTPLANE_SIMD_INLINE vi tap_01(taps_t t) noexcept { return low_bytes(vshrq_n_u32(t.cells, 16)); }
TEXTPLANE_SIMD_INLINE vi tap_11(taps_t t) noexcept { return vreinterpretq_s32_u32(vshrq_n_u32(t.cells, 24)); }
TEXTPLANE_SIMD_INLINE vf tap_value(taps_t t) noexcept { return vcvtq_f32_s32(tap_00(t)); }
TEXTPLANE_SIMD_INLINE vf tap_dx(taps_t t) noexcept { return vcvtq_f32_s32(vsubq_s32(tap_10(t), tap_00(t))); }
TEXTPLANE_SIMD_INLINE vf tap_dy(taps_t t) noexcept { return vcvtq_f32_s32(vsubq_s32(tap_01(t), tap_00(t))); }
TEXTPLANE_SIMD_INLINE vf tap_dxy(taps_t t) noexcept {
  return vcvtq_f32_s32(vsubq_s32(vsubq_s32(tap_11(t), tap_01(t)), vsubq_s32(tap_10(t), tap_00(t))));
}

// --- one number ---
TEXTPLANE_SIMD_INLINE double sqrt_d(double a) noexcept { return vget_lane_f64(vsqrt_f64(vdup_n_f64(a)), 0); }
TEXTPLANE_SIMD_INLINE int lowest_bit(std::uint64_t bits) noexcept { return __builtin_ctzll(bits); }

TEXTPLANE_SIMD_INLINE void fetch_four(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset,
                                      std::uint32_t* taps) noexcept {
  fetch_four_words(upper, lower, offset, taps);
}

TEXTPLANE_SIMD_INLINE void reduce_sum4(vf a, vf b, vf c, vf d, float* out) noexcept {
  vst1q_f32(out, vpaddq_f32(vpaddq_f32(a, b), vpaddq_f32(c, d)));
}

// --- bytes ---
constexpr int kBytes = 16;
using vb = uint8x16_t;

TEXTPLANE_SIMD_INLINE vb setb(int value) noexcept { return vdupq_n_u8(static_cast<std::uint8_t>(value)); }
TEXTPLANE_SIMD_INLINE vb loadb(const std::uint8_t* p) noexcept { return vld1q_u8(p); }
TEXTPLANE_SIMD_INLINE void storeb(std::uint8_t* p, vb a) noexcept { vst1q_u8(p, a); }

TEXTPLANE_SIMD_INLINE vb addsb(vb a, vb b) noexcept { return vqaddq_u8(a, b); }
TEXTPLANE_SIMD_INLINE vb subsb(vb a, vb b) noexcept { return vqsubq_u8(a, b); }
TEXTPLANE_SIMD_INLINE vb minb(vb a, vb b) noexcept { return vminq_u8(a, b); }
TEXTPLANE_SIMD_INLINE vb maxb(vb a, vb b) noexcept { return vmaxq_u8(a, b); }
TEXTPLANE_SIMD_INLINE vb andb(vb a, vb b) noexcept { return vandq_u8(a, b); }
TEXTPLANE_SIMD_INLINE vb orb(vb a, vb b) noexcept { return vorrq_u8(a, b); }
TEXTPLANE_SIMD_INLINE vb mean4b(vb upper0, vb upper1, vb lower0, vb lower1) noexcept {
  const uint16x8_t sum0 = vpadalq_u8(vpaddlq_u8(upper0), lower0), sum1 = vpadalq_u8(vpaddlq_u8(upper1), lower1);
  return vcombine_u8(vrshrn_n_u16(sum0, 2), vrshrn_n_u16(sum1, 2));
}

TEXTPLANE_SIMD_INLINE vb geb(vb a, vb b) noexcept { return vcgeq_u8(a, b); }
TEXTPLANE_SIMD_INLINE bool anyb(vb a) noexcept { return vmaxvq_u8(a) != 0; }
TEXTPLANE_SIMD_INLINE std::uint64_t bitsb(vb mask) noexcept {
  const uint8x16_t bit = vandq_u8(mask, vb{1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128});
  return static_cast<std::uint64_t>(vaddv_u8(vget_low_u8(bit))) |
         static_cast<std::uint64_t>(vaddv_u8(vget_high_u8(bit))) << 8;
}

// --- int16 ---
enum : int { k16Lanes = 8 };
using v16 = int16x8_t;
using vw = int32x4_t;
constexpr int kPairsReach = 9;

TEXTPLANE_SIMD_INLINE v16 set16(int value) noexcept { return vdupq_n_s16(static_cast<std::int16_t>(value)); }
TEXTPLANE_SIMD_INLINE v16 load16(const std::int16_t* p) noexcept { return vld1q_s16(p); }
TEXTPLANE_SIMD_INLINE void store16(std::int16_t* p, v16 v) noexcept { vst1q_s16(p, v); }
TEXTPLANE_SIMD_INLINE v16 add16(v16 x, v16 y) noexcept { return vaddq_s16(x, y); }
TEXTPLANE_SIMD_INLINE v16 sub16(v16 x, v16 y) noexcept { return vsubq_s16(x, y); }
TEXTPLANE_SIMD_INLINE v16 and16(v16 x, v16 y) noexcept { return vandq_s16(x, y); }
TEXTPLANE_SIMD_INLINE v16 half16(v16 x) noexcept { return vshrq_n_s16(x, 1); }
TEXTPLANE_SIMD_INLINE v16 first16(int n) noexcept {
  const int limit = n < 0 ? 0 : (n < k16Lanes ? n : k16Lanes);
  return vreinterpretq_s16_u16(vcltq_s16(v16{0, 1, 2, 3, 4, 5, 6, 7}, set16(limit)));
}
TEXTPLANE_SIMD_INLINE v16 mix_pairs(const std::uint8_t* p, v16 weights) noexcept {
  const int8x8_t w0 = vmovn_s16(weights), w1 = vshrn_n_s16(weights, 8);
  const uint8x8_t middle = vdup_n_u8(128);
  const int8x8_t left = vreinterpret_s8_u8(veor_u8(vld1_u8(p), middle));
  const int8x8_t right = vreinterpret_s8_u8(veor_u8(vld1_u8(p + 1), middle));
  return vmlal_s8(vmull_s8(left, w0), right, w1);
}
TEXTPLANE_SIMD_INLINE double sumw(vw a) noexcept { return static_cast<double>(vaddlvq_s32(a)); }
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
TEXTPLANE_SIMD_INLINE int reduce_sum_int(vi v) noexcept { return vaddvq_s32(v); }
TEXTPLANE_SIMD_INLINE void gather16(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* first,
                                    v16* second) noexcept {
  std::uint16_t u[8], l[8];
  for (int i = 0; i < 8; ++i) {
    u[i] = static_cast<std::uint16_t>(load_u16(upper + offset[i]));
    l[i] = static_cast<std::uint16_t>(load_u16(lower + offset[i]));
  }
  *first = vreinterpretq_s16_u16(vld1q_u16(u));
  *second = vreinterpretq_s16_u16(vld1q_u16(l));
}
TEXTPLANE_SIMD_INLINE vi gather_pairs(const std::uint16_t* p, const int* offset) noexcept {
  std::uint32_t w[4];
  for (int i = 0; i < 4; ++i) w[i] = int16_pair(p + offset[i]);
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

// --- doubles ---
enum : int { kDoubles = 2 };
using vp = float64x2_t;
struct vd {
  vp part[4];
};

TEXTPLANE_SIMD_INLINE vp set_p(double value) noexcept { return vdupq_n_f64(value); }
TEXTPLANE_SIMD_INLINE vp load_p(const double* p) noexcept { return vld1q_f64(p); }
TEXTPLANE_SIMD_INLINE vp from_p(const double* const* p, std::ptrdiff_t at) noexcept {
  return vld1q_lane_f64(p[1] + at, vld1q_dup_f64(p[0] + at), 1);
}
TEXTPLANE_SIMD_INLINE void store_p(double* p, vp v) noexcept { vst1q_f64(p, v); }
TEXTPLANE_SIMD_INLINE vp madd_p(vp a, vp b, vp c) noexcept { return vfmaq_f64(c, a, b); }
TEXTPLANE_SIMD_INLINE vp min_p(vp a, vp b) noexcept { return vbslq_f64(vcltq_f64(a, b), a, b); }
TEXTPLANE_SIMD_INLINE vp max_p(vp a, vp b) noexcept { return vbslq_f64(vcgtq_f64(a, b), a, b); }
TEXTPLANE_SIMD_INLINE vp abs_p(vp a) noexcept { return vabsq_f64(a); }
TEXTPLANE_SIMD_INLINE vp trunc_p(vp a) noexcept { return vrndq_f64(a); }
TEXTPLANE_SIMD_INLINE vp positive_p(vp m, vp a, vp b) noexcept { return vbslq_f64(vcgtq_f64(m, vdupq_n_f64(0)), a, b); }
TEXTPLANE_SIMD_INLINE void store_as_float(float* p, vp v) noexcept { vst1_f32(p, vcvt_f32_f64(v)); }

TEXTPLANE_SIMD_INLINE vd reduce_sum8(const float* p) noexcept {
  const float32x4_t q = vpaddq_f32(vpaddq_f32(load(p), load(p + 4)), vpaddq_f32(load(p + 8), load(p + 12)));
  const float32x4_t r = vpaddq_f32(vpaddq_f32(load(p + 16), load(p + 20)), vpaddq_f32(load(p + 24), load(p + 28)));
  return vd{{vcvt_f64_f32(vget_low_f32(q)), vcvt_high_f64_f32(q), vcvt_f64_f32(vget_low_f32(r)), vcvt_high_f64_f32(r)}};
}

// --- tiles ---
enum : int { kTileLanes = 4 };
TEXTPLANE_SIMD_INLINE vi per_tile(const int* b) noexcept { return seti(b[0]); }
TEXTPLANE_SIMD_INLINE bool in_two_rows(vi y) noexcept {
  return vmaxvq_u32(vreinterpretq_u32_s32(vbicq_s32(y, vdupq_n_s32(1)))) == 0;
}
TEXTPLANE_SIMD_INLINE vi tile_rows(const std::uint8_t* const* corner, std::ptrdiff_t offset) noexcept {
  return vreinterpretq_s32_u8(vld1q_u8(corner[0] + offset));
}
TEXTPLANE_SIMD_INLINE vi pick_bytes(vi rows, vi picks) noexcept {
  return vreinterpretq_s32_u8(vqtbl1q_u8(vreinterpretq_u8_s32(rows), vreinterpretq_u8_s32(picks)));
}
TEXTPLANE_SIMD_INLINE vi tile_picks(vi x) noexcept {
  // Each byte of a lane gets the lane's x, which is below 16.
  return vmlaq_n_s32(vdupq_n_s32(0x01000100), x, 0x01010101);
}
TEXTPLANE_SIMD_INLINE taps_t two_rows(vi y, vi a, vi b, vi c) noexcept {
  const uint32x4_t top = vdupq_n_u32(0x0000FFFFU), lower = vtstq_s32(y, y);
  const uint32x4_t p = vreinterpretq_u32_s32(a), q = vreinterpretq_u32_s32(b), r = vreinterpretq_u32_s32(c);
  return taps_t{vbslq_u32(lower, vbslq_u32(top, q, r), vbslq_u32(top, p, q))};
}
TEXTPLANE_SIMD_INLINE void load2(const float* p, vf* a, vf* b) noexcept {
  const float32x4x2_t v = vld2q_f32(p);
  *a = v.val[0];
  *b = v.val[1];
}
TEXTPLANE_SIMD_INLINE void store_u8(std::uint8_t* p, vi v) noexcept {
  const uint16x4_t half = vmovn_u32(vreinterpretq_u32_s32(v));
  const uint8x8_t bytes = vmovn_u16(vcombine_u16(half, half));
  const unsigned word = vget_lane_u32(vreinterpret_u32_u8(bytes), 0);
  __builtin_memcpy(p, &word, 4);
}

#include "textplane/simd/ops/few_bytes.inl"
#include "textplane/simd/ops/no_tiles.inl"
