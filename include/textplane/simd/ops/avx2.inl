// Operations of the avx2 target: vectors of 256 bits. ops/scalar.inl defines them.
// Include before: ops/common.inl.
#include "textplane/simd/ops/x86.inl"
#include "textplane/simd/ops/x86_wide.inl"

// --- floats ---
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
  const unsigned low = half ? load_u32(p) : load_u32_n(p, n);
  const unsigned high = half ? load_u32_n(p + 4, n - 4) : 0u;
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

TEXTPLANE_SIMD_INLINE vi as_int(vf a) noexcept { return _mm256_castps_si256(a); }
TEXTPLANE_SIMD_INLINE vf as_float(vi a) noexcept { return _mm256_castsi256_ps(a); }

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
TEXTPLANE_SIMD_INLINE unsigned bits_from_mask(vm m) noexcept { return static_cast<unsigned>(_mm256_movemask_ps(m)); }
TEXTPLANE_SIMD_INLINE int count_true(vm m) noexcept { return _mm_popcnt_u32(bits_from_mask(m)); }
TEXTPLANE_SIMD_INLINE bool any_true(vm m) noexcept { return bits_from_mask(m) != 0; }
TEXTPLANE_SIMD_INLINE bool all_true(vm m) noexcept { return bits_from_mask(m) == 255u; }

// --- reductions ---
TEXTPLANE_SIMD_INLINE float reduce_sum(vf a) noexcept {
  const __m128 four = _mm_add_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
  const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
}
TEXTPLANE_SIMD_INLINE double reduce_sum_double(vf a) noexcept {
  const __m256d four =
      _mm256_add_pd(_mm256_cvtps_pd(_mm256_castps256_ps128(a)), _mm256_cvtps_pd(_mm256_extractf128_ps(a, 1)));
  const __m128d two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
  return _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)));
}
TEXTPLANE_SIMD_INLINE float reduce_min(vf a) noexcept {
  const __m128 four = _mm_min_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
  const __m128 two = _mm_min_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_min_ss(two, _mm_shuffle_ps(two, two, 1)));
}
TEXTPLANE_SIMD_INLINE float reduce_max(vf a) noexcept {
  const __m128 four = _mm_max_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
  const __m128 two = _mm_max_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps(two, two, 1)));
}

// --- bilinear taps ---
struct taps_t {
  __m256i cells;
};
TEXTPLANE_SIMD_INLINE taps_t load_taps(const std::uint32_t* p) noexcept {
  return taps_t{_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))};
}
// The sum of the four bytes of each cell times the four signed bytes of `weights`: products of a pair fit 16 bits.
TEXTPLANE_SIMD_INLINE vf tap_dot(taps_t t, int weights) noexcept {
  const __m256i pairs = _mm256_maddubs_epi16(t.cells, _mm256_set1_epi32(weights));
  return _mm256_cvtepi32_ps(_mm256_madd_epi16(pairs, _mm256_set1_epi16(1)));
}
TEXTPLANE_SIMD_INLINE vf tap_value(taps_t t) noexcept {
  return _mm256_cvtepi32_ps(_mm256_and_si256(t.cells, _mm256_set1_epi32(255)));
}
TEXTPLANE_SIMD_INLINE vf tap_dx(taps_t t) noexcept { return tap_dot(t, 0x000001ff); }
TEXTPLANE_SIMD_INLINE vf tap_dy(taps_t t) noexcept { return tap_dot(t, 0x000100ff); }
TEXTPLANE_SIMD_INLINE vf tap_dxy(taps_t t) noexcept { return tap_dot(t, 0x01ffff01); }

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

TEXTPLANE_SIMD_INLINE void reduce_sum4(vf a, vf b, vf c, vf d, float* out) noexcept {
  const __m256 s = join_pairs(join_lanes(a, b), join_lanes(c, d));
  _mm_storeu_ps(out, _mm_add_ps(_mm256_castps256_ps128(s), _mm256_extractf128_ps(s, 1)));
}
TEXTPLANE_SIMD_INLINE vd reduce_sum8(const float* p) noexcept {
  const __m256 q = join_pairs(join_lanes(load(p), load(p + 8)), join_lanes(load(p + 16), load(p + 24)));
  const __m256 r = join_pairs(join_lanes(load(p + 32), load(p + 40)), join_lanes(load(p + 48), load(p + 56)));
  const __m256 s = join_halves(q, r);
  return vd{_mm256_cvtps_pd(_mm256_castps256_ps128(s)), _mm256_cvtps_pd(_mm256_extractf128_ps(s, 1))};
}

// --- bytes, and their int16 ---
constexpr int kBytes = 32;
using vb = __m256i;

TEXTPLANE_SIMD_INLINE vb setb(int value) noexcept { return _mm256_set1_epi8(static_cast<char>(value)); }
TEXTPLANE_SIMD_INLINE vb loadb(const std::uint8_t* p) noexcept {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
}
TEXTPLANE_SIMD_INLINE void storeb(std::uint8_t* p, vb a) noexcept {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), a);
}
TEXTPLANE_SIMD_INLINE vb loadb_n(const std::uint8_t* p, int n) noexcept {
  std::uint8_t bytes[32] = {0};
  for (int i = 0; i < n; ++i) bytes[i] = p[i];
  return loadb(bytes);
}
TEXTPLANE_SIMD_INLINE void storeb_n(std::uint8_t* p, vb a, int n) noexcept {
  std::uint8_t bytes[32];
  storeb(bytes, a);
  for (int i = 0; i < n; ++i) p[i] = bytes[i];
}

TEXTPLANE_SIMD_INLINE vb addsb(vb a, vb b) noexcept { return _mm256_adds_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb subsb(vb a, vb b) noexcept { return _mm256_subs_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb minb(vb a, vb b) noexcept { return _mm256_min_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb maxb(vb a, vb b) noexcept { return _mm256_max_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb andb(vb a, vb b) noexcept { return _mm256_and_si256(a, b); }
TEXTPLANE_SIMD_INLINE vb orb(vb a, vb b) noexcept { return _mm256_or_si256(a, b); }
TEXTPLANE_SIMD_INLINE vb xorb(vb a, vb b) noexcept { return _mm256_xor_si256(a, b); }
TEXTPLANE_SIMD_INLINE vb mean4b(vb upper0, vb upper1, vb lower0, vb lower1) noexcept {
  const __m256i one = _mm256_set1_epi8(1), two = _mm256_set1_epi16(2);
  const __m256i sum0 = _mm256_add_epi16(_mm256_maddubs_epi16(upper0, one), _mm256_maddubs_epi16(lower0, one));
  const __m256i sum1 = _mm256_add_epi16(_mm256_maddubs_epi16(upper1, one), _mm256_maddubs_epi16(lower1, one));
  // Packing works within the halves of a register.
  const __m256i packed = _mm256_packus_epi16(_mm256_srli_epi16(_mm256_add_epi16(sum0, two), 2),
                                             _mm256_srli_epi16(_mm256_add_epi16(sum1, two), 2));
  return _mm256_permute4x64_epi64(packed, 0xD8);
}

TEXTPLANE_SIMD_INLINE vb geb(vb a, vb b) noexcept { return _mm256_cmpeq_epi8(_mm256_max_epu8(a, b), a); }
TEXTPLANE_SIMD_INLINE bool anyb(vb a) noexcept { return _mm256_testz_si256(a, a) == 0; }
TEXTPLANE_SIMD_INLINE std::uint64_t bitsb(vb mask) noexcept {
  return static_cast<std::uint32_t>(_mm256_movemask_epi8(mask));
}

TEXTPLANE_SIMD_INLINE vw dotw(vw sum, vh a, vh b) noexcept { return _mm256_add_epi32(sum, _mm256_madd_epi16(a, b)); }

// --- int16 ---
enum : int { k16Lanes = 16 };
using v16 = __m256i;

TEXTPLANE_SIMD_INLINE v16 set16(int value) noexcept { return _mm256_set1_epi16(static_cast<short>(value)); }
TEXTPLANE_SIMD_INLINE v16 load16(const std::int16_t* p) noexcept {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
}
TEXTPLANE_SIMD_INLINE void store16(std::int16_t* p, v16 v) noexcept {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), v);
}
TEXTPLANE_SIMD_INLINE v16 add16(v16 x, v16 y) noexcept { return _mm256_add_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 sub16(v16 x, v16 y) noexcept { return _mm256_sub_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 mul15(v16 x, v16 y) noexcept { return _mm256_mulhrs_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 dot_pair(v16 t, int w0, int w1) noexcept {
  return _mm256_maddubs_epi16(t, _mm256_set1_epi16(static_cast<short>((w0 & 255) | (w1 * 256))));
}
TEXTPLANE_SIMD_INLINE vi add_dot16(vi sum, v16 x, v16 y) noexcept { return addi(sum, _mm256_madd_epi16(x, y)); }
TEXTPLANE_SIMD_INLINE v16 pack16(vi low, vi high) noexcept {
  return _mm256_permute4x64_epi64(_mm256_packs_epi32(low, high), 0xd8);
}
TEXTPLANE_SIMD_INLINE int reduce_sum_int(vi v) noexcept {
  const __m128i h = _mm_add_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
  const __m128i a = _mm_add_epi32(h, _mm_shuffle_epi32(h, 0x4e));
  return _mm_cvtsi128_si32(_mm_add_epi32(a, _mm_shuffle_epi32(a, 0xb1)));
}
TEXTPLANE_SIMD_INLINE void gather16(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* first,
                                    v16* second) noexcept {
  __m128i u0, l0, u1, l1;
  gather_pairs8(upper, lower, offset, &u0, &l0);
  gather_pairs8(upper, lower, offset + 8, &u1, &l1);
  *first = _mm256_inserti128_si256(_mm256_castsi128_si256(u0), u1, 1);
  *second = _mm256_inserti128_si256(_mm256_castsi128_si256(l0), l1, 1);
}
TEXTPLANE_SIMD_INLINE vi gather_pairs(const std::uint16_t* p, const int* offset) noexcept {
  return _mm256_inserti128_si256(_mm256_castsi128_si256(gather_pairs4(p, offset)), gather_pairs4(p, offset + 4), 1);
}
TEXTPLANE_SIMD_INLINE v16 low16(vi a, vi b) noexcept {
  const __m256i low = _mm256_set1_epi32(65535);
  return _mm256_permute4x64_epi64(_mm256_packus_epi32(_mm256_and_si256(a, low), _mm256_and_si256(b, low)), 0xd8);
}
TEXTPLANE_SIMD_INLINE v16 high16(vi a, vi b) noexcept {
  return _mm256_permute4x64_epi64(_mm256_packs_epi32(_mm256_srai_epi32(a, 16), _mm256_srai_epi32(b, 16)), 0xd8);
}
TEXTPLANE_SIMD_INLINE vi widen_low16(v16 v) noexcept { return _mm256_cvtepi16_epi32(_mm256_castsi256_si128(v)); }
TEXTPLANE_SIMD_INLINE vi widen_high16(v16 v) noexcept { return _mm256_cvtepi16_epi32(_mm256_extracti128_si256(v, 1)); }

// --- doubles ---
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

// --- tiles ---
enum : int { kTileLanes = 8 };
TEXTPLANE_SIMD_INLINE vi per_tile(const int* b) noexcept { return seti(b[0]); }
TEXTPLANE_SIMD_INLINE bool in_two_rows(vi y) noexcept { return _mm256_testz_si256(y, _mm256_set1_epi32(~1)) != 0; }
TEXTPLANE_SIMD_INLINE vi tile_rows(const std::uint8_t* const* corner, std::ptrdiff_t offset) noexcept {
  return _mm256_broadcastsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(corner[0] + offset)));
}
TEXTPLANE_SIMD_INLINE vi pick_bytes(vi rows, vi picks) noexcept { return _mm256_shuffle_epi8(rows, picks); }
TEXTPLANE_SIMD_INLINE vi tile_picks(vi x) noexcept {
  const __m256i lowest = _mm256_set_epi8(12, 12, 12, 12, 8, 8, 8, 8, 4, 4, 4, 4, 0, 0, 0, 0,  //
                                         12, 12, 12, 12, 8, 8, 8, 8, 4, 4, 4, 4, 0, 0, 0, 0);
  return _mm256_add_epi8(_mm256_shuffle_epi8(x, lowest), _mm256_set1_epi32(0x01000100));
}
TEXTPLANE_SIMD_INLINE taps_t two_rows(vi y, vi a, vi b, vi c) noexcept {
  const __m256i lower = _mm256_sub_epi32(_mm256_setzero_si256(), y);
  return taps_t{_mm256_blendv_epi8(_mm256_blend_epi16(a, b, 0xAA), _mm256_blend_epi16(b, c, 0xAA), lower)};
}
TEXTPLANE_SIMD_INLINE void load2(const float* p, vf* a, vf* b) noexcept {
  const __m256 lo = _mm256_loadu_ps(p), hi = _mm256_loadu_ps(p + 8);
  const __m256 even = _mm256_shuffle_ps(lo, hi, 0x88), odd = _mm256_shuffle_ps(lo, hi, 0xDD);
  *a = _mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(even), 0xD8));
  *b = _mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(odd), 0xD8));
}
TEXTPLANE_SIMD_INLINE void store_u8(std::uint8_t* p, vi v) noexcept {
  const __m128i int16 = _mm_packus_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
  _mm_storel_epi64(reinterpret_cast<__m128i*>(p), _mm_packus_epi16(int16, int16));
}

// --- tiles of int16 cells ---
enum : int { kInt16Tiles = 1 };
TEXTPLANE_SIMD_INLINE v16 load_cells(const std::int16_t* p) noexcept { return load16(p); }
TEXTPLANE_SIMD_INLINE v16 group_ends(bool last) noexcept { return set16(last ? 0x0f0e : 0x0100); }
TEXTPLANE_SIMD_INLINE v16 saturated_sub16(v16 v, int n) noexcept { return _mm256_subs_epu16(v, set16(n)); }
TEXTPLANE_SIMD_INLINE v16 pair_picks(v16 x) noexcept {
  return _mm256_add_epi16(_mm256_or_si256(x, _mm256_slli_epi16(x, 8)), set16(0x0100));
}
struct TilePlaces {
  std::ptrdiff_t a, b;
};
TEXTPLANE_SIMD_INLINE TilePlaces find_tiles(const std::int16_t* x, const std::int16_t* y,
                                            std::ptrdiff_t stride) noexcept {
  return TilePlaces{y[0] * stride + x[0], y[8] * stride + x[8]};
}
TEXTPLANE_SIMD_INLINE v16 load_tile_rows(const std::uint8_t* p, const TilePlaces& at) noexcept {
  return _mm256_inserti128_si256(_mm256_castsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p + at.a))),
                                 _mm_loadu_si128(reinterpret_cast<const __m128i*>(p + at.b)), 1);
}
TEXTPLANE_SIMD_INLINE v16 choose16(v16 y, v16 a, v16 b) noexcept {
  return _mm256_blendv_epi8(a, b, _mm256_sub_epi16(_mm256_setzero_si256(), y));
}
TEXTPLANE_SIMD_INLINE v16 min_unsigned16(v16 v, v16 high) noexcept { return _mm256_min_epu16(v, high); }
TEXTPLANE_SIMD_INLINE v16 or16(v16 a, v16 b) noexcept { return _mm256_or_si256(a, b); }
TEXTPLANE_SIMD_INLINE unsigned any_of_four(v16 v) noexcept {
  const __m256i none = _mm256_cmpeq_epi64(v, _mm256_setzero_si256());
  return static_cast<unsigned>(_mm256_movemask_pd(_mm256_castsi256_pd(none))) ^ 15U;
}
TEXTPLANE_SIMD_INLINE v16 load_group(const std::int16_t* p) noexcept {
  return _mm256_castsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
}
TEXTPLANE_SIMD_INLINE void store_group(std::int16_t* p, v16 v) noexcept {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm256_castsi256_si128(v));
}
TEXTPLANE_SIMD_INLINE void fetch_group(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* a,
                                       v16* b) noexcept {
  __m128i u, l;
  gather_pairs8(upper, lower, offset, &u, &l);
  *a = _mm256_castsi128_si256(u);
  *b = _mm256_castsi128_si256(l);
}
TEXTPLANE_SIMD_INLINE void store_taps(std::uint32_t* p, v16 a, v16 b) noexcept {
  const __m256i low = _mm256_unpacklo_epi16(a, b), high = _mm256_unpackhi_epi16(a, b);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm256_permute2x128_si256(low, high, 0x20));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p + 8), _mm256_permute2x128_si256(low, high, 0x31));
}

#include "textplane/simd/ops/x86_tiles.inl"
