// Vectors of eight lanes in AVX2 and FMA. vec_scalar.inl defines the operations.

constexpr int kLanes = 8;
constexpr bool kManyRegisters = false;
using vf = __m256;
using vi = __m256i;
using vm = __m256;  // all bits of a lane

// --- make, load, store ---
TEXTPLANE_SIMD_INLINE vf set1(float value) noexcept { return _mm256_set1_ps(value); }
TEXTPLANE_SIMD_INLINE vi seti(int value) noexcept { return _mm256_set1_epi32(value); }
TEXTPLANE_SIMD_INLINE vf zero() noexcept { return _mm256_setzero_ps(); }
TEXTPLANE_SIMD_INLINE vf iota() noexcept { return _mm256_setr_ps(0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f); }
TEXTPLANE_SIMD_INLINE vi ioti() noexcept { return _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7); }
TEXTPLANE_SIMD_INLINE __m256i first_n_bits(int n) noexcept { return _mm256_cmpgt_epi32(_mm256_set1_epi32(n), ioti()); }
TEXTPLANE_SIMD_INLINE vf load(const float* p) noexcept { return _mm256_loadu_ps(p); }
TEXTPLANE_SIMD_INLINE vf hold(vf v) noexcept {
  __asm__("" : "+x"(v));
  return v;
}
TEXTPLANE_SIMD_INLINE void store(float* p, vf v) noexcept { _mm256_storeu_ps(p, v); }
TEXTPLANE_SIMD_INLINE vi loadi(const int* p) noexcept {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
}
TEXTPLANE_SIMD_INLINE void storei(int* p, vi v) noexcept { _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), v); }
TEXTPLANE_SIMD_INLINE vf load_n(const float* p, int n) noexcept { return _mm256_maskload_ps(p, first_n_bits(n)); }
TEXTPLANE_SIMD_INLINE vi loadi_n(const int* p, int n) noexcept { return _mm256_maskload_epi32(p, first_n_bits(n)); }
// Masked stores are microcode on AMD: halves and quarters instead.
TEXTPLANE_SIMD_INLINE void store_n(float* p, vf v, int n) noexcept {
  if (n >= 8) {
    _mm256_storeu_ps(p, v);
    return;
  }
  __m128 rest = _mm256_castps256_ps128(v);
  if ((n & 4) != 0) {
    _mm_storeu_ps(p, rest);
    rest = _mm256_extractf128_ps(v, 1);
    p += 4;
  }
  if ((n & 2) != 0) {
    _mm_storel_pi(reinterpret_cast<__m64*>(p), rest);
    rest = _mm_movehl_ps(rest, rest);
    p += 2;
  }
  if ((n & 1) != 0) _mm_store_ss(p, rest);
}
TEXTPLANE_SIMD_INLINE void storei_n(int* p, vi v, int n) noexcept {
  store_n(reinterpret_cast<float*>(p), _mm256_castsi256_ps(v), n);
}
// Sooner than the instruction.
TEXTPLANE_SIMD_INLINE __m128 gather_four(const float* p, const int* at) noexcept {
  return _mm_setr_ps(p[at[0]], p[at[1]], p[at[2]], p[at[3]]);
}
TEXTPLANE_SIMD_INLINE vf gather(const float* p, const int* at) noexcept {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(gather_four(p, at)), gather_four(p, at + 4), 1);
}
TEXTPLANE_SIMD_INLINE vi load_u8i(const std::uint8_t* p) noexcept {
  return _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p)));
}
TEXTPLANE_SIMD_INLINE vf load_u8(const std::uint8_t* p) noexcept { return _mm256_cvtepi32_ps(load_u8i(p)); }
TEXTPLANE_SIMD_INLINE vi load_u8i_n(const std::uint8_t* p, int n) noexcept {
  const bool half = n >= 4;
  const unsigned low = half ? load_word(p) : load_word_n(p, n);
  const unsigned high = half ? load_word_n(p + 4, n - 4) : 0u;
  return _mm256_cvtepu8_epi32(_mm_setr_epi32(static_cast<int>(low), static_cast<int>(high), 0, 0));
}
TEXTPLANE_SIMD_INLINE vf load_u8_n(const std::uint8_t* p, int n) noexcept {
  return _mm256_cvtepi32_ps(load_u8i_n(p, n));
}

// --- float arithmetic ---
TEXTPLANE_SIMD_INLINE vf add(vf a, vf b) noexcept { return _mm256_add_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf sub(vf a, vf b) noexcept { return _mm256_sub_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf mul(vf a, vf b) noexcept { return _mm256_mul_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf div(vf a, vf b) noexcept { return _mm256_div_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf madd(vf a, vf b, vf c) noexcept { return _mm256_fmadd_ps(a, b, c); }
TEXTPLANE_SIMD_INLINE vf nmadd(vf a, vf b, vf c) noexcept { return _mm256_fnmadd_ps(a, b, c); }
#if TEXTPLANE_SIMD_HIDE_MINIMA
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept {
  __asm__("vminps %2, %1, %0" : "=x"(a) : "x"(a), "x"(b));
  return a;
}
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept {
  __asm__("vmaxps %2, %1, %0" : "=x"(a) : "x"(a), "x"(b));
  return a;
}
#else
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept { return _mm256_min_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept { return _mm256_max_ps(a, b); }
#endif
TEXTPLANE_SIMD_INLINE vf sqrt_(vf a) noexcept { return _mm256_sqrt_ps(a); }
TEXTPLANE_SIMD_INLINE vf inverse_root(vf a) noexcept {
  const vf y = _mm256_rsqrt_ps(a);
  return mul(y, nmadd(mul(mul(set1(0.5f), a), y), y, set1(1.5f)));
}
TEXTPLANE_SIMD_INLINE vf abs_(vf a) noexcept { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
TEXTPLANE_SIMD_INLINE vf neg(vf a) noexcept { return _mm256_xor_ps(_mm256_set1_ps(-0.0f), a); }
TEXTPLANE_SIMD_INLINE vf floor_(vf a) noexcept { return _mm256_floor_ps(a); }

// --- conversions ---
TEXTPLANE_SIMD_INLINE vi to_int(vf a) noexcept { return _mm256_cvttps_epi32(a); }
TEXTPLANE_SIMD_INLINE vf to_float(vi a) noexcept { return _mm256_cvtepi32_ps(a); }

// --- int32 arithmetic ---
TEXTPLANE_SIMD_INLINE vi addi(vi a, vi b) noexcept { return _mm256_add_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi subi(vi a, vi b) noexcept { return _mm256_sub_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi muli(vi a, vi b) noexcept { return _mm256_mullo_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi mini(vi a, vi b) noexcept { return _mm256_min_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi maxi(vi a, vi b) noexcept { return _mm256_max_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi shl(vi a, int bits) noexcept { return _mm256_sll_epi32(a, _mm_cvtsi32_si128(bits)); }
TEXTPLANE_SIMD_INLINE vi shr(vi a, int bits) noexcept { return _mm256_sra_epi32(a, _mm_cvtsi32_si128(bits)); }
TEXTPLANE_SIMD_INLINE vi andi(vi a, vi b) noexcept { return _mm256_and_si256(a, b); }
TEXTPLANE_SIMD_INLINE vi ori(vi a, vi b) noexcept { return _mm256_or_si256(a, b); }

// --- masks ---
TEXTPLANE_SIMD_INLINE vm lt(vf a, vf b) noexcept { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
TEXTPLANE_SIMD_INLINE vm le(vf a, vf b) noexcept { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
TEXTPLANE_SIMD_INLINE vm gt(vf a, vf b) noexcept { return _mm256_cmp_ps(a, b, _CMP_GT_OQ); }
TEXTPLANE_SIMD_INLINE vm ge(vf a, vf b) noexcept { return _mm256_cmp_ps(a, b, _CMP_GE_OQ); }
TEXTPLANE_SIMD_INLINE vm eq(vf a, vf b) noexcept { return _mm256_cmp_ps(a, b, _CMP_EQ_OQ); }
TEXTPLANE_SIMD_INLINE vm lti(vi a, vi b) noexcept { return _mm256_castsi256_ps(_mm256_cmpgt_epi32(b, a)); }
TEXTPLANE_SIMD_INLINE vm gti(vi a, vi b) noexcept { return _mm256_castsi256_ps(_mm256_cmpgt_epi32(a, b)); }
TEXTPLANE_SIMD_INLINE vm eqi(vi a, vi b) noexcept { return _mm256_castsi256_ps(_mm256_cmpeq_epi32(a, b)); }
TEXTPLANE_SIMD_INLINE vm and_(vm a, vm b) noexcept { return _mm256_and_ps(a, b); }
TEXTPLANE_SIMD_INLINE vm or_(vm a, vm b) noexcept { return _mm256_or_ps(a, b); }
TEXTPLANE_SIMD_INLINE vm andnot_(vm a, vm b) noexcept { return _mm256_andnot_ps(a, b); }
TEXTPLANE_SIMD_INLINE vm not_(vm a) noexcept { return _mm256_xor_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32(-1))); }
TEXTPLANE_SIMD_INLINE vf select(vm m, vf a, vf b) noexcept { return _mm256_blendv_ps(b, a, m); }
TEXTPLANE_SIMD_INLINE vi selecti(vm m, vi a, vi b) noexcept { return _mm256_blendv_epi8(b, a, _mm256_castps_si256(m)); }
TEXTPLANE_SIMD_INLINE vf keep(vm m, vf a) noexcept { return _mm256_and_ps(m, a); }
TEXTPLANE_SIMD_INLINE vm first_n(int n) noexcept { return _mm256_castsi256_ps(first_n_bits(n)); }
TEXTPLANE_SIMD_INLINE unsigned bits(vm m) noexcept { return static_cast<unsigned>(_mm256_movemask_ps(m)); }
TEXTPLANE_SIMD_INLINE int count(vm m) noexcept { return _mm_popcnt_u32(bits(m)); }
TEXTPLANE_SIMD_INLINE bool any(vm m) noexcept { return bits(m) != 0; }
TEXTPLANE_SIMD_INLINE bool all(vm m) noexcept { return bits(m) == 255u; }

// --- reductions ---
TEXTPLANE_SIMD_INLINE float hsum(vf a) noexcept {
  const __m128 four = _mm_add_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
  const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
}
TEXTPLANE_SIMD_INLINE double hsum_d(vf a) noexcept {
  const __m256d four =
      _mm256_add_pd(_mm256_cvtps_pd(_mm256_castps256_ps128(a)), _mm256_cvtps_pd(_mm256_extractf128_ps(a, 1)));
  const __m128d two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
  return _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)));
}
TEXTPLANE_SIMD_INLINE float hmin(vf a) noexcept {
  const __m128 four = _mm_min_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
  const __m128 two = _mm_min_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_min_ss(two, _mm_shuffle_ps(two, two, 1)));
}
TEXTPLANE_SIMD_INLINE float hmax(vf a) noexcept {
  const __m128 four = _mm_max_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
  const __m128 two = _mm_max_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps(two, two, 1)));
}

// --- bilinear taps ---
struct taps_t {
  __m256i words;
};
TEXTPLANE_SIMD_INLINE taps_t load_taps(const std::uint32_t* p) noexcept {
  return taps_t{_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))};
}
// The sum of the four bytes of each word times the four signed bytes of `weights`: products of a pair fit 16 bits.
TEXTPLANE_SIMD_INLINE vf tap_dot(taps_t t, int weights) noexcept {
  const __m256i pairs = _mm256_maddubs_epi16(t.words, _mm256_set1_epi32(weights));
  return _mm256_cvtepi32_ps(_mm256_madd_epi16(pairs, _mm256_set1_epi16(1)));
}
TEXTPLANE_SIMD_INLINE vf tap_value(taps_t t) noexcept {
  return _mm256_cvtepi32_ps(_mm256_and_si256(t.words, _mm256_set1_epi32(255)));
}
TEXTPLANE_SIMD_INLINE vf tap_dx(taps_t t) noexcept { return tap_dot(t, 0x000001ff); }
TEXTPLANE_SIMD_INLINE vf tap_dy(taps_t t) noexcept { return tap_dot(t, 0x000100ff); }
TEXTPLANE_SIMD_INLINE vf tap_dxy(taps_t t) noexcept { return tap_dot(t, 0x01ffff01); }

// --- one double, one word ---
TEXTPLANE_SIMD_INLINE double sqrt_d(double a) noexcept { return _mm_cvtsd_f64(_mm_sqrt_pd(_mm_set1_pd(a))); }
TEXTPLANE_SIMD_INLINE int lowest_bit(std::uint64_t word) noexcept { return __builtin_ctzll(word); }

// --- 8 doubles ---
struct vd {
  __m256d low, high;
};
TEXTPLANE_SIMD_INLINE vd loadd(const double* p) noexcept { return vd{_mm256_loadu_pd(p), _mm256_loadu_pd(p + 4)}; }
TEXTPLANE_SIMD_INLINE void stored(double* p, vd a) noexcept {
  _mm256_storeu_pd(p, a.low);
  _mm256_storeu_pd(p + 4, a.high);
}
TEXTPLANE_SIMD_INLINE vd setd(double value) noexcept {
  const __m256d v = _mm256_set1_pd(value);
  return vd{v, v};
}
TEXTPLANE_SIMD_INLINE vd muld(vd a, vd b) noexcept {
  return vd{_mm256_mul_pd(a.low, b.low), _mm256_mul_pd(a.high, b.high)};
}
TEXTPLANE_SIMD_INLINE vd maddd(vd a, vd b, vd c) noexcept {
  return vd{_mm256_fmadd_pd(a.low, b.low, c.low), _mm256_fmadd_pd(a.high, b.high, c.high)};
}

TEXTPLANE_SIMD_INLINE void hsum4(vf a, vf b, vf c, vf d, float* out) noexcept {
  const __m256 s = join_pairs(join_lanes(a, b), join_lanes(c, d));
  _mm_storeu_ps(out, _mm_add_ps(_mm256_castps256_ps128(s), _mm256_extractf128_ps(s, 1)));
}
TEXTPLANE_SIMD_INLINE vd hsum8(const float* p) noexcept {
  const __m256 q = join_pairs(join_lanes(load(p), load(p + 8)), join_lanes(load(p + 16), load(p + 24)));
  const __m256 r = join_pairs(join_lanes(load(p + 32), load(p + 40)), join_lanes(load(p + 48), load(p + 56)));
  const __m256 s = join_halves(q, r);
  return vd{_mm256_cvtps_pd(_mm256_castps256_ps128(s)), _mm256_cvtps_pd(_mm256_extractf128_ps(s, 1))};
}
