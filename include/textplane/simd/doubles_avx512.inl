// Eight doubles. The operations are defined in doubles_scalar.inl.

enum : int { kDoubles = 8 };
using vp = __m512d;

TEXTPLANE_SIMD_INLINE vp set_p(double value) noexcept { return _mm512_set1_pd(value); }
TEXTPLANE_SIMD_INLINE vp load_p(const double* p) noexcept { return _mm512_loadu_pd(p); }
TEXTPLANE_SIMD_INLINE vp from_p(const double* const* p, std::ptrdiff_t at) noexcept {
  return _mm512_setr_pd(p[0][at], p[1][at], p[2][at], p[3][at], p[4][at], p[5][at], p[6][at], p[7][at]);
}
TEXTPLANE_SIMD_INLINE void store_p(double* p, vp v) noexcept { _mm512_storeu_pd(p, v); }
TEXTPLANE_SIMD_INLINE vp add_p(vp a, vp b) noexcept { return _mm512_add_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp sub_p(vp a, vp b) noexcept { return _mm512_sub_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp mul_p(vp a, vp b) noexcept { return _mm512_mul_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp div_p(vp a, vp b) noexcept { return _mm512_div_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp madd_p(vp a, vp b, vp c) noexcept { return _mm512_fmadd_pd(a, b, c); }
TEXTPLANE_SIMD_INLINE vp min_p(vp a, vp b) noexcept { return _mm512_maskz_min_pd(0xff, a, b); }
TEXTPLANE_SIMD_INLINE vp max_p(vp a, vp b) noexcept { return _mm512_maskz_max_pd(0xff, a, b); }
TEXTPLANE_SIMD_INLINE vp abs_p(vp a) noexcept {
  return _mm512_castsi512_pd(
      _mm512_maskz_and_epi64(0xff, _mm512_castpd_si512(a), _mm512_set1_epi64(0x7fffffffffffffffLL)));
}
TEXTPLANE_SIMD_INLINE vp trunc_p(vp a) noexcept { return _mm512_maskz_roundscale_pd(0xff, a, 0x0b); }
TEXTPLANE_SIMD_INLINE vp positive_p(vp m, vp a, vp b) noexcept {
  return _mm512_mask_blend_pd(_mm512_cmp_pd_mask(m, _mm512_setzero_pd(), _CMP_GT_OQ), b, a);
}
TEXTPLANE_SIMD_INLINE void store_as_float(float* p, vp v) noexcept {
  _mm256_storeu_ps(p, _mm512_maskz_cvtpd_ps(0xff, v));
}
