// Operations of the sse41 target: vectors of 128 bits. ops/scalar.inl defines them.
// Include before: ops/common.inl.
#include "textplane/simd/ops/x86.inl"

// --- floats ---
constexpr int kLanes = 4;
constexpr bool kManyRegisters = false;
using vf = __m128;
TEXTPLANE_SIMD_OPERATORS(__m128, _mm, ps)
using vi = __m128i;
using vm = __m128;  // all bits of a lane

// --- make, load, store ---
TEXTPLANE_SIMD_INLINE vf set1(float value) noexcept { return _mm_set1_ps(value); }
TEXTPLANE_SIMD_INLINE vi seti(int value) noexcept { return _mm_set1_epi32(value); }
TEXTPLANE_SIMD_INLINE vf iota() noexcept { return _mm_setr_ps(0.0f, 1.0f, 2.0f, 3.0f); }
TEXTPLANE_SIMD_INLINE vi ioti() noexcept { return _mm_setr_epi32(0, 1, 2, 3); }
TEXTPLANE_SIMD_INLINE vf load(const float* p) noexcept { return _mm_loadu_ps(p); }
TEXTPLANE_SIMD_INLINE vf hold(vf v) noexcept {
  TEXTPLANE_SIMD_HOLD("+x", v);
  return v;
}
TEXTPLANE_SIMD_INLINE void store(float* p, vf v) noexcept { _mm_storeu_ps(p, v); }
TEXTPLANE_SIMD_INLINE vi loadi(const int* p) noexcept { return load128(p); }
TEXTPLANE_SIMD_INLINE void storei(int* p, vi v) noexcept { store128(p, v); }
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
TEXTPLANE_SIMD_INLINE vf gather(const float* p, const int* at) noexcept {
  return _mm_setr_ps(p[at[0]], p[at[1]], p[at[2]], p[at[3]]);
}

// --- float arithmetic ---
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
TEXTPLANE_SIMD_INLINE vf rough_inverse_root(vf a) noexcept { return _mm_rsqrt_ps(a); }
TEXTPLANE_SIMD_INLINE vf abs_(vf a) noexcept { return _mm_andnot_ps(_mm_set1_ps(-0.0f), a); }
TEXTPLANE_SIMD_INLINE vf floor_(vf a) noexcept { return _mm_floor_ps(a); }

// --- conversions ---
TEXTPLANE_SIMD_INLINE vi to_int(vf a) noexcept { return _mm_cvttps_epi32(a); }
TEXTPLANE_SIMD_INLINE vf to_float(vi a) noexcept { return _mm_cvtepi32_ps(a); }
TEXTPLANE_SIMD_INLINE vi as_int(vf a) noexcept { return _mm_castps_si128(a); }
TEXTPLANE_SIMD_INLINE vf as_float(vi a) noexcept { return _mm_castsi128_ps(a); }

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
TEXTPLANE_SIMD_INLINE vm eqi(vi a, vi b) noexcept { return _mm_castsi128_ps(_mm_cmpeq_epi32(a, b)); }
TEXTPLANE_SIMD_INLINE vm and_(vm a, vm b) noexcept { return _mm_and_ps(a, b); }
TEXTPLANE_SIMD_INLINE vm andnot_(vm a, vm b) noexcept { return _mm_andnot_ps(a, b); }
TEXTPLANE_SIMD_INLINE vf select(vm m, vf a, vf b) noexcept { return _mm_blendv_ps(b, a, m); }
TEXTPLANE_SIMD_INLINE vf keep(vm m, vf a) noexcept { return _mm_and_ps(m, a); }
TEXTPLANE_SIMD_INLINE vm first_n(int n) noexcept { return _mm_castsi128_ps(_mm_cmpgt_epi32(seti(n), ioti())); }
TEXTPLANE_SIMD_INLINE unsigned bits_from_mask(vm m) noexcept { return static_cast<unsigned>(_mm_movemask_ps(m)); }
TEXTPLANE_SIMD_INLINE int count_true(vm m) noexcept {
  // The number of ones in four bits, from a table in a word: SSE4.1 has no popcnt.
  return static_cast<int>((0x4332322132212110ull >> (4 * bits_from_mask(m))) & 15u);
}
TEXTPLANE_SIMD_INLINE bool all_true(vm m) noexcept { return bits_from_mask(m) == 15u; }

// --- reductions ---
TEXTPLANE_SIMD_INLINE float reduce_sum(vf a) noexcept { return sum_of_four(a); }
TEXTPLANE_SIMD_INLINE double reduce_sum_double(vf a) noexcept {
  return sum_of_two(_mm_add_pd(_mm_cvtps_pd(a), _mm_cvtps_pd(_mm_movehl_ps(a, a))));
}
TEXTPLANE_SIMD_INLINE float reduce_min(vf a) noexcept { return min_of_four(a); }
TEXTPLANE_SIMD_INLINE float reduce_max(vf a) noexcept { return max_of_four(a); }

// --- bilinear taps ---
struct taps_t {
  __m128i cells;
};
TEXTPLANE_SIMD_INLINE taps_t load_taps(const std::uint32_t* p) noexcept { return taps_t{load128(p)}; }
// The sum of the four bytes of each cell times the four signed bytes of `weights`: products of a pair fit 16 bits.
TEXTPLANE_SIMD_INLINE vf tap_dot(taps_t t, int weights) noexcept {
  const __m128i pairs = _mm_maddubs_epi16(t.cells, _mm_set1_epi32(weights));
  return _mm_cvtepi32_ps(_mm_madd_epi16(pairs, _mm_set1_epi16(1)));
}

TEXTPLANE_SIMD_INLINE void reduce_sum4(vf a, vf b, vf c, vf d, float* out) noexcept {
  _mm_storeu_ps(out, _mm_hadd_ps(_mm_hadd_ps(a, b), _mm_hadd_ps(c, d)));
}

// --- bytes ---
constexpr int kBytes = 16;
using vb = __m128i;

TEXTPLANE_SIMD_INLINE vb setb(int value) noexcept { return _mm_set1_epi8(static_cast<char>(value)); }
TEXTPLANE_SIMD_INLINE vb loadb(const std::uint8_t* p) noexcept { return load128(p); }
TEXTPLANE_SIMD_INLINE void storeb(std::uint8_t* p, vb a) noexcept { store128(p, a); }

TEXTPLANE_SIMD_INLINE vb addsb(vb a, vb b) noexcept { return _mm_adds_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb subsb(vb a, vb b) noexcept { return _mm_subs_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb minb(vb a, vb b) noexcept { return _mm_min_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb maxb(vb a, vb b) noexcept { return _mm_max_epu8(a, b); }
TEXTPLANE_SIMD_INLINE vb andb(vb a, vb b) noexcept { return _mm_and_si128(a, b); }
TEXTPLANE_SIMD_INLINE vb xorb(vb a, vb b) noexcept { return _mm_xor_si128(a, b); }
TEXTPLANE_SIMD_INLINE vb orb(vb a, vb b) noexcept { return _mm_or_si128(a, b); }

TEXTPLANE_SIMD_INLINE vb geb(vb a, vb b) noexcept { return _mm_cmpeq_epi8(_mm_max_epu8(a, b), a); }
TEXTPLANE_SIMD_INLINE bool anyb(vb a) noexcept { return _mm_testz_si128(a, a) == 0; }
TEXTPLANE_SIMD_INLINE std::uint64_t bitsb(vb mask) noexcept {
  return static_cast<std::uint32_t>(_mm_movemask_epi8(mask));
}

// --- int16 ---
enum : int { k16Lanes = 8 };
using v16 = __m128i;
using vw = __m128i;
constexpr int kPairsReach = 16;

TEXTPLANE_SIMD_INLINE v16 set16(int value) noexcept { return _mm_set1_epi16(static_cast<short>(value)); }
TEXTPLANE_SIMD_INLINE v16 load16(const std::int16_t* p) noexcept { return load128(p); }
TEXTPLANE_SIMD_INLINE void store16(std::int16_t* p, v16 v) noexcept { store128(p, v); }
TEXTPLANE_SIMD_INLINE v16 add16(v16 x, v16 y) noexcept { return _mm_add_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 sub16(v16 x, v16 y) noexcept { return _mm_sub_epi16(x, y); }
TEXTPLANE_SIMD_INLINE v16 and16(v16 x, v16 y) noexcept { return _mm_and_si128(x, y); }
TEXTPLANE_SIMD_INLINE v16 half16(v16 x) noexcept { return _mm_srai_epi16(x, 1); }
TEXTPLANE_SIMD_INLINE v16 quarter16(v16 x) noexcept { return _mm_srai_epi16(x, 2); }
// Unsigned bytes of a times signed ones of b, neighbouring products added.
TEXTPLANE_SIMD_INLINE v16 dot_bytes(v16 a, v16 b) noexcept { return _mm_maddubs_epi16(a, b); }
TEXTPLANE_SIMD_INLINE vb pack_bytes(v16 a, v16 b) noexcept { return _mm_packus_epi16(a, b); }
TEXTPLANE_SIMD_INLINE v16 join_groups(const __m128i* p) noexcept { return p[0]; }
TEXTPLANE_SIMD_INLINE v16 repeat_group(__m128i p) noexcept { return p; }
TEXTPLANE_SIMD_INLINE v16 load_groups(const std::uint8_t* p) noexcept { return load128(p); }
TEXTPLANE_SIMD_INLINE v16 first16(int n) noexcept {
  const int limit = n < 0 ? 0 : (n < k16Lanes ? n : k16Lanes);
  return _mm_cmplt_epi16(_mm_setr_epi16(0, 1, 2, 3, 4, 5, 6, 7), set16(limit));
}
TEXTPLANE_SIMD_INLINE double sumw(vw a) noexcept {
  return sum_of_two(_mm_add_pd(_mm_cvtepi32_pd(a), _mm_cvtepi32_pd(_mm_unpackhi_epi64(a, a))));
}
TEXTPLANE_SIMD_INLINE v16 mul15(v16 x, v16 y) noexcept { return _mm_mulhrs_epi16(x, y); }
TEXTPLANE_SIMD_INLINE vi add_dot16(vi sum, v16 x, v16 y) noexcept { return addi(sum, _mm_madd_epi16(x, y)); }
TEXTPLANE_SIMD_INLINE v16 pack16(vi low, vi high) noexcept { return _mm_packs_epi32(low, high); }
TEXTPLANE_SIMD_INLINE int reduce_sum_int(vi v) noexcept { return sum_of_four(v); }
TEXTPLANE_SIMD_INLINE vi gather_pairs(const std::uint16_t* p, const int* offset) noexcept {
  return gather_pairs4(p, offset);
}
TEXTPLANE_SIMD_INLINE v16 low16(vi a, vi b) noexcept {
  return _mm_packs_epi32(_mm_srai_epi32(_mm_slli_epi32(a, 16), 16), _mm_srai_epi32(_mm_slli_epi32(b, 16), 16));
}
TEXTPLANE_SIMD_INLINE v16 high16(vi a, vi b) noexcept {
  return _mm_packs_epi32(_mm_srai_epi32(a, 16), _mm_srai_epi32(b, 16));
}
TEXTPLANE_SIMD_INLINE vi widen_low16(v16 v) noexcept { return _mm_cvtepi16_epi32(v); }
TEXTPLANE_SIMD_INLINE vi widen_high16(v16 v) noexcept { return _mm_cvtepi16_epi32(_mm_srli_si128(v, 8)); }

// --- doubles ---
enum : int { kDoubles = 2 };
using vp = __m128d;
TEXTPLANE_SIMD_OPERATORS(__m128d, _mm, pd)
struct vd {
  vp part[4];
};

TEXTPLANE_SIMD_INLINE vp set_p(double value) noexcept { return _mm_set1_pd(value); }
TEXTPLANE_SIMD_INLINE vp load_p(const double* p) noexcept { return _mm_loadu_pd(p); }
TEXTPLANE_SIMD_INLINE vp from_p(const double* const* p, std::ptrdiff_t at) noexcept {
  return _mm_loadh_pd(_mm_load_sd(p[0] + at), p[1] + at);
}
TEXTPLANE_SIMD_INLINE void store_p(double* p, vp v) noexcept { _mm_storeu_pd(p, v); }
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

TEXTPLANE_SIMD_INLINE vd reduce_sum8(const float* p) noexcept {
  const __m128 q = _mm_hadd_ps(_mm_hadd_ps(load(p), load(p + 4)), _mm_hadd_ps(load(p + 8), load(p + 12)));
  const __m128 r = _mm_hadd_ps(_mm_hadd_ps(load(p + 16), load(p + 20)), _mm_hadd_ps(load(p + 24), load(p + 28)));
  return vd{{_mm_cvtps_pd(q), _mm_cvtps_pd(_mm_movehl_ps(q, q)), _mm_cvtps_pd(r), _mm_cvtps_pd(_mm_movehl_ps(r, r))}};
}

// --- tiles ---
enum : int { kTileLanes = 4 };
TEXTPLANE_SIMD_INLINE vi per_tile(const int* b) noexcept { return seti(b[0]); }
TEXTPLANE_SIMD_INLINE bool in_two_rows(vi y) noexcept { return _mm_testz_si128(y, _mm_set1_epi32(~1)) != 0; }
TEXTPLANE_SIMD_INLINE vi tile_rows(const std::uint8_t* const* corner, std::ptrdiff_t offset) noexcept {
  return load128(corner[0] + offset);
}
TEXTPLANE_SIMD_INLINE vi pick_bytes(vi rows, vi picks) noexcept { return _mm_shuffle_epi8(rows, picks); }
TEXTPLANE_SIMD_INLINE vi tile_picks(vi x) noexcept {
  const __m128i lowest = _mm_set_epi8(12, 12, 12, 12, 8, 8, 8, 8, 4, 4, 4, 4, 0, 0, 0, 0);
  return _mm_add_epi8(_mm_shuffle_epi8(x, lowest), _mm_set1_epi32(0x01000100));
}
TEXTPLANE_SIMD_INLINE taps_t two_rows(vi y, vi a, vi b, vi c) noexcept {
  const __m128i lower = _mm_sub_epi32(_mm_setzero_si128(), y);
  return taps_t{_mm_blendv_epi8(_mm_blend_epi16(a, b, 0xAA), _mm_blend_epi16(b, c, 0xAA), lower)};
}
TEXTPLANE_SIMD_INLINE void load2(const float* p, vf* a, vf* b) noexcept {
  const __m128 lo = _mm_loadu_ps(p), hi = _mm_loadu_ps(p + 4);
  *a = _mm_shuffle_ps(lo, hi, 0x88);
  *b = _mm_shuffle_ps(lo, hi, 0xDD);
}
TEXTPLANE_SIMD_INLINE void store_u8(std::uint8_t* p, vi v) noexcept {
  const __m128i pick = _mm_set_epi8(-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, 12, 8, 4, 0);
  const int word = _mm_cvtsi128_si32(_mm_shuffle_epi8(v, pick));
  TEXTPLANE_SIMD_COPY(p, &word, 4);
}

#include "textplane/simd/ops/few_bytes.inl"
#include "textplane/simd/ops/no_tiles.inl"
#include "textplane/simd/ops/x86_vectors.inl"
