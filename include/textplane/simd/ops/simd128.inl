// Operations of the simd128 target: WebAssembly's vectors of 128 bits. ops/scalar.inl defines them.
// Include before: ops/common.inl.
//
// Each has in mind what an engine makes of it on x86-64, where some instructions of WebAssembly are many: truncation,
// bytes picked by a variable, and shuffles of two vectors that are no interleaving.
//
// With -mrelaxed-simd (Clang 17 and later) the engine may take instructions of the CPU where these differ in what they
// make of rounding, or of numbers that are out of range: madd() then rounds once where the CPU can.

// --- floats ---
constexpr int kLanes = 4;
constexpr bool kManyRegisters = false;
using vf = float __attribute__((vector_size(16)));
using vi = v128_t;
using vm = v128_t;  // all bits of a lane

// --- make, load, store ---
TEXTPLANE_SIMD_INLINE vf set1(float value) noexcept { return vf{value, value, value, value}; }
TEXTPLANE_SIMD_INLINE vi seti(int value) noexcept { return wasm_i32x4_splat(value); }
TEXTPLANE_SIMD_INLINE vf iota() noexcept { return vf{0.0f, 1.0f, 2.0f, 3.0f}; }
TEXTPLANE_SIMD_INLINE vi ioti() noexcept { return wasm_i32x4_const(0, 1, 2, 3); }
TEXTPLANE_SIMD_INLINE vf as_float(vi a) noexcept { return reinterpret_cast<vf>(a); }
TEXTPLANE_SIMD_INLINE vi as_int(vf a) noexcept { return reinterpret_cast<vi>(a); }
TEXTPLANE_SIMD_INLINE vf load(const float* p) noexcept { return as_float(wasm_v128_load(p)); }
TEXTPLANE_SIMD_INLINE vf hold(vf v) noexcept { return v; }
TEXTPLANE_SIMD_INLINE void store(float* p, vf v) noexcept { wasm_v128_store(p, as_int(v)); }
TEXTPLANE_SIMD_INLINE vi loadi(const int* p) noexcept { return wasm_v128_load(p); }
TEXTPLANE_SIMD_INLINE void storei(int* p, vi v) noexcept { wasm_v128_store(p, v); }
TEXTPLANE_SIMD_INLINE vf load_n(const float* p, int n) noexcept {
  if (n >= 4) return load(p);
  if (n <= 0) return set1(0.0f);
  v128_t v = wasm_v128_load32_zero(p);
  if (n >= 2) v = wasm_v128_load32_lane(p + 1, v, 1);
  if (n >= 3) v = wasm_v128_load32_lane(p + 2, v, 2);
  return as_float(v);
}
TEXTPLANE_SIMD_INLINE void store_n(float* p, vf v, int n) noexcept {
  if (n >= 4) {
    store(p, v);
    return;
  }
  if (n >= 1) wasm_v128_store32_lane(p, as_int(v), 0);
  if (n >= 2) wasm_v128_store32_lane(p + 1, as_int(v), 1);
  if (n >= 3) wasm_v128_store32_lane(p + 2, as_int(v), 2);
}
TEXTPLANE_SIMD_INLINE vf gather(const float* p, const int* at) noexcept {
  v128_t v = wasm_v128_load32_zero(p + at[0]);
  v = wasm_v128_load32_lane(p + at[1], v, 1);
  v = wasm_v128_load32_lane(p + at[2], v, 2);
  return as_float(wasm_v128_load32_lane(p + at[3], v, 3));
}

// --- float arithmetic ---
#ifdef __wasm_relaxed_simd__
TEXTPLANE_SIMD_INLINE vf madd(vf a, vf b, vf c) noexcept { return __builtin_wasm_relaxed_madd_f32x4(a, b, c); }
TEXTPLANE_SIMD_INLINE vf nmadd(vf a, vf b, vf c) noexcept { return __builtin_wasm_relaxed_nmadd_f32x4(a, b, c); }
#else
TEXTPLANE_SIMD_INLINE vf madd(vf a, vf b, vf c) noexcept { return a * b + c; }
TEXTPLANE_SIMD_INLINE vf nmadd(vf a, vf b, vf c) noexcept { return c - a * b; }
#endif
// These are "the second where it is less (greater) than the first, else the first".
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept { return as_float(wasm_f32x4_pmin(as_int(b), as_int(a))); }
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept { return as_float(wasm_f32x4_pmax(as_int(b), as_int(a))); }
TEXTPLANE_SIMD_INLINE vf sqrt_(vf a) noexcept { return as_float(wasm_f32x4_sqrt(as_int(a))); }
TEXTPLANE_SIMD_INLINE vf inverse_root(vf a) noexcept { return set1(1.0f) / sqrt_(a); }
TEXTPLANE_SIMD_INLINE vf abs_(vf a) noexcept { return as_float(wasm_f32x4_abs(as_int(a))); }
TEXTPLANE_SIMD_INLINE vf floor_(vf a) noexcept { return as_float(wasm_f32x4_floor(as_int(a))); }

// --- conversions ---
#ifdef __wasm_relaxed_simd__
TEXTPLANE_SIMD_INLINE vi to_int(vf a) noexcept {
  return reinterpret_cast<vi>(__builtin_wasm_relaxed_trunc_s_i32x4_f32x4(a));
}
#else
TEXTPLANE_SIMD_INLINE vi to_int(vf a) noexcept { return wasm_i32x4_trunc_sat_f32x4(as_int(a)); }
#endif
TEXTPLANE_SIMD_INLINE vf to_float(vi a) noexcept { return as_float(wasm_f32x4_convert_i32x4(a)); }

// --- int32 arithmetic ---
TEXTPLANE_SIMD_INLINE vi addi(vi a, vi b) noexcept { return wasm_i32x4_add(a, b); }
TEXTPLANE_SIMD_INLINE vi subi(vi a, vi b) noexcept { return wasm_i32x4_sub(a, b); }
TEXTPLANE_SIMD_INLINE vi muli(vi a, vi b) noexcept { return wasm_i32x4_mul(a, b); }
TEXTPLANE_SIMD_INLINE vi mini(vi a, vi b) noexcept { return wasm_i32x4_min(a, b); }
TEXTPLANE_SIMD_INLINE vi maxi(vi a, vi b) noexcept { return wasm_i32x4_max(a, b); }
TEXTPLANE_SIMD_INLINE vi shl(vi a, int bits) noexcept { return wasm_i32x4_shl(a, static_cast<unsigned>(bits)); }
TEXTPLANE_SIMD_INLINE vi shr(vi a, int bits) noexcept { return wasm_i32x4_shr(a, static_cast<unsigned>(bits)); }
TEXTPLANE_SIMD_INLINE vi andi(vi a, vi b) noexcept { return wasm_v128_and(a, b); }
TEXTPLANE_SIMD_INLINE vi ori(vi a, vi b) noexcept { return wasm_v128_or(a, b); }

// --- masks ---
TEXTPLANE_SIMD_INLINE vm lt(vf a, vf b) noexcept { return wasm_f32x4_lt(as_int(a), as_int(b)); }
TEXTPLANE_SIMD_INLINE vm le(vf a, vf b) noexcept { return wasm_f32x4_le(as_int(a), as_int(b)); }
TEXTPLANE_SIMD_INLINE vm gt(vf a, vf b) noexcept { return wasm_f32x4_gt(as_int(a), as_int(b)); }
TEXTPLANE_SIMD_INLINE vm ge(vf a, vf b) noexcept { return wasm_f32x4_ge(as_int(a), as_int(b)); }
TEXTPLANE_SIMD_INLINE vm eq(vf a, vf b) noexcept { return wasm_f32x4_eq(as_int(a), as_int(b)); }
TEXTPLANE_SIMD_INLINE vm eqi(vi a, vi b) noexcept { return wasm_i32x4_eq(a, b); }
TEXTPLANE_SIMD_INLINE vm and_(vm a, vm b) noexcept { return wasm_v128_and(a, b); }
TEXTPLANE_SIMD_INLINE vm andnot_(vm a, vm b) noexcept { return wasm_v128_andnot(b, a); }
TEXTPLANE_SIMD_INLINE vf select(vm m, vf a, vf b) noexcept {
  return as_float(wasm_v128_bitselect(as_int(a), as_int(b), m));
}
TEXTPLANE_SIMD_INLINE vf keep(vm m, vf a) noexcept { return as_float(wasm_v128_and(m, as_int(a))); }
TEXTPLANE_SIMD_INLINE vm first_n(int n) noexcept { return wasm_i32x4_lt(ioti(), seti(n)); }
TEXTPLANE_SIMD_INLINE unsigned bits_from_mask(vm m) noexcept { return static_cast<unsigned>(wasm_i32x4_bitmask(m)); }
TEXTPLANE_SIMD_INLINE int count_true(vm m) noexcept { return __builtin_popcount(bits_from_mask(m)); }
TEXTPLANE_SIMD_INLINE bool all_true(vm m) noexcept { return bits_from_mask(m) == 15u; }

// --- reductions ---
TEXTPLANE_SIMD_INLINE vf upper_half(vf a) noexcept { return __builtin_shufflevector(a, a, 2, 3, 2, 3); }
TEXTPLANE_SIMD_INLINE float reduce_sum(vf a) noexcept {
  const vf two = a + upper_half(a);
  return two[0] + two[1];
}
TEXTPLANE_SIMD_INLINE float reduce_min(vf a) noexcept {
  const vf two = min_(a, upper_half(a));
  return min_(two, __builtin_shufflevector(two, two, 1, 1, 1, 1))[0];
}
TEXTPLANE_SIMD_INLINE float reduce_max(vf a) noexcept {
  const vf two = max_(a, upper_half(a));
  return max_(two, __builtin_shufflevector(two, two, 1, 1, 1, 1))[0];
}

// --- bilinear taps ---
struct taps_t {
  v128_t cells;
};
TEXTPLANE_SIMD_INLINE taps_t load_taps(const std::uint32_t* p) noexcept { return taps_t{wasm_v128_load(p)}; }
// As int16: I(x,y) and I(x,y+1) of each cell, and the right neighbours of these minus them.
TEXTPLANE_SIMD_INLINE v128_t left_taps(taps_t t) noexcept { return wasm_v128_and(t.cells, seti(0x00ff00ff)); }
TEXTPLANE_SIMD_INLINE v128_t tap_differences(taps_t t) noexcept {
  return wasm_i16x8_sub(wasm_u16x8_shr(t.cells, 8), left_taps(t));
}
TEXTPLANE_SIMD_INLINE vf tap_value(taps_t t) noexcept { return to_float(andi(t.cells, seti(255))); }
TEXTPLANE_SIMD_INLINE vf tap_dx(taps_t t) noexcept {
  return to_float(wasm_i32x4_dot_i16x8(tap_differences(t), seti(1)));
}
TEXTPLANE_SIMD_INLINE vf tap_dy(taps_t t) noexcept {
  return to_float(wasm_i32x4_dot_i16x8(left_taps(t), seti(0x0001ffff)));
}
TEXTPLANE_SIMD_INLINE vf tap_dxy(taps_t t) noexcept {
  return to_float(wasm_i32x4_dot_i16x8(tap_differences(t), seti(0x0001ffff)));
}

// --- one number ---
TEXTPLANE_SIMD_INLINE double sqrt_d(double a) noexcept { return __builtin_sqrt(a); }
TEXTPLANE_SIMD_INLINE int lowest_bit(std::uint64_t bits) noexcept { return __builtin_ctzll(bits); }

TEXTPLANE_SIMD_INLINE void fetch_four(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset,
                                      std::uint32_t* taps) noexcept {
  v128_t v = wasm_v128_load16_lane(upper + offset[0], wasm_i32x4_const(0, 0, 0, 0), 0);
  v = wasm_v128_load16_lane(lower + offset[0], v, 1);
  v = wasm_v128_load16_lane(upper + offset[1], v, 2);
  v = wasm_v128_load16_lane(lower + offset[1], v, 3);
  v = wasm_v128_load16_lane(upper + offset[2], v, 4);
  v = wasm_v128_load16_lane(lower + offset[2], v, 5);
  v = wasm_v128_load16_lane(upper + offset[3], v, 6);
  wasm_v128_store(taps, wasm_v128_load16_lane(lower + offset[3], v, 7));
}

// Interleaves, then adds: an addition across lanes would be three shuffles.
TEXTPLANE_SIMD_INLINE vf sums_of_four(vf a, vf b, vf c, vf d) noexcept {
  const vf ab = __builtin_shufflevector(a, b, 0, 4, 1, 5), AB = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const vf cd = __builtin_shufflevector(c, d, 0, 4, 1, 5), CD = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  return (__builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7)) +
         (__builtin_shufflevector(AB, CD, 0, 1, 4, 5) + __builtin_shufflevector(AB, CD, 2, 3, 6, 7));
}
TEXTPLANE_SIMD_INLINE void reduce_sum4(vf a, vf b, vf c, vf d, float* out) noexcept {
  store(out, sums_of_four(a, b, c, d));
}

#include "textplane/simd/ops/simd128_integers.inl"

// --- doubles ---
enum : int { kDoubles = 2 };
using vp = double __attribute__((vector_size(16)));
struct vd {
  vp part[4];
};

TEXTPLANE_SIMD_INLINE vp as_double(v128_t a) noexcept { return reinterpret_cast<vp>(a); }
TEXTPLANE_SIMD_INLINE v128_t bits_p(vp a) noexcept { return reinterpret_cast<v128_t>(a); }
TEXTPLANE_SIMD_INLINE vp set_p(double value) noexcept { return vp{value, value}; }
TEXTPLANE_SIMD_INLINE vp load_p(const double* p) noexcept { return as_double(wasm_v128_load(p)); }
TEXTPLANE_SIMD_INLINE vp from_p(const double* const* p, std::ptrdiff_t at) noexcept { return vp{p[0][at], p[1][at]}; }
TEXTPLANE_SIMD_INLINE void store_p(double* p, vp v) noexcept { wasm_v128_store(p, bits_p(v)); }
TEXTPLANE_SIMD_INLINE vp madd_p(vp a, vp b, vp c) noexcept { return a * b + c; }
TEXTPLANE_SIMD_INLINE vp min_p(vp a, vp b) noexcept { return as_double(wasm_f64x2_pmin(bits_p(b), bits_p(a))); }
TEXTPLANE_SIMD_INLINE vp max_p(vp a, vp b) noexcept { return as_double(wasm_f64x2_pmax(bits_p(b), bits_p(a))); }
TEXTPLANE_SIMD_INLINE vp abs_p(vp a) noexcept { return as_double(wasm_f64x2_abs(bits_p(a))); }
TEXTPLANE_SIMD_INLINE vp trunc_p(vp a) noexcept { return as_double(wasm_f64x2_trunc(bits_p(a))); }
TEXTPLANE_SIMD_INLINE vp positive_p(vp m, vp a, vp b) noexcept {
  return as_double(wasm_v128_bitselect(bits_p(a), bits_p(b), wasm_f64x2_gt(bits_p(m), bits_p(set_p(0)))));
}
TEXTPLANE_SIMD_INLINE void store_as_float(float* p, vp v) noexcept {
  wasm_v128_store64_lane(p, wasm_f32x4_demote_f64x2_zero(bits_p(v)), 0);
}
TEXTPLANE_SIMD_INLINE vp widen_low(vf a) noexcept { return as_double(wasm_f64x2_promote_low_f32x4(as_int(a))); }
TEXTPLANE_SIMD_INLINE double reduce_sum_double(vf a) noexcept {
  const vp two = widen_low(a) + widen_low(upper_half(a));
  return two[0] + two[1];
}
TEXTPLANE_SIMD_INLINE double sumw(vw a) noexcept {
  const vp two = as_double(wasm_f64x2_convert_low_i32x4(a)) +
                 as_double(wasm_f64x2_convert_low_i32x4(wasm_i32x4_shuffle(a, a, 2, 3, 2, 3)));
  return two[0] + two[1];
}

TEXTPLANE_SIMD_INLINE vd reduce_sum8(const float* p) noexcept {
  const vf q = sums_of_four(load(p), load(p + 4), load(p + 8), load(p + 12));
  const vf r = sums_of_four(load(p + 16), load(p + 20), load(p + 24), load(p + 28));
  return vd{{widen_low(q), widen_low(upper_half(q)), widen_low(r), widen_low(upper_half(r))}};
}

// --- tiles ---
enum : int { kTileLanes = 4 };
TEXTPLANE_SIMD_INLINE vi per_tile(const int* b) noexcept { return seti(b[0]); }
TEXTPLANE_SIMD_INLINE bool in_two_rows(vi y) noexcept { return !wasm_v128_any_true(wasm_v128_and(y, seti(~1))); }
TEXTPLANE_SIMD_INLINE vi tile_rows(const std::uint8_t* const* corner, std::ptrdiff_t offset) noexcept {
  return wasm_v128_load(corner[0] + offset);
}
TEXTPLANE_SIMD_INLINE vi pick_bytes(vi rows, vi picks) noexcept { return wasm_i8x16_swizzle(rows, picks); }
TEXTPLANE_SIMD_INLINE vi tile_picks(vi x) noexcept {
  // Each byte of a lane gets the lane's x, which is below 16.
  return addi(muli(x, seti(0x01010101)), seti(0x01000100));
}
TEXTPLANE_SIMD_INLINE taps_t two_rows(vi y, vi a, vi b, vi c) noexcept {
  const v128_t top = seti(0x0000ffff), lower = subi(seti(0), y);
  return taps_t{wasm_v128_bitselect(wasm_v128_bitselect(b, c, top), wasm_v128_bitselect(a, b, top), lower)};
}
TEXTPLANE_SIMD_INLINE void load2(const float* p, vf* a, vf* b) noexcept {
  const vf lo = load(p), hi = load(p + 4);
  *a = __builtin_shufflevector(lo, hi, 0, 2, 4, 6);
  *b = __builtin_shufflevector(lo, hi, 1, 3, 5, 7);
}
TEXTPLANE_SIMD_INLINE void store_u8(std::uint8_t* p, vi v) noexcept {
  const v128_t half = wasm_i16x8_narrow_i32x4(v, v);
  wasm_v128_store32_lane(p, wasm_u8x16_narrow_i16x8(half, half), 0);
}

#include "textplane/simd/ops/few_bytes.inl"
#include "textplane/simd/ops/no_tiles.inl"
