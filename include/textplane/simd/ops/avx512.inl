// Operations of the avx512 target: vectors of 512 bits. ops/scalar.inl defines them.
// Include before: ops/common.inl. Zero-masking forms that keep all lanes are the plain instructions: g++ 11 and 12 warn
// about an undefined register in the headers of the plain forms.
#include "textplane/simd/ops/x86.inl"

// --- floats ---
constexpr int kLanes = 16;
constexpr bool kManyRegisters = true;  // 32
using vf = __m512;
TEXTPLANE_SIMD_OPERATORS(__m512, _mm512, ps)
using vi = __m512i;
using vm = __mmask16;
constexpr vm kFull = 0xffff;

#include "textplane/simd/ops/x86_wide.inl"

// --- make, load, store ---
TEXTPLANE_SIMD_INLINE vf set1(float value) noexcept { return _mm512_set1_ps(value); }
TEXTPLANE_SIMD_INLINE vi seti(int value) noexcept { return _mm512_set1_epi32(value); }
TEXTPLANE_SIMD_INLINE vi ioti() noexcept {
  return _mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
}
TEXTPLANE_SIMD_INLINE vm first_n(int n) noexcept {
  return n >= 16 ? kFull : static_cast<vm>((1u << (n < 0 ? 0 : n)) - 1u);
}
TEXTPLANE_SIMD_INLINE vf load(const float* p) noexcept { return _mm512_loadu_ps(p); }
TEXTPLANE_SIMD_INLINE vf hold(vf v) noexcept {
  TEXTPLANE_SIMD_HOLD("+v", v);
  return v;
}
TEXTPLANE_SIMD_INLINE void store(float* p, vf v) noexcept { _mm512_storeu_ps(p, v); }
TEXTPLANE_SIMD_INLINE vi loadi(const int* p) noexcept { return _mm512_loadu_si512(p); }
TEXTPLANE_SIMD_INLINE void storei(int* p, vi v) noexcept { _mm512_storeu_si512(p, v); }
TEXTPLANE_SIMD_INLINE vf load_n(const float* p, int n) noexcept { return _mm512_maskz_loadu_ps(first_n(n), p); }
TEXTPLANE_SIMD_INLINE void store_n(float* p, vf v, int n) noexcept { _mm512_mask_storeu_ps(p, first_n(n), v); }
TEXTPLANE_SIMD_INLINE __m256i lower_half(__m512i a) noexcept { return _mm512_maskz_extracti64x4_epi64(0xf, a, 0); }
TEXTPLANE_SIMD_INLINE __m256i upper_half(__m512i a) noexcept { return _mm512_maskz_extracti64x4_epi64(0xf, a, 1); }
TEXTPLANE_SIMD_INLINE __m512i join256(__m256i low, __m256i high) noexcept {
  return _mm512_maskz_inserti64x4(0xff, _mm512_castsi256_si512(low), high, 1);
}
TEXTPLANE_SIMD_INLINE __m256i gather_eight(const float* p, const int* at) noexcept {
  return _mm256_castps_si256(
      _mm256_setr_ps(p[at[0]], p[at[1]], p[at[2]], p[at[3]], p[at[4]], p[at[5]], p[at[6]], p[at[7]]));
}
TEXTPLANE_SIMD_INLINE vf gather(const float* p, const int* at) noexcept {
  return _mm512_castsi512_ps(join256(gather_eight(p, at), gather_eight(p, at + 8)));
}
TEXTPLANE_SIMD_INLINE vf to_float(vi a) noexcept { return _mm512_maskz_cvtepi32_ps(kFull, a); }
TEXTPLANE_SIMD_INLINE vf iota() noexcept { return to_float(ioti()); }

// --- float arithmetic ---
TEXTPLANE_SIMD_INLINE vf madd(vf a, vf b, vf c) noexcept { return _mm512_fmadd_ps(a, b, c); }
TEXTPLANE_SIMD_INLINE vf nmadd(vf a, vf b, vf c) noexcept { return _mm512_fnmadd_ps(a, b, c); }
#if !TEXTPLANE_SIMD_HIDE_MINIMA
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept { return _mm512_maskz_min_ps(kFull, a, b); }
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept { return _mm512_maskz_max_ps(kFull, a, b); }
#endif
TEXTPLANE_SIMD_INLINE vf sqrt_(vf a) noexcept { return _mm512_maskz_sqrt_ps(kFull, a); }
TEXTPLANE_SIMD_INLINE vf rough_inverse_root(vf a) noexcept { return _mm512_maskz_rsqrt14_ps(kFull, a); }
TEXTPLANE_SIMD_INLINE vf abs_(vf a) noexcept { return _mm512_maskz_andnot_ps(kFull, _mm512_set1_ps(-0.0f), a); }
TEXTPLANE_SIMD_INLINE vf floor_(vf a) noexcept {
  return _mm512_maskz_roundscale_ps(kFull, a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}

// --- conversions ---
TEXTPLANE_SIMD_INLINE vi to_int(vf a) noexcept { return _mm512_maskz_cvttps_epi32(kFull, a); }
TEXTPLANE_SIMD_INLINE vi as_int(vf a) noexcept { return _mm512_castps_si512(a); }
TEXTPLANE_SIMD_INLINE vf as_float(vi a) noexcept { return _mm512_castsi512_ps(a); }

// --- int32 arithmetic ---
TEXTPLANE_SIMD_INLINE vi addi(vi a, vi b) noexcept { return _mm512_add_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi subi(vi a, vi b) noexcept { return _mm512_sub_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi muli(vi a, vi b) noexcept { return _mm512_mullo_epi32(a, b); }
TEXTPLANE_SIMD_INLINE vi mini(vi a, vi b) noexcept { return _mm512_maskz_min_epi32(kFull, a, b); }
TEXTPLANE_SIMD_INLINE vi maxi(vi a, vi b) noexcept { return _mm512_maskz_max_epi32(kFull, a, b); }
TEXTPLANE_SIMD_INLINE vi shl(vi a, int bits) noexcept {
  return _mm512_maskz_sll_epi32(kFull, a, _mm_cvtsi32_si128(bits));
}
TEXTPLANE_SIMD_INLINE vi shr(vi a, int bits) noexcept {
  return _mm512_maskz_sra_epi32(kFull, a, _mm_cvtsi32_si128(bits));
}
TEXTPLANE_SIMD_INLINE vi andi(vi a, vi b) noexcept { return _mm512_and_si512(a, b); }
TEXTPLANE_SIMD_INLINE vi ori(vi a, vi b) noexcept { return _mm512_or_si512(a, b); }

// --- masks ---
TEXTPLANE_SIMD_INLINE vm lt(vf a, vf b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
TEXTPLANE_SIMD_INLINE vm le(vf a, vf b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
TEXTPLANE_SIMD_INLINE vm gt(vf a, vf b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_GT_OQ); }
TEXTPLANE_SIMD_INLINE vm ge(vf a, vf b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_GE_OQ); }
TEXTPLANE_SIMD_INLINE vm eq(vf a, vf b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
TEXTPLANE_SIMD_INLINE vm eqi(vi a, vi b) noexcept { return _mm512_cmpeq_epi32_mask(a, b); }
TEXTPLANE_SIMD_INLINE vm and_(vm a, vm b) noexcept { return static_cast<vm>(a & b); }
TEXTPLANE_SIMD_INLINE vm andnot_(vm a, vm b) noexcept { return static_cast<vm>(~a & b); }
TEXTPLANE_SIMD_INLINE vf select(vm m, vf a, vf b) noexcept { return _mm512_mask_blend_ps(m, b, a); }
TEXTPLANE_SIMD_INLINE vf keep(vm m, vf a) noexcept { return _mm512_maskz_mov_ps(m, a); }
TEXTPLANE_SIMD_INLINE unsigned bits_from_mask(vm m) noexcept { return m; }
TEXTPLANE_SIMD_INLINE int count_true(vm m) noexcept { return _mm_popcnt_u32(m); }
TEXTPLANE_SIMD_INLINE bool all_true(vm m) noexcept { return m == kFull; }

// --- reductions ---
TEXTPLANE_SIMD_INLINE __m256 lower_half(vf a) noexcept { return _mm512_maskz_extractf32x8_ps(0xff, a, 0); }
TEXTPLANE_SIMD_INLINE __m256 upper_half(vf a) noexcept { return _mm512_maskz_extractf32x8_ps(0xff, a, 1); }
TEXTPLANE_SIMD_INLINE __m256 half_sum(vf a) noexcept { return _mm256_add_ps(lower_half(a), upper_half(a)); }
TEXTPLANE_SIMD_INLINE float reduce_sum(vf a) noexcept { return sum_of_eight(half_sum(a)); }
TEXTPLANE_SIMD_INLINE double sum_of_eight(__m512d a) noexcept {
  return sum_of_four(_mm512_maskz_extractf64x4_pd(0xf, a, 0) + _mm512_maskz_extractf64x4_pd(0xf, a, 1));
}
TEXTPLANE_SIMD_INLINE double reduce_sum_double(vf a) noexcept {
  return sum_of_eight(_mm512_maskz_cvtps_pd(0xff, lower_half(a)) + _mm512_maskz_cvtps_pd(0xff, upper_half(a)));
}
TEXTPLANE_SIMD_INLINE float reduce_min(vf a) noexcept {
  return min_of_eight(_mm256_min_ps(lower_half(a), upper_half(a)));
}
TEXTPLANE_SIMD_INLINE float reduce_max(vf a) noexcept {
  return max_of_eight(_mm256_max_ps(lower_half(a), upper_half(a)));
}

// --- bilinear taps ---
struct taps_t {
  __m512i cells;
};
TEXTPLANE_SIMD_INLINE taps_t load_taps(const std::uint32_t* p) noexcept { return taps_t{_mm512_loadu_si512(p)}; }
// The sum of the four bytes of each cell times the four signed bytes of `weights`.
TEXTPLANE_SIMD_INLINE vf tap_dot(taps_t t, int weights) noexcept {
  return to_float(_mm512_dpbusd_epi32(_mm512_setzero_si512(), t.cells, _mm512_set1_epi32(weights)));
}

TEXTPLANE_SIMD_INLINE void reduce_sum4(vf a, vf b, vf c, vf d, float* out) noexcept {
  const __m256 s = _mm256_hadd_ps(_mm256_hadd_ps(half_sum(a), half_sum(b)), _mm256_hadd_ps(half_sum(c), half_sum(d)));
  _mm_storeu_ps(out, _mm_add_ps(_mm256_castps256_ps128(s), _mm256_extractf128_ps(s, 1)));
}

// --- bytes ---
constexpr int kBytes = 64;
using vb = __m512i;

TEXTPLANE_SIMD_INLINE vb setb(int value) noexcept { return _mm512_set1_epi8(static_cast<char>(value)); }
TEXTPLANE_SIMD_INLINE vb loadb(const std::uint8_t* p) noexcept { return _mm512_loadu_si512(p); }
TEXTPLANE_SIMD_INLINE void storeb(std::uint8_t* p, vb a) noexcept { _mm512_storeu_si512(p, a); }
TEXTPLANE_SIMD_INLINE __mmask64 firstb(int n) noexcept { return n < 64 ? (1ULL << n) - 1 : ~0ULL; }  // 0 <= n
TEXTPLANE_SIMD_INLINE vb loadb_n(const std::uint8_t* p, int n) noexcept {
  return _mm512_maskz_loadu_epi8(firstb(n), p);
}
TEXTPLANE_SIMD_INLINE void storeb_n(std::uint8_t* p, vb a, int n) noexcept { _mm512_mask_storeu_epi8(p, firstb(n), a); }

TEXTPLANE_SIMD_INLINE vb addsb(vb a, vb b) noexcept { return _mm512_adds_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb subsb(vb a, vb b) noexcept { return _mm512_subs_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb minb(vb a, vb b) noexcept { return _mm512_min_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb maxb(vb a, vb b) noexcept { return _mm512_max_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb andb(vb a, vb b) noexcept { return _mm512_and_si512(a, b); }
TEXTPLANE_SIMD_INLINE vb xorb(vb a, vb b) noexcept { return _mm512_xor_si512(a, b); }
TEXTPLANE_SIMD_INLINE vb orb(vb a, vb b) noexcept { return _mm512_or_si512(a, b); }

TEXTPLANE_SIMD_INLINE vb geb(vb a, vb b) noexcept { return _mm512_movm_epi8(_mm512_cmpge_epu8_mask(a, b)); }
TEXTPLANE_SIMD_INLINE bool anyb(vb a) noexcept { return _mm512_test_epi8_mask(a, a) != 0; }
TEXTPLANE_SIMD_INLINE std::uint64_t bitsb(vb mask) noexcept { return _mm512_movepi8_mask(mask); }

// --- int16 ---
enum : int { k16Lanes = 32 };
using v16 = __m512i;
using vw = __m512i;
constexpr int kPairsReach = 40;

TEXTPLANE_SIMD_INLINE v16 set16(int value) noexcept { return _mm512_set1_epi16(static_cast<short>(value)); }
TEXTPLANE_SIMD_INLINE v16 load16(const std::int16_t* p) noexcept { return _mm512_loadu_si512(p); }
TEXTPLANE_SIMD_INLINE void store16(std::int16_t* p, v16 v) noexcept { _mm512_storeu_si512(p, v); }
TEXTPLANE_SIMD_INLINE v16 add16(v16 x, v16 y) noexcept { return _mm512_add_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 sub16(v16 x, v16 y) noexcept { return _mm512_sub_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 and16(v16 x, v16 y) noexcept { return _mm512_and_si512(x, y); }
TEXTPLANE_SIMD_INLINE v16 half16(v16 x) noexcept { return _mm512_srai_epi16(x, 1); }
TEXTPLANE_SIMD_INLINE v16 quarter16(v16 x) noexcept { return _mm512_srai_epi16(x, 2); }
// Unsigned bytes of a times signed ones of b, neighbouring products added.
TEXTPLANE_SIMD_INLINE v16 dot_bytes(v16 a, v16 b) noexcept { return _mm512_maddubs_epi16(a, b); }
TEXTPLANE_SIMD_INLINE vb pack_bytes(v16 a, v16 b) noexcept {
  const __m512i order = _mm512_setr_epi64(0, 2, 4, 6, 1, 3, 5, 7);
  return _mm512_maskz_permutexvar_epi64(0xff, order, _mm512_packus_epi16(a, b));
}
TEXTPLANE_SIMD_INLINE v16 join_groups(const __m128i* p) noexcept {
  return join256(join128(p[0], p[1]), join128(p[2], p[3]));
}
TEXTPLANE_SIMD_INLINE v16 repeat_group(__m128i p) noexcept { return _mm512_maskz_broadcast_i32x4(kFull, p); }
TEXTPLANE_SIMD_INLINE v16 load_groups(const std::uint8_t* p) noexcept {
  const __m512i overlapping = _mm512_setr_epi64(0, 1, 1, 2, 2, 3, 3, 4);
  return _mm512_maskz_permutexvar_epi64(0xff, overlapping, loadb_n(p, kPairsReach));
}
TEXTPLANE_SIMD_INLINE v16 first16(int n) noexcept {
  return _mm512_movm_epi16(n >= 32 ? ~0u : (1u << (n < 0 ? 0 : n)) - 1u);
}
TEXTPLANE_SIMD_INLINE v16 mul15(v16 x, v16 y) noexcept { return _mm512_mulhrs_epi16(x, y); }
TEXTPLANE_SIMD_INLINE vi add_dot16(vi sum, v16 x, v16 y) noexcept { return _mm512_dpwssd_epi32(sum, x, y); }
// Numbers of int16, two a lane: (first, second) in lane 0 and (step, step) more in each lane after it.
TEXTPLANE_SIMD_INLINE __m512i int16_order(int first, int second, int step) noexcept {
  return addi(muli(ioti(), seti(step * 0x00010001)), seti(second * 0x00010000 + first));
}
TEXTPLANE_SIMD_INLINE v16 low16(vi a, vi b) noexcept { return _mm512_permutex2var_epi16(a, int16_order(0, 2, 4), b); }
TEXTPLANE_SIMD_INLINE v16 high16(vi a, vi b) noexcept { return _mm512_permutex2var_epi16(a, int16_order(1, 3, 4), b); }
TEXTPLANE_SIMD_INLINE v16 pack16(vi low, vi high) noexcept { return low16(low, high); }
TEXTPLANE_SIMD_INLINE int reduce_sum_int(vi v) noexcept {
  return sum_of_eight(_mm256_add_epi32(lower_half(v), upper_half(v)));
}
TEXTPLANE_SIMD_INLINE double sumw(vw a) noexcept {
  return sum_of_eight(_mm512_maskz_cvtepi32_pd(0xff, lower_half(a)) + _mm512_maskz_cvtepi32_pd(0xff, upper_half(a)));
}
TEXTPLANE_SIMD_INLINE vi gather_pairs(const std::uint16_t* p, const int* offset) noexcept {
  return join256(gather_pairs8(p, offset), gather_pairs8(p, offset + 8));
}
TEXTPLANE_SIMD_INLINE vi widen_low16(v16 v) noexcept { return _mm512_maskz_cvtepi16_epi32(kFull, lower_half(v)); }
TEXTPLANE_SIMD_INLINE vi widen_high16(v16 v) noexcept { return _mm512_maskz_cvtepi16_epi32(kFull, upper_half(v)); }

// --- doubles ---
enum : int { kDoubles = 8 };
using vp = __m512d;
TEXTPLANE_SIMD_OPERATORS(__m512d, _mm512, pd)
struct vd {
  vp part[1];
};

TEXTPLANE_SIMD_INLINE vp set_p(double value) noexcept { return _mm512_set1_pd(value); }
TEXTPLANE_SIMD_INLINE vp load_p(const double* p) noexcept { return _mm512_loadu_pd(p); }
TEXTPLANE_SIMD_INLINE vp from_p(const double* const* p, std::ptrdiff_t at) noexcept {
  return _mm512_setr_pd(p[0][at], p[1][at], p[2][at], p[3][at], p[4][at], p[5][at], p[6][at], p[7][at]);
}
TEXTPLANE_SIMD_INLINE void store_p(double* p, vp v) noexcept { _mm512_storeu_pd(p, v); }
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

TEXTPLANE_SIMD_INLINE vd reduce_sum8(const float* p) noexcept {
  __m256 s[8];
  TEXTPLANE_SIMD_UNROLL
  for (int i = 0; i < 8; ++i) s[i] = _mm256_loadu_ps(p + 16 * i) + _mm256_loadu_ps(p + 16 * i + 8);
  const __m256 q = join_pairs(join_lanes(s[0], s[1]), join_lanes(s[2], s[3]));
  const __m256 r = join_pairs(join_lanes(s[4], s[5]), join_lanes(s[6], s[7]));
  return vd{{_mm512_maskz_cvtps_pd(0xff, join_halves(q, r))}};
}

// --- tiles ---
enum : int { kTileLanes = 8 };
TEXTPLANE_SIMD_INLINE vi per_tile(const int* b) noexcept {
  return _mm512_mask_blend_epi32(0xFF00, _mm512_set1_epi32(b[0]), _mm512_set1_epi32(b[8]));
}
TEXTPLANE_SIMD_INLINE bool in_two_rows(vi y) noexcept { return _mm512_test_epi32_mask(y, _mm512_set1_epi32(~1)) == 0; }
TEXTPLANE_SIMD_INLINE vi tile_rows(const std::uint8_t* const* corner, std::ptrdiff_t offset) noexcept {
  const __m512i a = repeat_group(load128(corner[0] + offset));
  return _mm512_mask_broadcast_i32x4(a, 0xFF00, load128(corner[1] + offset));
}
TEXTPLANE_SIMD_INLINE vi pick_bytes(vi rows, vi picks) noexcept { return _mm512_shuffle_epi8(rows, picks); }
TEXTPLANE_SIMD_INLINE vi tile_picks(vi x) noexcept {
  // Each byte of a lane gets the lane's x, which is below 16.
  return _mm512_add_epi32(_mm512_mullo_epi32(x, _mm512_set1_epi32(0x01010101)), _mm512_set1_epi32(0x01000100));
}
TEXTPLANE_SIMD_INLINE taps_t two_rows(vi y, vi a, vi b, vi c) noexcept {
  const __m512i upper = _mm512_mask_blend_epi16(0xAAAAAAAAU, a, b), lower = _mm512_mask_blend_epi16(0xAAAAAAAAU, b, c);
  return taps_t{_mm512_mask_blend_epi32(_mm512_test_epi32_mask(y, y), upper, lower)};
}
TEXTPLANE_SIMD_INLINE void load2(const float* p, vf* a, vf* b) noexcept {
  const __m512 lo = _mm512_loadu_ps(p), hi = _mm512_loadu_ps(p + 16);
  const __m512i even = _mm512_set_epi32(30, 28, 26, 24, 22, 20, 18, 16, 14, 12, 10, 8, 6, 4, 2, 0);
  const __m512i odd = _mm512_set_epi32(31, 29, 27, 25, 23, 21, 19, 17, 15, 13, 11, 9, 7, 5, 3, 1);
  *a = _mm512_permutex2var_ps(lo, even, hi);
  *b = _mm512_permutex2var_ps(lo, odd, hi);
}
TEXTPLANE_SIMD_INLINE void store_u8(std::uint8_t* p, vi v) noexcept {
  store128(p, _mm512_maskz_cvtepi32_epi8(kFull, v));
}

// --- tiles of int16 cells ---
enum : int { kInt16Tiles = 1 };
TEXTPLANE_SIMD_INLINE v16 load_cells(const std::int16_t* p) noexcept { return as_int(hold(as_float(load16(p)))); }
TEXTPLANE_SIMD_INLINE v16 saturated_sub16(v16 v, int n) noexcept { return _mm512_subs_epu16(v, set16(n)); }
TEXTPLANE_SIMD_INLINE v16 pair_picks(v16 x) noexcept {
  return _mm512_add_epi16(_mm512_mullo_epi16(x, set16(0x0101)), set16(0x0100));
}
TEXTPLANE_SIMD_INLINE v16 choose16(v16 y, v16 a, v16 b) noexcept {
  return _mm512_mask_blend_epi16(_mm512_test_epi16_mask(y, y), a, b);
}
TEXTPLANE_SIMD_INLINE v16 min_unsigned16(v16 v, v16 high) noexcept { return _mm512_min_epu16(v, high); }
TEXTPLANE_SIMD_INLINE v16 from_group(__m128i p) noexcept { return _mm512_castsi128_si512(p); }
TEXTPLANE_SIMD_INLINE __m128i first_group(v16 v) noexcept { return _mm256_castsi256_si128(lower_half(v)); }
TEXTPLANE_SIMD_INLINE v16 or16(v16 a, v16 b) noexcept { return _mm512_or_si512(a, b); }
TEXTPLANE_SIMD_INLINE unsigned any_of_four(v16 v) noexcept { return _mm512_test_epi64_mask(v, v); }
TEXTPLANE_SIMD_INLINE void store_taps(std::uint32_t* p, v16 a, v16 b) noexcept {
  _mm512_storeu_si512(p, _mm512_permutex2var_epi16(a, int16_order(0, 32, 1), b));
  _mm512_storeu_si512(p + 16, _mm512_permutex2var_epi16(a, int16_order(16, 48, 1), b));
}

#include "textplane/simd/ops/x86_vectors.inl"

#include "textplane/simd/ops/x86_tiles.inl"
