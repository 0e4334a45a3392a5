// Vectors of four lanes in SSE4.1. vec_scalar.inl defines the operations.

constexpr int kLanes = 4;
constexpr bool kManyRegisters = false;
using vf = __m128;
using vi = __m128i;
using vm = __m128;  // all bits of a lane

// --- make, load, store ---
TEXTPLANE_SIMD_INLINE vf set1(float value) noexcept { return _mm_set1_ps(value); }
TEXTPLANE_SIMD_INLINE vi seti(int value) noexcept { return _mm_set1_epi32(value); }
TEXTPLANE_SIMD_INLINE vf zero() noexcept { return _mm_setzero_ps(); }
TEXTPLANE_SIMD_INLINE vf iota() noexcept { return _mm_setr_ps(0.0f, 1.0f, 2.0f, 3.0f); }
TEXTPLANE_SIMD_INLINE vi ioti() noexcept { return _mm_setr_epi32(0, 1, 2, 3); }
TEXTPLANE_SIMD_INLINE vf load(const float* p) noexcept { return _mm_loadu_ps(p); }
TEXTPLANE_SIMD_INLINE vf hold(vf v) noexcept {
  __asm__("" : "+x"(v));
  return v;
}
TEXTPLANE_SIMD_INLINE void store(float* p, vf v) noexcept { _mm_storeu_ps(p, v); }
TEXTPLANE_SIMD_INLINE vi loadi(const int* p) noexcept { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p)); }
TEXTPLANE_SIMD_INLINE void storei(int* p, vi v) noexcept { _mm_storeu_si128(reinterpret_cast<__m128i*>(p), v); }
TEXTPLANE_SIMD_INLINE vf load_n(const float* p, int n) noexcept {
  if (n >= 4) return _mm_loadu_ps(p);
  if (n == 3) return _mm_setr_ps(p[0], p[1], p[2], 0.0f);
  if (n == 2) return _mm_setr_ps(p[0], p[1], 0.0f, 0.0f);
  return n == 1 ? _mm_load_ss(p) : _mm_setzero_ps();
}
TEXTPLANE_SIMD_INLINE void store_n(float* p, vf v, int n) noexcept {
  if (n >= 4) {
    _mm_storeu_ps(p, v);
    return;
  }
  if (n >= 1) _mm_store_ss(p, v);
  if (n >= 2) _mm_store_ss(p + 1, _mm_shuffle_ps(v, v, 1));
  if (n >= 3) _mm_store_ss(p + 2, _mm_movehl_ps(v, v));
}
TEXTPLANE_SIMD_INLINE vi loadi_n(const int* p, int n) noexcept {
  if (n >= 4) return loadi(p);
  if (n == 3) return _mm_setr_epi32(p[0], p[1], p[2], 0);
  if (n == 2) return _mm_setr_epi32(p[0], p[1], 0, 0);
  return n == 1 ? _mm_cvtsi32_si128(p[0]) : _mm_setzero_si128();
}
TEXTPLANE_SIMD_INLINE void storei_n(int* p, vi v, int n) noexcept {
  if (n >= 4) {
    storei(p, v);
    return;
  }
  if (n >= 1) p[0] = _mm_cvtsi128_si32(v);
  if (n >= 2) p[1] = _mm_extract_epi32(v, 1);
  if (n >= 3) p[2] = _mm_extract_epi32(v, 2);
}
TEXTPLANE_SIMD_INLINE vf gather(const float* p, const int* at) noexcept {
  return _mm_setr_ps(p[at[0]], p[at[1]], p[at[2]], p[at[3]]);
}
TEXTPLANE_SIMD_INLINE vi load_u8i(const std::uint8_t* p) noexcept {
  return _mm_cvtepu8_epi32(_mm_cvtsi32_si128(static_cast<int>(load_word(p))));
}
TEXTPLANE_SIMD_INLINE vf load_u8(const std::uint8_t* p) noexcept { return _mm_cvtepi32_ps(load_u8i(p)); }
TEXTPLANE_SIMD_INLINE vi load_u8i_n(const std::uint8_t* p, int n) noexcept {
  return _mm_cvtepu8_epi32(_mm_cvtsi32_si128(static_cast<int>(load_word_n(p, n))));
}
TEXTPLANE_SIMD_INLINE vf load_u8_n(const std::uint8_t* p, int n) noexcept { return _mm_cvtepi32_ps(load_u8i_n(p, n)); }

// --- float arithmetic ---
TEXTPLANE_SIMD_INLINE vf add(vf a, vf b) noexcept { return _mm_add_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf sub(vf a, vf b) noexcept { return _mm_sub_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf mul(vf a, vf b) noexcept { return _mm_mul_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf div(vf a, vf b) noexcept { return _mm_div_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf madd(vf a, vf b, vf c) noexcept { return _mm_add_ps(_mm_mul_ps(a, b), c); }
TEXTPLANE_SIMD_INLINE vf nmadd(vf a, vf b, vf c) noexcept { return _mm_sub_ps(c, _mm_mul_ps(a, b)); }
#if TEXTPLANE_SIMD_HIDE_MINIMA
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept {
  __asm__("minps %1, %0" : "+x"(a) : "x"(b));
  return a;
}
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept {
  __asm__("maxps %1, %0" : "+x"(a) : "x"(b));
  return a;
}
#else
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept { return _mm_min_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept { return _mm_max_ps(a, b); }
#endif
TEXTPLANE_SIMD_INLINE vf sqrt_(vf a) noexcept { return _mm_sqrt_ps(a); }
TEXTPLANE_SIMD_INLINE vf inverse_root(vf a) noexcept {
  const vf y = _mm_rsqrt_ps(a);
  return mul(y, nmadd(mul(mul(set1(0.5f), a), y), y, set1(1.5f)));
}
TEXTPLANE_SIMD_INLINE vf abs_(vf a) noexcept { return _mm_andnot_ps(_mm_set1_ps(-0.0f), a); }
TEXTPLANE_SIMD_INLINE vf neg(vf a) noexcept { return _mm_xor_ps(_mm_set1_ps(-0.0f), a); }
TEXTPLANE_SIMD_INLINE vf floor_(vf a) noexcept { return _mm_floor_ps(a); }

// --- conversions ---
TEXTPLANE_SIMD_INLINE vi to_int(vf a) noexcept { return _mm_cvttps_epi32(a); }
TEXTPLANE_SIMD_INLINE vf to_float(vi a) noexcept { return _mm_cvtepi32_ps(a); }

// --- int32 arithmetic ---
TEXTPLANE_SIMD_INLINE vi addi(vi a, vi b) noexcept { return _mm_add_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi subi(vi a, vi b) noexcept { return _mm_sub_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi muli(vi a, vi b) noexcept { return _mm_mullo_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi mini(vi a, vi b) noexcept { return _mm_min_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi maxi(vi a, vi b) noexcept { return _mm_max_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi shl(vi a, int bits) noexcept { return _mm_sll_epi32(a, _mm_cvtsi32_si128(bits)); }
TEXTPLANE_SIMD_INLINE vi shr(vi a, int bits) noexcept { return _mm_sra_epi32(a, _mm_cvtsi32_si128(bits)); }
TEXTPLANE_SIMD_INLINE vi andi(vi a, vi b) noexcept { return _mm_and_si128(a, b); }
TEXTPLANE_SIMD_INLINE vi ori(vi a, vi b) noexcept { return _mm_or_si128(a, b); }

// --- masks ---
TEXTPLANE_SIMD_INLINE vm lt(vf a, vf b) noexcept { return _mm_cmplt_ps(a, b); }
TEXTPLANE_SIMD_INLINE vm le(vf a, vf b) noexcept { return _mm_cmple_ps(a, b); }
TEXTPLANE_SIMD_INLINE vm gt(vf a, vf b) noexcept { return _mm_cmplt_ps(b, a); }
TEXTPLANE_SIMD_INLINE vm ge(vf a, vf b) noexcept { return _mm_cmple_ps(b, a); }
TEXTPLANE_SIMD_INLINE vm eq(vf a, vf b) noexcept { return _mm_cmpeq_ps(a, b); }
TEXTPLANE_SIMD_INLINE vm lti(vi a, vi b) noexcept { return _mm_castsi128_ps(_mm_cmpgt_epi32(b, a)); }
TEXTPLANE_SIMD_INLINE vm gti(vi a, vi b) noexcept { return _mm_castsi128_ps(_mm_cmpgt_epi32(a, b)); }
TEXTPLANE_SIMD_INLINE vm eqi(vi a, vi b) noexcept { return _mm_castsi128_ps(_mm_cmpeq_epi32(a, b)); }
TEXTPLANE_SIMD_INLINE vm and_(vm a, vm b) noexcept { return _mm_and_ps(a, b); }
TEXTPLANE_SIMD_INLINE vm or_(vm a, vm b) noexcept { return _mm_or_ps(a, b); }
TEXTPLANE_SIMD_INLINE vm andnot_(vm a, vm b) noexcept { return _mm_andnot_ps(a, b); }
TEXTPLANE_SIMD_INLINE vm not_(vm a) noexcept { return _mm_xor_ps(a, _mm_castsi128_ps(_mm_set1_epi32(-1))); }
TEXTPLANE_SIMD_INLINE vf select(vm m, vf a, vf b) noexcept { return _mm_blendv_ps(b, a, m); }
TEXTPLANE_SIMD_INLINE vi selecti(vm m, vi a, vi b) noexcept { return _mm_blendv_epi8(b, a, _mm_castps_si128(m)); }
TEXTPLANE_SIMD_INLINE vf keep(vm m, vf a) noexcept { return _mm_and_ps(m, a); }
TEXTPLANE_SIMD_INLINE vm first_n(int n) noexcept { return lti(ioti(), seti(n)); }
TEXTPLANE_SIMD_INLINE unsigned bits(vm m) noexcept { return static_cast<unsigned>(_mm_movemask_ps(m)); }
TEXTPLANE_SIMD_INLINE int count(vm m) noexcept {
  // The number of ones in four bits, from a table in a word: SSE4.1 has no popcnt.
  return static_cast<int>((0x4332322132212110ull >> (4 * bits(m))) & 15u);
}
TEXTPLANE_SIMD_INLINE bool any(vm m) noexcept { return bits(m) != 0; }
TEXTPLANE_SIMD_INLINE bool all(vm m) noexcept { return bits(m) == 15u; }

// --- reductions ---
TEXTPLANE_SIMD_INLINE float hsum(vf a) noexcept {
  const __m128 two = _mm_add_ps(a, _mm_movehl_ps(a, a));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
}
TEXTPLANE_SIMD_INLINE double hsum_d(vf a) noexcept {
  const __m128d two = _mm_add_pd(_mm_cvtps_pd(a), _mm_cvtps_pd(_mm_movehl_ps(a, a)));
  return _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)));
}
TEXTPLANE_SIMD_INLINE float hmin(vf a) noexcept {
  const __m128 two = _mm_min_ps(a, _mm_movehl_ps(a, a));
  return _mm_cvtss_f32(_mm_min_ss(two, _mm_shuffle_ps(two, two, 1)));
}
TEXTPLANE_SIMD_INLINE float hmax(vf a) noexcept {
  const __m128 two = _mm_max_ps(a, _mm_movehl_ps(a, a));
  return _mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps(two, two, 1)));
}

// --- bilinear taps ---
struct taps_t {
  __m128i words;
};
TEXTPLANE_SIMD_INLINE taps_t load_taps(const std::uint32_t* p) noexcept {
  return taps_t{_mm_loadu_si128(reinterpret_cast<const __m128i*>(p))};
}
// The sum of the four bytes of each word times the four signed bytes of `weights`: products of a pair fit 16 bits.
TEXTPLANE_SIMD_INLINE vf tap_dot(taps_t t, int weights) noexcept {
  const __m128i pairs = _mm_maddubs_epi16(t.words, _mm_set1_epi32(weights));
  return _mm_cvtepi32_ps(_mm_madd_epi16(pairs, _mm_set1_epi16(1)));
}
TEXTPLANE_SIMD_INLINE vf tap_value(taps_t t) noexcept {
  return _mm_cvtepi32_ps(_mm_and_si128(t.words, _mm_set1_epi32(255)));
}
TEXTPLANE_SIMD_INLINE vf tap_dx(taps_t t) noexcept { return tap_dot(t, 0x000001ff); }
TEXTPLANE_SIMD_INLINE vf tap_dy(taps_t t) noexcept { return tap_dot(t, 0x000100ff); }
TEXTPLANE_SIMD_INLINE vf tap_dxy(taps_t t) noexcept { return tap_dot(t, 0x01ffff01); }

// --- one double, one word ---
TEXTPLANE_SIMD_INLINE double sqrt_d(double a) noexcept { return _mm_cvtsd_f64(_mm_sqrt_pd(_mm_set1_pd(a))); }
TEXTPLANE_SIMD_INLINE int lowest_bit(std::uint64_t word) noexcept { return __builtin_ctzll(word); }

// --- 8 doubles ---
struct vd {
  __m128d part[4];
};
TEXTPLANE_SIMD_INLINE vd loadd(const double* p) noexcept {
  return vd{{_mm_loadu_pd(p), _mm_loadu_pd(p + 2), _mm_loadu_pd(p + 4), _mm_loadu_pd(p + 6)}};
}
TEXTPLANE_SIMD_INLINE void stored(double* p, vd a) noexcept {
  _mm_storeu_pd(p, a.part[0]);
  _mm_storeu_pd(p + 2, a.part[1]);
  _mm_storeu_pd(p + 4, a.part[2]);
  _mm_storeu_pd(p + 6, a.part[3]);
}
TEXTPLANE_SIMD_INLINE vd setd(double value) noexcept {
  const __m128d v = _mm_set1_pd(value);
  return vd{{v, v, v, v}};
}
TEXTPLANE_SIMD_INLINE vd muld(vd a, vd b) noexcept {
  return vd{{_mm_mul_pd(a.part[0], b.part[0]), _mm_mul_pd(a.part[1], b.part[1]), _mm_mul_pd(a.part[2], b.part[2]),
             _mm_mul_pd(a.part[3], b.part[3])}};
}
TEXTPLANE_SIMD_INLINE vd maddd(vd a, vd b, vd c) noexcept {
  const vd p = muld(a, b);
  return vd{{_mm_add_pd(p.part[0], c.part[0]), _mm_add_pd(p.part[1], c.part[1]), _mm_add_pd(p.part[2], c.part[2]),
             _mm_add_pd(p.part[3], c.part[3])}};
}

TEXTPLANE_SIMD_INLINE void hsum4(vf a, vf b, vf c, vf d, float* out) noexcept {
  _mm_storeu_ps(out, _mm_hadd_ps(_mm_hadd_ps(a, b), _mm_hadd_ps(c, d)));
}
TEXTPLANE_SIMD_INLINE vd hsum8(const float* p) noexcept {
  const __m128 q = _mm_hadd_ps(_mm_hadd_ps(load(p), load(p + 4)), _mm_hadd_ps(load(p + 8), load(p + 12)));
  const __m128 r = _mm_hadd_ps(_mm_hadd_ps(load(p + 16), load(p + 20)), _mm_hadd_ps(load(p + 24), load(p + 28)));
  return vd{{_mm_cvtps_pd(q), _mm_cvtps_pd(_mm_movehl_ps(q, q)), _mm_cvtps_pd(r), _mm_cvtps_pd(_mm_movehl_ps(r, r))}};
}
