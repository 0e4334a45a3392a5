// Vectors of four lanes in NEON of AArch64. vec_scalar.inl defines the operations.

constexpr int kLanes = 4;
constexpr bool kManyRegisters = true;  // 32
using vf = float32x4_t;
using vi = int32x4_t;
using vm = uint32x4_t;  // all bits of a lane

// --- make, load, store ---
TEXTPLANE_SIMD_INLINE vf set1(float value) noexcept { return vdupq_n_f32(value); }
TEXTPLANE_SIMD_INLINE vi seti(int value) noexcept { return vdupq_n_s32(value); }
TEXTPLANE_SIMD_INLINE vf zero() noexcept { return vdupq_n_f32(0.0f); }
TEXTPLANE_SIMD_INLINE vi ioti() noexcept { return vi{0, 1, 2, 3}; }
TEXTPLANE_SIMD_INLINE vf iota() noexcept { return vf{0.0f, 1.0f, 2.0f, 3.0f}; }
TEXTPLANE_SIMD_INLINE vf load(const float* p) noexcept { return vld1q_f32(p); }
TEXTPLANE_SIMD_INLINE vf hold(vf v) noexcept { return v; }
TEXTPLANE_SIMD_INLINE void store(float* p, vf v) noexcept { vst1q_f32(p, v); }
TEXTPLANE_SIMD_INLINE vi loadi(const int* p) noexcept { return vld1q_s32(p); }
TEXTPLANE_SIMD_INLINE void storei(int* p, vi v) noexcept { vst1q_s32(p, v); }
TEXTPLANE_SIMD_INLINE vf load_n(const float* p, int n) noexcept {
  if (n >= 4) return vld1q_f32(p);
  vf v = zero();
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
TEXTPLANE_SIMD_INLINE vi loadi_n(const int* p, int n) noexcept {
  if (n >= 4) return vld1q_s32(p);
  vi v = seti(0);
  if (n >= 1) v = vld1q_lane_s32(p, v, 0);
  if (n >= 2) v = vld1q_lane_s32(p + 1, v, 1);
  if (n >= 3) v = vld1q_lane_s32(p + 2, v, 2);
  return v;
}
TEXTPLANE_SIMD_INLINE void storei_n(int* p, vi v, int n) noexcept {
  if (n >= 4) {
    vst1q_s32(p, v);
    return;
  }
  if (n >= 1) vst1q_lane_s32(p, v, 0);
  if (n >= 2) vst1q_lane_s32(p + 1, v, 1);
  if (n >= 3) vst1q_lane_s32(p + 2, v, 2);
}
TEXTPLANE_SIMD_INLINE vf gather(const float* p, const int* at) noexcept {
  return vf{p[at[0]], p[at[1]], p[at[2]], p[at[3]]};
}
// The four bytes of `word`, the lowest in lane 0.
TEXTPLANE_SIMD_INLINE vi widen_word(unsigned word) noexcept {
  const uint16x8_t halves = vmovl_u8(vcreate_u8(word));
  return vreinterpretq_s32_u32(vmovl_u16(vget_low_u16(halves)));
}
TEXTPLANE_SIMD_INLINE vi load_u8i(const std::uint8_t* p) noexcept { return widen_word(load_word(p)); }
TEXTPLANE_SIMD_INLINE vf load_u8(const std::uint8_t* p) noexcept { return vcvtq_f32_s32(load_u8i(p)); }
TEXTPLANE_SIMD_INLINE vi load_u8i_n(const std::uint8_t* p, int n) noexcept { return widen_word(load_word_n(p, n)); }
TEXTPLANE_SIMD_INLINE vf load_u8_n(const std::uint8_t* p, int n) noexcept { return vcvtq_f32_s32(load_u8i_n(p, n)); }

// --- float arithmetic ---
TEXTPLANE_SIMD_INLINE vf add(vf a, vf b) noexcept { return vaddq_f32(a, b); }
TEXTPLANE_SIMD_INLINE vf sub(vf a, vf b) noexcept { return vsubq_f32(a, b); }
TEXTPLANE_SIMD_INLINE vf mul(vf a, vf b) noexcept { return vmulq_f32(a, b); }
TEXTPLANE_SIMD_INLINE vf div(vf a, vf b) noexcept { return vdivq_f32(a, b); }
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
  y = mul(y, vrsqrtsq_f32(mul(a, y), y));
  return mul(y, vrsqrtsq_f32(mul(a, y), y));
}
TEXTPLANE_SIMD_INLINE vf abs_(vf a) noexcept { return vabsq_f32(a); }
TEXTPLANE_SIMD_INLINE vf neg(vf a) noexcept { return vnegq_f32(a); }
TEXTPLANE_SIMD_INLINE vf floor_(vf a) noexcept { return vrndmq_f32(a); }

// --- conversions ---
TEXTPLANE_SIMD_INLINE vi to_int(vf a) noexcept { return vcvtq_s32_f32(a); }
TEXTPLANE_SIMD_INLINE vf to_float(vi a) noexcept { return vcvtq_f32_s32(a); }

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
TEXTPLANE_SIMD_INLINE vm lti(vi a, vi b) noexcept { return vcltq_s32(a, b); }
TEXTPLANE_SIMD_INLINE vm gti(vi a, vi b) noexcept { return vcgtq_s32(a, b); }
TEXTPLANE_SIMD_INLINE vm eqi(vi a, vi b) noexcept { return vceqq_s32(a, b); }
TEXTPLANE_SIMD_INLINE vm and_(vm a, vm b) noexcept { return vandq_u32(a, b); }
TEXTPLANE_SIMD_INLINE vm or_(vm a, vm b) noexcept { return vorrq_u32(a, b); }
TEXTPLANE_SIMD_INLINE vm andnot_(vm a, vm b) noexcept { return vbicq_u32(b, a); }
TEXTPLANE_SIMD_INLINE vm not_(vm a) noexcept { return vmvnq_u32(a); }
TEXTPLANE_SIMD_INLINE vf select(vm m, vf a, vf b) noexcept { return vbslq_f32(m, a, b); }
TEXTPLANE_SIMD_INLINE vi selecti(vm m, vi a, vi b) noexcept { return vbslq_s32(m, a, b); }
TEXTPLANE_SIMD_INLINE vf keep(vm m, vf a) noexcept {
  return vreinterpretq_f32_u32(vandq_u32(m, vreinterpretq_u32_f32(a)));
}
TEXTPLANE_SIMD_INLINE vm first_n(int n) noexcept { return vcltq_s32(ioti(), seti(n)); }
TEXTPLANE_SIMD_INLINE unsigned bits(vm m) noexcept { return vaddvq_u32(vandq_u32(m, vm{1u, 2u, 4u, 8u})); }
TEXTPLANE_SIMD_INLINE int count(vm m) noexcept { return static_cast<int>(vaddvq_u32(vshrq_n_u32(m, 31))); }
TEXTPLANE_SIMD_INLINE bool any(vm m) noexcept { return vmaxvq_u32(m) != 0; }
TEXTPLANE_SIMD_INLINE bool all(vm m) noexcept { return vminvq_u32(m) != 0; }

// --- reductions ---
TEXTPLANE_SIMD_INLINE float hsum(vf a) noexcept {
  const float32x2_t two = vadd_f32(vget_low_f32(a), vget_high_f32(a));
  return vget_lane_f32(two, 0) + vget_lane_f32(two, 1);
}
TEXTPLANE_SIMD_INLINE double hsum_d(vf a) noexcept {
  const float64x2_t two = vaddq_f64(vcvt_f64_f32(vget_low_f32(a)), vcvt_high_f64_f32(a));
  return vgetq_lane_f64(two, 0) + vgetq_lane_f64(two, 1);
}
TEXTPLANE_SIMD_INLINE float hmin(vf a) noexcept { return vminvq_f32(a); }
TEXTPLANE_SIMD_INLINE float hmax(vf a) noexcept { return vmaxvq_f32(a); }

// --- bilinear taps ---
struct taps_t {
  uint32x4_t words;
};
TEXTPLANE_SIMD_INLINE taps_t load_taps(const std::uint32_t* p) noexcept { return taps_t{vld1q_u32(p)}; }
TEXTPLANE_SIMD_INLINE vi tap_00(taps_t t) noexcept {
  return vreinterpretq_s32_u32(vandq_u32(t.words, vdupq_n_u32(255u)));
}
TEXTPLANE_SIMD_INLINE vi tap_10(taps_t t) noexcept {
  return vreinterpretq_s32_u32(vandq_u32(vshrq_n_u32(t.words, 8), vdupq_n_u32(255u)));
}
TEXTPLANE_SIMD_INLINE vi tap_01(taps_t t) noexcept {
  return vreinterpretq_s32_u32(vandq_u32(vshrq_n_u32(t.words, 16), vdupq_n_u32(255u)));
}
TEXTPLANE_SIMD_INLINE vi tap_11(taps_t t) noexcept { return vreinterpretq_s32_u32(vshrq_n_u32(t.words, 24)); }
TEXTPLANE_SIMD_INLINE vf tap_value(taps_t t) noexcept { return vcvtq_f32_s32(tap_00(t)); }
TEXTPLANE_SIMD_INLINE vf tap_dx(taps_t t) noexcept { return vcvtq_f32_s32(vsubq_s32(tap_10(t), tap_00(t))); }
TEXTPLANE_SIMD_INLINE vf tap_dy(taps_t t) noexcept { return vcvtq_f32_s32(vsubq_s32(tap_01(t), tap_00(t))); }
TEXTPLANE_SIMD_INLINE vf tap_dxy(taps_t t) noexcept {
  return vcvtq_f32_s32(vsubq_s32(vsubq_s32(tap_11(t), tap_01(t)), vsubq_s32(tap_10(t), tap_00(t))));
}

// --- one double, one word ---
TEXTPLANE_SIMD_INLINE double sqrt_d(double a) noexcept { return vget_lane_f64(vsqrt_f64(vdup_n_f64(a)), 0); }
TEXTPLANE_SIMD_INLINE int lowest_bit(std::uint64_t word) noexcept { return __builtin_ctzll(word); }

// --- 8 doubles ---
struct vd {
  float64x2_t part[4];
};
TEXTPLANE_SIMD_INLINE vd loadd(const double* p) noexcept {
  return vd{{vld1q_f64(p), vld1q_f64(p + 2), vld1q_f64(p + 4), vld1q_f64(p + 6)}};
}
TEXTPLANE_SIMD_INLINE void stored(double* p, vd a) noexcept {
  vst1q_f64(p, a.part[0]);
  vst1q_f64(p + 2, a.part[1]);
  vst1q_f64(p + 4, a.part[2]);
  vst1q_f64(p + 6, a.part[3]);
}
TEXTPLANE_SIMD_INLINE vd setd(double value) noexcept {
  const float64x2_t v = vdupq_n_f64(value);
  return vd{{v, v, v, v}};
}
TEXTPLANE_SIMD_INLINE vd muld(vd a, vd b) noexcept {
  return vd{{vmulq_f64(a.part[0], b.part[0]), vmulq_f64(a.part[1], b.part[1]), vmulq_f64(a.part[2], b.part[2]),
             vmulq_f64(a.part[3], b.part[3])}};
}
TEXTPLANE_SIMD_INLINE vd maddd(vd a, vd b, vd c) noexcept {
  return vd{{vfmaq_f64(c.part[0], a.part[0], b.part[0]), vfmaq_f64(c.part[1], a.part[1], b.part[1]),
             vfmaq_f64(c.part[2], a.part[2], b.part[2]), vfmaq_f64(c.part[3], a.part[3], b.part[3])}};
}

TEXTPLANE_SIMD_INLINE void hsum4(vf a, vf b, vf c, vf d, float* out) noexcept {
  vst1q_f32(out, vpaddq_f32(vpaddq_f32(a, b), vpaddq_f32(c, d)));
}
TEXTPLANE_SIMD_INLINE vd hsum8(const float* p) noexcept {
  const float32x4_t q = vpaddq_f32(vpaddq_f32(load(p), load(p + 4)), vpaddq_f32(load(p + 8), load(p + 12)));
  const float32x4_t r = vpaddq_f32(vpaddq_f32(load(p + 16), load(p + 20)), vpaddq_f32(load(p + 24), load(p + 28)));
  return vd{{vcvt_f64_f32(vget_low_f32(q)), vcvt_high_f64_f32(q), vcvt_f64_f32(vget_low_f32(r)), vcvt_high_f64_f32(r)}};
}
