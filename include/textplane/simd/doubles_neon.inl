// Two doubles. The operations are defined in doubles_scalar.inl.

enum : int { kDoubles = 2 };
using vp = float64x2_t;

TEXTPLANE_SIMD_INLINE vp set_p(double value) noexcept { return vdupq_n_f64(value); }
TEXTPLANE_SIMD_INLINE vp load_p(const double* p) noexcept { return vld1q_f64(p); }
TEXTPLANE_SIMD_INLINE vp from_p(const double* const* p, std::ptrdiff_t at) noexcept {
  return vld1q_lane_f64(p[1] + at, vld1q_dup_f64(p[0] + at), 1);
}
TEXTPLANE_SIMD_INLINE void store_p(double* p, vp v) noexcept { vst1q_f64(p, v); }
TEXTPLANE_SIMD_INLINE vp add_p(vp a, vp b) noexcept { return vaddq_f64(a, b); }
TEXTPLANE_SIMD_INLINE vp sub_p(vp a, vp b) noexcept { return vsubq_f64(a, b); }
TEXTPLANE_SIMD_INLINE vp mul_p(vp a, vp b) noexcept { return vmulq_f64(a, b); }
TEXTPLANE_SIMD_INLINE vp div_p(vp a, vp b) noexcept { return vdivq_f64(a, b); }
TEXTPLANE_SIMD_INLINE vp madd_p(vp a, vp b, vp c) noexcept { return vfmaq_f64(c, a, b); }
TEXTPLANE_SIMD_INLINE vp min_p(vp a, vp b) noexcept { return vbslq_f64(vcltq_f64(a, b), a, b); }
TEXTPLANE_SIMD_INLINE vp max_p(vp a, vp b) noexcept { return vbslq_f64(vcgtq_f64(a, b), a, b); }
TEXTPLANE_SIMD_INLINE vp abs_p(vp a) noexcept { return vabsq_f64(a); }
TEXTPLANE_SIMD_INLINE vp trunc_p(vp a) noexcept { return vrndq_f64(a); }
TEXTPLANE_SIMD_INLINE vp positive_p(vp m, vp a, vp b) noexcept { return vbslq_f64(vcgtq_f64(m, vdupq_n_f64(0)), a, b); }
TEXTPLANE_SIMD_INLINE void store_as_float(float* p, vp v) noexcept { vst1_f32(p, vcvt_f32_f64(v)); }
