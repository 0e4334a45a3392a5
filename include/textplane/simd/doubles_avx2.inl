// Four doubles. The operations are defined in doubles_scalar.inl.

enum : int { kDoubles = 4 };
using vp = __m256d;

TEXTPLANE_SIMD_INLINE vp set_p(double value) noexcept { return _mm256_set1_pd(value); }
TEXTPLANE_SIMD_INLINE vp load_p(const double* p) noexcept { return _mm256_loadu_pd(p); }
TEXTPLANE_SIMD_INLINE vp from_p(const double* const* p, std::ptrdiff_t at) noexcept {
  const __m128d low = _mm_loadh_pd(_mm_load_sd(p[0] + at), p[1] + at);
  return _mm256_insertf128_pd(_mm256_castpd128_pd256(low), _mm_loadh_pd(_mm_load_sd(p[2] + at), p[3] + at), 1);
}
TEXTPLANE_SIMD_INLINE void store_p(double* p, vp v) noexcept { _mm256_storeu_pd(p, v); }
TEXTPLANE_SIMD_INLINE vp add_p(vp a, vp b) noexcept { return _mm256_add_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp sub_p(vp a, vp b) noexcept { return _mm256_sub_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp mul_p(vp a, vp b) noexcept { return _mm256_mul_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp div_p(vp a, vp b) noexcept { return _mm256_div_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp madd_p(vp a, vp b, vp c) noexcept { return _mm256_fmadd_pd(a, b, c); }
TEXTPLANE_SIMD_INLINE vp min_p(vp a, vp b) noexcept { return _mm256_min_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp max_p(vp a, vp b) noexcept { return _mm256_max_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp abs_p(vp a) noexcept { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
TEXTPLANE_SIMD_INLINE vp trunc_p(vp a) noexcept { return _mm256_round_pd(a, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC); }
TEXTPLANE_SIMD_INLINE vp positive_p(vp m, vp a, vp b) noexcept {
  return _mm256_blendv_pd(b, a, _mm256_cmp_pd(m, _mm256_setzero_pd(), _CMP_GT_OQ));
}
TEXTPLANE_SIMD_INLINE void store_as_float(float* p, vp v) noexcept { _mm_storeu_ps(p, _mm256_cvtpd_ps(v)); }
