// Operations of the avx2 target: vectors of 256 bits. ops/scalar.inl defines them.
// Include before: ops/common.inl.
#include "textplane/simd/ops/x86.inl"

// --- floats ---
constexpr int kLanes = 8;
constexpr bool kManyRegisters = false;
using vf = __m256;
TEXTPLANE_SIMD_OPERATORS(__m256, _mm256, ps)
using vi = __m256i;
using vm = __m256;  // all bits of a lane

#include "textplane/simd/ops/x86_wide.inl"

// --- make, load, store ---
TEXTPLANE_SIMD_INLINE vf set1(float value) noexcept { return _mm256_set1_ps(value); }
TEXTPLANE_SIMD_INLINE vi seti(int value) noexcept { return _mm256_set1_epi32(value); }
TEXTPLANE_SIMD_INLINE vf iota() noexcept { return _mm256_setr_ps(0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f); }
TEXTPLANE_SIMD_INLINE vi ioti() noexcept { return _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7); }
TEXTPLANE_SIMD_INLINE __m256i first_n_bits(int n) noexcept { return _mm256_cmpgt_epi32(_mm256_set1_epi32(n), ioti()); }
TEXTPLANE_SIMD_INLINE vf load(const float* p) noexcept { return _mm256_loadu_ps(p); }
TEXTPLANE_SIMD_INLINE vf hold(vf v) noexcept {
  TEXTPLANE_SIMD_HOLD("+x", v);
  return v;
}
TEXTPLANE_SIMD_INLINE void store(float* p, vf v) noexcept { _mm256_storeu_ps(p, v); }
TEXTPLANE_SIMD_INLINE vi loadi(const int* p) noexcept { return load256(p); }
TEXTPLANE_SIMD_INLINE void storei(int* p, vi v) noexcept { store256(p, v); }
TEXTPLANE_SIMD_INLINE vf load_n(const float* p, int n) noexcept { return _mm256_maskload_ps(p, first_n_bits(n)); }
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
TEXTPLANE_SIMD_INLINE __m128 gather_four(const float* p, const int* at) noexcept {
  return _mm_setr_ps(p[at[0]], p[at[1]], p[at[2]], p[at[3]]);
}
TEXTPLANE_SIMD_INLINE vf gather(const float* p, const int* at) noexcept {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(gather_four(p, at)), gather_four(p, at + 4), 1);
}

// --- float arithmetic ---
TEXTPLANE_SIMD_INLINE vf madd(vf a, vf b, vf c) noexcept { return _mm256_fmadd_ps(a, b, c); }
TEXTPLANE_SIMD_INLINE vf nmadd(vf a, vf b, vf c) noexcept { return _mm256_fnmadd_ps(a, b, c); }
#if !TEXTPLANE_SIMD_HIDE_MINIMA
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept { return _mm256_min_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept { return _mm256_max_ps(a, b); }
#endif
TEXTPLANE_SIMD_INLINE vf sqrt_(vf a) noexcept { return _mm256_sqrt_ps(a); }
TEXTPLANE_SIMD_INLINE vf rough_inverse_root(vf a) noexcept { return _mm256_rsqrt_ps(a); }
TEXTPLANE_SIMD_INLINE vf abs_(vf a) noexcept { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
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
TEXTPLANE_SIMD_INLINE vm eqi(vi a, vi b) noexcept { return _mm256_castsi256_ps(_mm256_cmpeq_epi32(a, b)); }
TEXTPLANE_SIMD_INLINE vm and_(vm a, vm b) noexcept { return _mm256_and_ps(a, b); }
TEXTPLANE_SIMD_INLINE vm andnot_(vm a, vm b) noexcept { return _mm256_andnot_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf select(vm m, vf a, vf b) noexcept { return _mm256_blendv_ps(b, a, m); }
TEXTPLANE_SIMD_INLINE vf keep(vm m, vf a) noexcept { return _mm256_and_ps(m, a); }
TEXTPLANE_SIMD_INLINE vm first_n(int n) noexcept { return _mm256_castsi256_ps(first_n_bits(n)); }
TEXTPLANE_SIMD_INLINE unsigned bits_from_mask(vm m) noexcept { return static_cast<unsigned>(_mm256_movemask_ps(m)); }
TEXTPLANE_SIMD_INLINE int count_true(vm m) noexcept { return _mm_popcnt_u32(bits_from_mask(m)); }
TEXTPLANE_SIMD_INLINE bool all_true(vm m) noexcept { return bits_from_mask(m) == 255u; }

// --- reductions ---
TEXTPLANE_SIMD_INLINE float reduce_sum(vf a) noexcept { return sum_of_eight(a); }
TEXTPLANE_SIMD_INLINE double reduce_sum_double(vf a) noexcept {
  const __m128 low = _mm256_castps256_ps128(a), high = _mm256_extractf128_ps(a, 1);
  return sum_of_four(_mm256_add_pd(_mm256_cvtps_pd(low), _mm256_cvtps_pd(high)));
}
TEXTPLANE_SIMD_INLINE float reduce_min(vf a) noexcept { return min_of_eight(a); }
TEXTPLANE_SIMD_INLINE float reduce_max(vf a) noexcept { return max_of_eight(a); }

// --- bilinear taps ---
struct taps_t {
  __m256i cells;
};
TEXTPLANE_SIMD_INLINE taps_t load_taps(const std::uint32_t* p) noexcept { return taps_t{load256(p)}; }
// The sum of the four bytes of each cell times the four signed bytes of `weights`: products of a pair fit 16 bits.
TEXTPLANE_SIMD_INLINE vf tap_dot(taps_t t, int weights) noexcept {
  const __m256i pairs = _mm256_maddubs_epi16(t.cells, _mm256_set1_epi32(weights));
  return _mm256_cvtepi32_ps(_mm256_madd_epi16(pairs, _mm256_set1_epi16(1)));
}

TEXTPLANE_SIMD_INLINE void reduce_sum4(vf a, vf b, vf c, vf d, float* out) noexcept {
  const __m256 s = join_pairs(join_lanes(a, b), join_lanes(c, d));
  _mm_storeu_ps(out, _mm_add_ps(_mm256_castps256_ps128(s), _mm256_extractf128_ps(s, 1)));
}

// --- bytes ---
constexpr int kBytes = 32;
using vb = __m256i;

TEXTPLANE_SIMD_INLINE vb setb(int value) noexcept { return _mm256_set1_epi8(static_cast<char>(value)); }
TEXTPLANE_SIMD_INLINE vb loadb(const std::uint8_t* p) noexcept { return load256(p); }
TEXTPLANE_SIMD_INLINE void storeb(std::uint8_t* p, vb a) noexcept { store256(p, a); }

TEXTPLANE_SIMD_INLINE vb addsb(vb a, vb b) noexcept { return _mm256_adds_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb subsb(vb a, vb b) noexcept { return _mm256_subs_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb minb(vb a, vb b) noexcept { return _mm256_min_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb maxb(vb a, vb b) noexcept { return _mm256_max_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb andb(vb a, vb b) noexcept { return _mm256_and_si256(a, b); }
TEXTPLANE_SIMD_INLINE vb xorb(vb a, vb b) noexcept { return _mm256_xor_si256(a, b); }
TEXTPLANE_SIMD_INLINE vb orb(vb a, vb b) noexcept { return _mm256_or_si256(a, b); }

TEXTPLANE_SIMD_INLINE vb geb(vb a, vb b) noexcept { return _mm256_cmpeq_epi8(_mm256_max_epu8(a, b), a); }
TEXTPLANE_SIMD_INLINE bool anyb(vb a) noexcept { return _mm256_testz_si256(a, a) == 0; }
TEXTPLANE_SIMD_INLINE std::uint64_t bitsb(vb mask) noexcept {
  return static_cast<std::uint32_t>(_mm256_movemask_epi8(mask));
}

// --- int16 ---
enum : int { k16Lanes = 16 };
using v16 = __m256i;
using vw = __m256i;
constexpr int kPairsReach = 24;

TEXTPLANE_SIMD_INLINE v16 set16(int value) noexcept { return _mm256_set1_epi16(static_cast<short>(value)); }
TEXTPLANE_SIMD_INLINE v16 load16(const std::int16_t* p) noexcept { return load256(p); }
TEXTPLANE_SIMD_INLINE void store16(std::int16_t* p, v16 v) noexcept { store256(p, v); }
TEXTPLANE_SIMD_INLINE v16 add16(v16 x, v16 y) noexcept { return _mm256_add_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 sub16(v16 x, v16 y) noexcept { return _mm256_sub_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 and16(v16 x, v16 y) noexcept { return _mm256_and_si256(x, y); }
TEXTPLANE_SIMD_INLINE v16 half16(v16 x) noexcept { return _mm256_srai_epi16(x, 1); }
TEXTPLANE_SIMD_INLINE v16 quarter16(v16 x) noexcept { return _mm256_srai_epi16(x, 2); }
// Unsigned bytes of a times signed ones of b, neighbouring products added.
TEXTPLANE_SIMD_INLINE v16 dot_bytes(v16 a, v16 b) noexcept { return _mm256_maddubs_epi16(a, b); }
TEXTPLANE_SIMD_INLINE vb pack_bytes(v16 a, v16 b) noexcept {
  return _mm256_permute4x64_epi64(_mm256_packus_epi16(a, b), 0xd8);
}
TEXTPLANE_SIMD_INLINE v16 join_groups(const __m128i* p) noexcept { return join128(p[0], p[1]); }
TEXTPLANE_SIMD_INLINE v16 repeat_group(__m128i p) noexcept { return _mm256_broadcastsi128_si256(p); }
TEXTPLANE_SIMD_INLINE v16 load_groups(const std::uint8_t* p) noexcept { return join128(load128(p), load128(p + 8)); }
TEXTPLANE_SIMD_INLINE v16 first16(int n) noexcept {
  const int limit = n < 0 ? 0 : (n < k16Lanes ? n : k16Lanes);
  const __m256i lane = _mm256_setr_epi16(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  return _mm256_cmpgt_epi16(set16(limit), lane);
}
TEXTPLANE_SIMD_INLINE double sumw(vw a) noexcept {
  return sum_of_four(_mm256_cvtepi32_pd(_mm256_castsi256_si128(a)) +
                     _mm256_cvtepi32_pd(_mm256_extracti128_si256(a, 1)));
}
TEXTPLANE_SIMD_INLINE v16 mul15(v16 x, v16 y) noexcept { return _mm256_mulhrs_epi16(x, y); }
TEXTPLANE_SIMD_INLINE vi add_dot16(vi sum, v16 x, v16 y) noexcept { return addi(sum, _mm256_madd_epi16(x, y)); }
TEXTPLANE_SIMD_INLINE v16 pack16(vi low, vi high) noexcept {
  return _mm256_permute4x64_epi64(_mm256_packs_epi32(low, high), 0xd8);
}
TEXTPLANE_SIMD_INLINE int reduce_sum_int(vi v) noexcept { return sum_of_eight(v); }
TEXTPLANE_SIMD_INLINE vi gather_pairs(const std::uint16_t* p, const int* offset) noexcept {
  return gather_pairs8(p, offset);
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
TEXTPLANE_SIMD_OPERATORS(__m256d, _mm256, pd)
struct vd {
  vp part[2];
};

TEXTPLANE_SIMD_INLINE vp set_p(double value) noexcept { return _mm256_set1_pd(value); }
TEXTPLANE_SIMD_INLINE vp load_p(const double* p) noexcept { return _mm256_loadu_pd(p); }
TEXTPLANE_SIMD_INLINE vp from_p(const double* const* p, std::ptrdiff_t at) noexcept {
  const __m128d low = _mm_loadh_pd(_mm_load_sd(p[0] + at), p[1] + at);
  return _mm256_insertf128_pd(_mm256_castpd128_pd256(low), _mm_loadh_pd(_mm_load_sd(p[2] + at), p[3] + at), 1);
}
TEXTPLANE_SIMD_INLINE void store_p(double* p, vp v) noexcept { _mm256_storeu_pd(p, v); }
TEXTPLANE_SIMD_INLINE vp madd_p(vp a, vp b, vp c) noexcept { return _mm256_fmadd_pd(a, b, c); }
TEXTPLANE_SIMD_INLINE vp min_p(vp a, vp b) noexcept { return _mm256_min_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp max_p(vp a, vp b) noexcept { return _mm256_max_pd(a, b); }
TEXTPLANE_SIMD_INLINE vp abs_p(vp a) noexcept { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
TEXTPLANE_SIMD_INLINE vp trunc_p(vp a) noexcept { return _mm256_round_pd(a, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC); }
TEXTPLANE_SIMD_INLINE vp positive_p(vp m, vp a, vp b) noexcept {
  return _mm256_blendv_pd(b, a, _mm256_cmp_pd(m, _mm256_setzero_pd(), _CMP_GT_OQ));
}
TEXTPLANE_SIMD_INLINE void store_as_float(float* p, vp v) noexcept { _mm_storeu_ps(p, _mm256_cvtpd_ps(v)); }

TEXTPLANE_SIMD_INLINE vd reduce_sum8(const float* p) noexcept {
  const __m256 q = join_pairs(join_lanes(load(p), load(p + 8)), join_lanes(load(p + 16), load(p + 24)));
  const __m256 r = join_pairs(join_lanes(load(p + 32), load(p + 40)), join_lanes(load(p + 48), load(p + 56)));
  const __m256 s = join_halves(q, r);
  return vd{{_mm256_cvtps_pd(_mm256_castps256_ps128(s)), _mm256_cvtps_pd(_mm256_extractf128_ps(s, 1))}};
}

// --- tiles ---
enum : int { kTileLanes = 8 };
TEXTPLANE_SIMD_INLINE vi per_tile(const int* b) noexcept { return seti(b[0]); }
TEXTPLANE_SIMD_INLINE bool in_two_rows(vi y) noexcept { return _mm256_testz_si256(y, _mm256_set1_epi32(~1)) != 0; }
TEXTPLANE_SIMD_INLINE vi tile_rows(const std::uint8_t* const* corner, std::ptrdiff_t offset) noexcept {
  return repeat_group(load128(corner[0] + offset));
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
TEXTPLANE_SIMD_INLINE v16 saturated_sub16(v16 v, int n) noexcept { return _mm256_subs_epu16(v, set16(n)); }
TEXTPLANE_SIMD_INLINE v16 pair_picks(v16 x) noexcept {
  return _mm256_add_epi16(_mm256_or_si256(x, _mm256_slli_epi16(x, 8)), set16(0x0100));
}
TEXTPLANE_SIMD_INLINE v16 choose16(v16 y, v16 a, v16 b) noexcept {
  return _mm256_blendv_epi8(a, b, _mm256_sub_epi16(_mm256_setzero_si256(), y));
}
TEXTPLANE_SIMD_INLINE v16 min_unsigned16(v16 v, v16 high) noexcept { return _mm256_min_epu16(v, high); }
TEXTPLANE_SIMD_INLINE v16 from_group(__m128i p) noexcept { return _mm256_castsi128_si256(p); }
TEXTPLANE_SIMD_INLINE __m128i first_group(v16 v) noexcept { return _mm256_castsi256_si128(v); }
TEXTPLANE_SIMD_INLINE v16 or16(v16 a, v16 b) noexcept { return _mm256_or_si256(a, b); }
TEXTPLANE_SIMD_INLINE unsigned any_of_four(v16 v) noexcept {
  const __m256i none = _mm256_cmpeq_epi64(v, _mm256_setzero_si256());
  return static_cast<unsigned>(_mm256_movemask_pd(_mm256_castsi256_pd(none))) ^ 15U;
}
TEXTPLANE_SIMD_INLINE void store_taps(std::uint32_t* p, v16 a, v16 b) noexcept {
  const __m256i low = _mm256_unpacklo_epi16(a, b), high = _mm256_unpackhi_epi16(a, b);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm256_permute2x128_si256(low, high, 0x20));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p + 8), _mm256_permute2x128_si256(low, high, 0x31));
}

#include "textplane/simd/ops/few_bytes.inl"
#include "textplane/simd/ops/x86_vectors.inl"

#include "textplane/simd/ops/x86_tiles.inl"
