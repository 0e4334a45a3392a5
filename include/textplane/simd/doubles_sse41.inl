// Two doubles. The operations are defined in doubles_scalar.inl.

enum : int { kDoubles = 2 };
using vp = __m128d;

TEXTPLANE_SIMD_INLINE vp set_p(double value) noexcept { return _mm_set1_pd(value); }
TEXTPLANE_SIMD_INLINE vp load_p(const double* p) noexcept { return _mm_loadu_pd(p); }
TEXTPLANE_SIMD_INLINE vp from_p(const double* const* p, std::ptrdiff_t at) noexcept {
  return _mm_loadh_pd(_mm_load_sd(p[0] + at), p[1] + at);
}
TEXTPLANE_SIMD_INLINE void store_p(double* p, vp v) noexcept { _mm_storeu_pd(p, v); }
TEXTPLANE_SIMD_INLINE vp add_p(vp a, vp b) noexcept { return _mm_add_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp sub_p(vp a, vp b) noexcept { return _mm_sub_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp mul_p(vp a, vp b) noexcept { return _mm_mul_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp div_p(vp a, vp b) noexcept { return _mm_div_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp madd_p(vp a, vp b, vp c) noexcept { return _mm_add_pd(_mm_mul_pd(a, b), c); }
TEXTPLANE_SIMD_INLINE vp min_p(vp a, vp b) noexcept { return _mm_min_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp max_p(vp a, vp b) noexcept { return _mm_max_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp abs_p(vp a) noexcept { return _mm_andnot_pd(_mm_set1_pd(-0.0), a); }
TEXTPLANE_SIMD_INLINE vp trunc_p(vp a) noexcept { return _mm_round_pd(a, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC); }
TEXTPLANE_SIMD_INLINE vp positive_p(vp m, vp a, vp b) noexcept {
  return _mm_blendv_pd(b, a, _mm_cmpgt_pd(m, _mm_setzero_pd()));
}
TEXTPLANE_SIMD_INLINE void store_as_float(float* p, vp v) noexcept {
  _mm_storel_epi64(reinterpret_cast<__m128i*>(p), _mm_castps_si128(_mm_cvtpd_ps(v)));
}
