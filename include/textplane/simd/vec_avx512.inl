// Vectors of sixteen lanes in AVX-512 (F, BW, DQ, VL, VNNI). vec_scalar.inl defines the operations.
//
// The zero-masking forms stand where the plain ones start from an undefined register in the compiler's header, about which
// g++ 11 and 12 warn; with all lanes kept they are the same instructions.

constexpr int kLanes = 16;
constexpr bool kManyRegisters = true;  // 32
using vf = __m512;
using vi = __m512i;
using vm = __mmask16;
constexpr vm kAllLanes = 0xffff;

// --- make, load, store ---
TEXTPLANE_SIMD_INLINE vf set1(float value) noexcept { return _mm512_set1_ps(value); }
TEXTPLANE_SIMD_INLINE vi seti(int value) noexcept { return _mm512_set1_epi32(value); }
TEXTPLANE_SIMD_INLINE vf zero() noexcept { return _mm512_setzero_ps(); }
TEXTPLANE_SIMD_INLINE vf iota() noexcept {
  return _mm512_set_ps(15.0f, 14.0f, 13.0f, 12.0f, 11.0f, 10.0f, 9.0f, 8.0f, 7.0f, 6.0f, 5.0f, 4.0f, 3.0f, 2.0f, 1.0f,
                       0.0f);
}
TEXTPLANE_SIMD_INLINE vi ioti() noexcept {
  return _mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
}
TEXTPLANE_SIMD_INLINE vm first_n(int n) noexcept {
  return n >= 16 ? kAllLanes : static_cast<vm>((1u << (n < 0 ? 0 : n)) - 1u);
}
TEXTPLANE_SIMD_INLINE vf load(const float* p) noexcept { return _mm512_loadu_ps(p); }
TEXTPLANE_SIMD_INLINE vf hold(vf v) noexcept {
#if !defined(TEXTPLANE_EMULATED_AVX512)
  __asm__("" : "+v"(v));
#endif
  return v;
}
TEXTPLANE_SIMD_INLINE void store(float* p, vf v) noexcept { _mm512_storeu_ps(p, v); }
TEXTPLANE_SIMD_INLINE vi loadi(const int* p) noexcept { return _mm512_loadu_si512(p); }
TEXTPLANE_SIMD_INLINE void storei(int* p, vi v) noexcept { _mm512_storeu_si512(p, v); }
TEXTPLANE_SIMD_INLINE vf load_n(const float* p, int n) noexcept { return _mm512_maskz_loadu_ps(first_n(n), p); }
TEXTPLANE_SIMD_INLINE void store_n(float* p, vf v, int n) noexcept { _mm512_mask_storeu_ps(p, first_n(n), v); }
TEXTPLANE_SIMD_INLINE vi loadi_n(const int* p, int n) noexcept { return _mm512_maskz_loadu_epi32(first_n(n), p); }
TEXTPLANE_SIMD_INLINE void storei_n(int* p, vi v, int n) noexcept { _mm512_mask_storeu_epi32(p, first_n(n), v); }
// Sooner than the instruction.
TEXTPLANE_SIMD_INLINE __m256i gather_eight(const float* p, const int* at) noexcept {
  return _mm256_castps_si256(
      _mm256_setr_ps(p[at[0]], p[at[1]], p[at[2]], p[at[3]], p[at[4]], p[at[5]], p[at[6]], p[at[7]]));
}
TEXTPLANE_SIMD_INLINE vf gather(const float* p, const int* at) noexcept {
  const __m512i low = _mm512_castsi256_si512(gather_eight(p, at));
  return _mm512_castsi512_ps(_mm512_maskz_inserti64x4(0xff, low, gather_eight(p, at + 8), 1));
}
TEXTPLANE_SIMD_INLINE vf to_float(vi a) noexcept { return _mm512_maskz_cvtepi32_ps(kAllLanes, a); }
TEXTPLANE_SIMD_INLINE vi load_u8i(const std::uint8_t* p) noexcept {
  return _mm512_maskz_cvtepu8_epi32(kAllLanes, _mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
}
TEXTPLANE_SIMD_INLINE vf load_u8(const std::uint8_t* p) noexcept { return to_float(load_u8i(p)); }
TEXTPLANE_SIMD_INLINE vi load_u8i_n(const std::uint8_t* p, int n) noexcept {
  return _mm512_maskz_cvtepu8_epi32(kAllLanes, _mm_maskz_loadu_epi8(first_n(n), p));
}
TEXTPLANE_SIMD_INLINE vf load_u8_n(const std::uint8_t* p, int n) noexcept { return to_float(load_u8i_n(p, n)); }

// --- float arithmetic ---
TEXTPLANE_SIMD_INLINE vf add(vf a, vf b) noexcept { return _mm512_add_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf sub(vf a, vf b) noexcept { return _mm512_sub_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf mul(vf a, vf b) noexcept { return _mm512_mul_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf div(vf a, vf b) noexcept { return _mm512_div_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf madd(vf a, vf b, vf c) noexcept { return _mm512_fmadd_ps(a, b, c); }
TEXTPLANE_SIMD_INLINE vf nmadd(vf a, vf b, vf c) noexcept { return _mm512_fnmadd_ps(a, b, c); }
#if TEXTPLANE_SIMD_HIDE_MINIMA
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept {
  __asm__("vminps %2, %1, %0" : "=v"(a) : "v"(a), "v"(b));
  return a;
}
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept {
  __asm__("vmaxps %2, %1, %0" : "=v"(a) : "v"(a), "v"(b));
  return a;
}
#else
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept { return _mm512_maskz_min_ps(kAllLanes, a, b); }
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept { return _mm512_maskz_max_ps(kAllLanes, a, b); }
#endif
TEXTPLANE_SIMD_INLINE vf sqrt_(vf a) noexcept { return _mm512_maskz_sqrt_ps(kAllLanes, a); }
TEXTPLANE_SIMD_INLINE vf inverse_root(vf a) noexcept {
  const vf y = _mm512_maskz_rsqrt14_ps(kAllLanes, a);
  return mul(y, nmadd(mul(mul(set1(0.5f), a), y), y, set1(1.5f)));
}
TEXTPLANE_SIMD_INLINE vf abs_(vf a) noexcept { return _mm512_maskz_andnot_ps(kAllLanes, _mm512_set1_ps(-0.0f), a); }
TEXTPLANE_SIMD_INLINE vf neg(vf a) noexcept { return _mm512_maskz_xor_ps(kAllLanes, _mm512_set1_ps(-0.0f), a); }
TEXTPLANE_SIMD_INLINE vf floor_(vf a) noexcept {
  return _mm512_maskz_roundscale_ps(kAllLanes, a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}

// --- conversions ---
TEXTPLANE_SIMD_INLINE vi to_int(vf a) noexcept { return _mm512_maskz_cvttps_epi32(kAllLanes, a); }

// --- int32 arithmetic ---
TEXTPLANE_SIMD_INLINE vi addi(vi a, vi b) noexcept { return _mm512_add_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi subi(vi a, vi b) noexcept { return _mm512_sub_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi muli(vi a, vi b) noexcept { return _mm512_mullo_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi mini(vi a, vi b) noexcept { return _mm512_maskz_min_epi32(kAllLanes, a, b); }
TEXTPLANE_SIMD_INLINE vi maxi(vi a, vi b) noexcept { return _mm512_maskz_max_epi32(kAllLanes, a, b); }
TEXTPLANE_SIMD_INLINE vi shl(vi a, int bits) noexcept {
  return _mm512_maskz_sll_epi32(kAllLanes, a, _mm_cvtsi32_si128(bits));
}
TEXTPLANE_SIMD_INLINE vi shr(vi a, int bits) noexcept {
  return _mm512_maskz_sra_epi32(kAllLanes, a, _mm_cvtsi32_si128(bits));
}
TEXTPLANE_SIMD_INLINE vi andi(vi a, vi b) noexcept { return _mm512_and_si512(a, b); }
TEXTPLANE_SIMD_INLINE vi ori(vi a, vi b) noexcept { return _mm512_or_si512(a, b); }

// --- masks ---
TEXTPLANE_SIMD_INLINE vm lt(vf a, vf b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
TEXTPLANE_SIMD_INLINE vm le(vf a, vf b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
TEXTPLANE_SIMD_INLINE vm gt(vf a, vf b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_GT_OQ); }
TEXTPLANE_SIMD_INLINE vm ge(vf a, vf b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_GE_OQ); }
TEXTPLANE_SIMD_INLINE vm eq(vf a, vf b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
TEXTPLANE_SIMD_INLINE vm lti(vi a, vi b) noexcept { return _mm512_cmplt_epi32_mask(a, b); }
TEXTPLANE_SIMD_INLINE vm gti(vi a, vi b) noexcept { return _mm512_cmpgt_epi32_mask(a, b); }
TEXTPLANE_SIMD_INLINE vm eqi(vi a, vi b) noexcept { return _mm512_cmpeq_epi32_mask(a, b); }
TEXTPLANE_SIMD_INLINE vm and_(vm a, vm b) noexcept { return static_cast<vm>(a & b); }
TEXTPLANE_SIMD_INLINE vm or_(vm a, vm b) noexcept { return static_cast<vm>(a | b); }
TEXTPLANE_SIMD_INLINE vm andnot_(vm a, vm b) noexcept { return static_cast<vm>(~a & b); }
TEXTPLANE_SIMD_INLINE vm not_(vm a) noexcept { return static_cast<vm>(~a); }
TEXTPLANE_SIMD_INLINE vf select(vm m, vf a, vf b) noexcept { return _mm512_mask_blend_ps(m, b, a); }
TEXTPLANE_SIMD_INLINE vi selecti(vm m, vi a, vi b) noexcept { return _mm512_mask_blend_epi32(m, b, a); }
TEXTPLANE_SIMD_INLINE vf keep(vm m, vf a) noexcept { return _mm512_maskz_mov_ps(m, a); }
TEXTPLANE_SIMD_INLINE unsigned bits(vm m) noexcept { return m; }
TEXTPLANE_SIMD_INLINE int count(vm m) noexcept { return _mm_popcnt_u32(m); }
TEXTPLANE_SIMD_INLINE bool any(vm m) noexcept { return m != 0; }
TEXTPLANE_SIMD_INLINE bool all(vm m) noexcept { return m == kAllLanes; }

// --- reductions ---
TEXTPLANE_SIMD_INLINE __m256 lower_half(vf a) noexcept { return _mm512_maskz_extractf32x8_ps(0xff, a, 0); }
TEXTPLANE_SIMD_INLINE __m256 upper_half(vf a) noexcept { return _mm512_maskz_extractf32x8_ps(0xff, a, 1); }
TEXTPLANE_SIMD_INLINE float hsum(vf a) noexcept {
  const __m256 eight = _mm256_add_ps(lower_half(a), upper_half(a));
  const __m128 four = _mm_add_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
  const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
}
TEXTPLANE_SIMD_INLINE double hsum_d(vf a) noexcept {
  const __m512d eight =
      _mm512_add_pd(_mm512_maskz_cvtps_pd(0xff, lower_half(a)), _mm512_maskz_cvtps_pd(0xff, upper_half(a)));
  const __m256d four =
      _mm256_add_pd(_mm512_maskz_extractf64x4_pd(0xf, eight, 0), _mm512_maskz_extractf64x4_pd(0xf, eight, 1));
  const __m128d two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
  return _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)));
}
TEXTPLANE_SIMD_INLINE float hmin(vf a) noexcept {
  const __m256 eight = _mm256_min_ps(lower_half(a), upper_half(a));
  const __m128 four = _mm_min_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
  const __m128 two = _mm_min_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_min_ss(two, _mm_shuffle_ps(two, two, 1)));
}
TEXTPLANE_SIMD_INLINE float hmax(vf a) noexcept {
  const __m256 eight = _mm256_max_ps(lower_half(a), upper_half(a));
  const __m128 four = _mm_max_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
  const __m128 two = _mm_max_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps(two, two, 1)));
}

// --- bilinear taps ---
struct taps_t {
  __m512i words;
};
TEXTPLANE_SIMD_INLINE taps_t load_taps(const std::uint32_t* p) noexcept { return taps_t{_mm512_loadu_si512(p)}; }
// The sum of the four bytes of each word times the four signed bytes of `weights`.
TEXTPLANE_SIMD_INLINE vf tap_dot(taps_t t, int weights) noexcept {
  return to_float(_mm512_dpbusd_epi32(_mm512_setzero_si512(), t.words, _mm512_set1_epi32(weights)));
}
TEXTPLANE_SIMD_INLINE vf tap_value(taps_t t) noexcept {
  return to_float(_mm512_and_si512(t.words, _mm512_set1_epi32(255)));
}
TEXTPLANE_SIMD_INLINE vf tap_dx(taps_t t) noexcept { return tap_dot(t, 0x000001ff); }
TEXTPLANE_SIMD_INLINE vf tap_dy(taps_t t) noexcept { return tap_dot(t, 0x000100ff); }
TEXTPLANE_SIMD_INLINE vf tap_dxy(taps_t t) noexcept { return tap_dot(t, 0x01ffff01); }

// --- one double, one word ---
TEXTPLANE_SIMD_INLINE double sqrt_d(double a) noexcept { return _mm_cvtsd_f64(_mm_sqrt_pd(_mm_set1_pd(a))); }
TEXTPLANE_SIMD_INLINE int lowest_bit(std::uint64_t word) noexcept { return __builtin_ctzll(word); }

// --- 8 doubles ---
struct vd {
  __m512d all;
};
TEXTPLANE_SIMD_INLINE vd loadd(const double* p) noexcept { return vd{_mm512_loadu_pd(p)}; }
TEXTPLANE_SIMD_INLINE void stored(double* p, vd a) noexcept { _mm512_storeu_pd(p, a.all); }
TEXTPLANE_SIMD_INLINE vd setd(double value) noexcept { return vd{_mm512_set1_pd(value)}; }
TEXTPLANE_SIMD_INLINE vd muld(vd a, vd b) noexcept { return vd{_mm512_mul_pd(a.all, b.all)}; }
TEXTPLANE_SIMD_INLINE vd maddd(vd a, vd b, vd c) noexcept { return vd{_mm512_fmadd_pd(a.all, b.all, c.all)}; }

TEXTPLANE_SIMD_INLINE __m256 half_sum(vf a) noexcept { return _mm256_add_ps(lower_half(a), upper_half(a)); }
TEXTPLANE_SIMD_INLINE void hsum4(vf a, vf b, vf c, vf d, float* out) noexcept {
  const __m256 s = _mm256_hadd_ps(_mm256_hadd_ps(half_sum(a), half_sum(b)), _mm256_hadd_ps(half_sum(c), half_sum(d)));
  _mm_storeu_ps(out, _mm_add_ps(_mm256_castps256_ps128(s), _mm256_extractf128_ps(s, 1)));
}
TEXTPLANE_SIMD_INLINE __m256 half_sum_at(const float* p) noexcept {
  return _mm256_add_ps(_mm256_loadu_ps(p), _mm256_loadu_ps(p + 8));
}
TEXTPLANE_SIMD_INLINE vd hsum8(const float* p) noexcept {
  const __m256 a = join_lanes(half_sum_at(p), half_sum_at(p + 16)),
               b = join_lanes(half_sum_at(p + 32), half_sum_at(p + 48));
  const __m256 c = join_lanes(half_sum_at(p + 64), half_sum_at(p + 80)),
               d = join_lanes(half_sum_at(p + 96), half_sum_at(p + 112));
  const __m256 q = join_pairs(a, b), r = join_pairs(c, d);
  return vd{_mm512_maskz_cvtps_pd(0xff, join_halves(q, r))};
}
