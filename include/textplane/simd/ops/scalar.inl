// Operations of the scalar target, in plain C++: the definition of every operation. The other files say the same in
// intrinsics. Include before: ops/common.inl.
//
// Lanes are counted from 0. `_n` loads leave the lanes from n on at zero and touch no memory beyond n; `_n` stores
// write n elements and no more; 0 <= n <= lanes. Memory need not be aligned.

// --- floats ---
constexpr int kLanes = 1;
constexpr bool kManyRegisters = false;
using vf = float;  // kLanes floats
using vi = int;    // kLanes int32
using vm = bool;   // kLanes truth values

// --- make, load, store ---
TEXTPLANE_SIMD_INLINE vf set1(float value) noexcept { return value; }
TEXTPLANE_SIMD_INLINE vi seti(int value) noexcept { return value; }
TEXTPLANE_SIMD_INLINE vf iota() noexcept { return 0.0f; }  // 0, 1, 2, ...
TEXTPLANE_SIMD_INLINE vi ioti() noexcept { return 0; }
TEXTPLANE_SIMD_INLINE vf load(const float* p) noexcept { return *p; }
// The same value, in a register from here on: g++ would load it again for each use.
TEXTPLANE_SIMD_INLINE vf hold(vf v) noexcept { return v; }
TEXTPLANE_SIMD_INLINE void store(float* p, vf v) noexcept { *p = v; }
TEXTPLANE_SIMD_INLINE vi loadi(const int* p) noexcept { return *p; }
TEXTPLANE_SIMD_INLINE void storei(int* p, vi v) noexcept { *p = v; }
TEXTPLANE_SIMD_INLINE vf load_n(const float* p, int n) noexcept { return n > 0 ? *p : 0.0f; }
TEXTPLANE_SIMD_INLINE void store_n(float* p, vf v, int n) noexcept {
  if (n > 0) *p = v;
}
TEXTPLANE_SIMD_INLINE vf gather(const float* p, const int* at) noexcept { return p[*at]; }  // p[at[i]]

// --- float arithmetic ---
// a b + c and c - a b: one rounding on the fused targets (avx2, avx512, neon), two on the others.
TEXTPLANE_SIMD_INLINE vf madd(vf a, vf b, vf c) noexcept { return a * b + c; }
TEXTPLANE_SIMD_INLINE vf nmadd(vf a, vf b, vf c) noexcept { return c - a * b; }
// The second operand where either is NaN, and where both are zero.
#if TEXTPLANE_SIMD_HIDE_MINIMA
TEXTPLANE_SIMD_INLINE bool is_nan_(vf a) noexcept {
  unsigned word = 0;
  TEXTPLANE_SIMD_COPY(&word, &a, sizeof word);
  return (word & 0x7fffffffu) > 0x7f800000u;
}
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept { return is_nan_(a) || is_nan_(b) || !(a < b) ? b : a; }
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept { return is_nan_(a) || is_nan_(b) || !(a > b) ? b : a; }
#else
TEXTPLANE_SIMD_INLINE vf min_(vf a, vf b) noexcept { return a < b ? a : b; }
TEXTPLANE_SIMD_INLINE vf max_(vf a, vf b) noexcept { return a > b ? a : b; }
#endif
TEXTPLANE_SIMD_INLINE vf sqrt_(vf a) noexcept { return TEXTPLANE_SIMD_SQRT(a); }
// 1 / sqrt(a) within 3e-7 of itself, for positive numbers that are not subnormal.
TEXTPLANE_SIMD_INLINE vf inverse_root(vf a) noexcept { return 1.0f / sqrt_(a); }
TEXTPLANE_SIMD_INLINE vf abs_(vf a) noexcept { return TEXTPLANE_SIMD_ABS(a); }
TEXTPLANE_SIMD_INLINE vf floor_(vf a) noexcept { return TEXTPLANE_SIMD_FLOOR(a); }

// --- conversions: to_int truncates; its result for NaN and beyond int32 is unspecified (no undefined behaviour) ---
TEXTPLANE_SIMD_INLINE vi to_int(vf a) noexcept {
  return a >= -2147483648.0f && a < 2147483648.0f ? static_cast<int>(a) : -2147483647 - 1;
}
TEXTPLANE_SIMD_INLINE vf to_float(vi a) noexcept { return static_cast<float>(a); }

// The same bits.
TEXTPLANE_SIMD_INLINE vi as_int(vf a) noexcept {
  vi bits;
  copy_bytes(&bits, &a, 4);
  return bits;
}
TEXTPLANE_SIMD_INLINE vf as_float(vi a) noexcept {
  vf value;
  copy_bytes(&value, &a, 4);
  return value;
}

// --- int32 arithmetic: wraps; shr keeps the sign; 0 <= bits < 32 ---
TEXTPLANE_SIMD_INLINE vi addi(vi a, vi b) noexcept {
  return static_cast<int>(static_cast<unsigned>(a) + static_cast<unsigned>(b));
}
TEXTPLANE_SIMD_INLINE vi subi(vi a, vi b) noexcept {
  return static_cast<int>(static_cast<unsigned>(a) - static_cast<unsigned>(b));
}
TEXTPLANE_SIMD_INLINE vi muli(vi a, vi b) noexcept {
  return static_cast<int>(static_cast<unsigned>(a) * static_cast<unsigned>(b));
}
TEXTPLANE_SIMD_INLINE vi mini(vi a, vi b) noexcept { return a < b ? a : b; }
TEXTPLANE_SIMD_INLINE vi maxi(vi a, vi b) noexcept { return a > b ? a : b; }
TEXTPLANE_SIMD_INLINE vi shl(vi a, int bits) noexcept { return static_cast<int>(static_cast<unsigned>(a) << bits); }
TEXTPLANE_SIMD_INLINE vi shr(vi a, int bits) noexcept { return a >> bits; }
TEXTPLANE_SIMD_INLINE vi andi(vi a, vi b) noexcept { return a & b; }
TEXTPLANE_SIMD_INLINE vi ori(vi a, vi b) noexcept { return a | b; }

// --- masks; comparisons with NaN are false ---
TEXTPLANE_SIMD_INLINE vm lt(vf a, vf b) noexcept { return a < b; }
TEXTPLANE_SIMD_INLINE vm le(vf a, vf b) noexcept { return a <= b; }
TEXTPLANE_SIMD_INLINE vm gt(vf a, vf b) noexcept { return a > b; }
TEXTPLANE_SIMD_INLINE vm ge(vf a, vf b) noexcept { return a >= b; }
TEXTPLANE_SIMD_INLINE vm eq(vf a, vf b) noexcept { return a == b; }
TEXTPLANE_SIMD_INLINE vm eqi(vi a, vi b) noexcept { return a == b; }
TEXTPLANE_SIMD_INLINE vm and_(vm a, vm b) noexcept { return a && b; }
TEXTPLANE_SIMD_INLINE vm andnot_(vm a, vm b) noexcept { return !a && b; }  // not a, and b
TEXTPLANE_SIMD_INLINE vf select(vm m, vf a, vf b) noexcept { return m ? a : b; }
TEXTPLANE_SIMD_INLINE vf keep(vm m, vf a) noexcept { return m ? a : 0.0f; }
TEXTPLANE_SIMD_INLINE vm first_n(int n) noexcept { return n > 0; }                    // lanes below n; any n
TEXTPLANE_SIMD_INLINE unsigned bits_from_mask(vm m) noexcept { return m ? 1u : 0u; }  // bit i is lane i
TEXTPLANE_SIMD_INLINE int count_true(vm m) noexcept { return m ? 1 : 0; }
TEXTPLANE_SIMD_INLINE bool all_true(vm m) noexcept { return m; }

// --- reductions: the upper half of the lanes joins the lower half until one is left; _double: in double ---
TEXTPLANE_SIMD_INLINE float reduce_sum(vf a) noexcept { return a; }
TEXTPLANE_SIMD_INLINE double reduce_sum_double(vf a) noexcept { return static_cast<double>(a); }
TEXTPLANE_SIMD_INLINE float reduce_min(vf a) noexcept { return a; }
TEXTPLANE_SIMD_INLINE float reduce_max(vf a) noexcept { return a; }

// --- bilinear taps: kLanes cells I(x,y) | I(x+1,y) << 8 | I(x,y+1) << 16 | I(x+1,y+1) << 24 ---
// value = I(x,y), dx = I(x+1,y) - I(x,y), dy = I(x,y+1) - I(x,y), dxy = I(x,y) - I(x+1,y) - I(x,y+1) + I(x+1,y+1):
// exact.
struct taps_t {
  std::uint32_t cells;
};
TEXTPLANE_SIMD_INLINE taps_t load_taps(const std::uint32_t* p) noexcept { return taps_t{*p}; }
TEXTPLANE_SIMD_INLINE int tap_byte(taps_t t, int i) noexcept { return static_cast<int>((t.cells >> (8 * i)) & 255u); }
TEXTPLANE_SIMD_INLINE vf tap_value(taps_t t) noexcept { return static_cast<float>(tap_byte(t, 0)); }
TEXTPLANE_SIMD_INLINE vf tap_dx(taps_t t) noexcept { return static_cast<float>(tap_byte(t, 1) - tap_byte(t, 0)); }
TEXTPLANE_SIMD_INLINE vf tap_dy(taps_t t) noexcept { return static_cast<float>(tap_byte(t, 2) - tap_byte(t, 0)); }
TEXTPLANE_SIMD_INLINE vf tap_dxy(taps_t t) noexcept {
  return static_cast<float>(tap_byte(t, 0) - tap_byte(t, 1) - tap_byte(t, 2) + tap_byte(t, 3));
}

// --- one number ---
TEXTPLANE_SIMD_INLINE double sqrt_d(double a) noexcept { return TEXTPLANE_SIMD_SQRT_D(a); }
// The number of the lowest bit that is set; bits != 0.
TEXTPLANE_SIMD_INLINE int lowest_bit(std::uint64_t bits) noexcept {
  int bit = 0;
  for (; (bits & 1u) == 0; bits >>= 1) ++bit;
  return bit;
}

// Four cells of taps, each of two bytes of the upper row and, above them, two of the lower.
TEXTPLANE_SIMD_INLINE void fetch_four(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset,
                                      std::uint32_t* taps) noexcept {
  fetch_four_words(upper, lower, offset, taps);
}

// --- 8 doubles, on every target ---

// reduce_sum of four vectors to out[0 .. 3]: neighbouring lanes join first.
TEXTPLANE_SIMD_INLINE void reduce_sum4(vf a, vf b, vf c, vf d, float* out) noexcept {
  out[0] = a;
  out[1] = b;
  out[2] = c;
  out[3] = d;
}

// --- bytes ---
constexpr int kBytes = 1;
using vb = int;  // kBytes uint8; here one in [0, 255]

// --- make, load, store ---
TEXTPLANE_SIMD_INLINE vb setb(int value) noexcept { return value & 255; }  // value in [0, 255] in all lanes
TEXTPLANE_SIMD_INLINE vb loadb(const std::uint8_t* p) noexcept { return *p; }
TEXTPLANE_SIMD_INLINE void storeb(std::uint8_t* p, vb a) noexcept { *p = static_cast<std::uint8_t>(a); }

// --- arithmetic, unsigned: addsb and subsb end at 255 and 0 ---
TEXTPLANE_SIMD_INLINE vb addsb(vb a, vb b) noexcept { return a + b < 255 ? a + b : 255; }
TEXTPLANE_SIMD_INLINE vb subsb(vb a, vb b) noexcept { return a > b ? a - b : 0; }
TEXTPLANE_SIMD_INLINE vb minb(vb a, vb b) noexcept { return a < b ? a : b; }
TEXTPLANE_SIMD_INLINE vb maxb(vb a, vb b) noexcept { return a > b ? a : b; }
TEXTPLANE_SIMD_INLINE vb andb(vb a, vb b) noexcept { return a & b; }
TEXTPLANE_SIMD_INLINE vb orb(vb a, vb b) noexcept { return a | b; }
// Means (a + b + c + d + 2) / 4, rounded down, of 2 x 2 blocks: `upper0` and `upper1` hold 2 kBytes neighbours of one
// row, `lower0` and `lower1` those below.
TEXTPLANE_SIMD_INLINE vb mean4b(vb upper0, vb upper1, vb lower0, vb lower1) noexcept {
  return (upper0 + upper1 + lower0 + lower1 + 2) >> 2;
}

// --- masks: 255 where true, 0 where not ---
TEXTPLANE_SIMD_INLINE vb geb(vb a, vb b) noexcept { return a >= b ? 255 : 0; }
TEXTPLANE_SIMD_INLINE bool anyb(vb a) noexcept { return a != 0; }  // any byte that is not 0; a need not be a mask
TEXTPLANE_SIMD_INLINE std::uint64_t bitsb(vb mask) noexcept { return mask != 0 ? 1u : 0u; }  // bit i is lane i
// --- int16; sums and differences wrap ---
enum : int { k16Lanes = 2 };
constexpr int kPairsReach = 3;  // bytes from p on that mix_pairs() may read; it needs k16Lanes + 1
using vw = std::int64_t;        // sums of products: int32 in the vectors
struct v16 {
  std::int16_t a, b;
};

TEXTPLANE_SIMD_INLINE v16 make16(int a, int b) noexcept {
  return v16{static_cast<std::int16_t>(a), static_cast<std::int16_t>(b)};
}
TEXTPLANE_SIMD_INLINE v16 set16(int value) noexcept { return make16(value, value); }
TEXTPLANE_SIMD_INLINE v16 load16(const std::int16_t* p) noexcept { return v16{p[0], p[1]}; }
TEXTPLANE_SIMD_INLINE void store16(std::int16_t* p, v16 v) noexcept {
  p[0] = v.a;
  p[1] = v.b;
}
TEXTPLANE_SIMD_INLINE v16 add16(v16 x, v16 y) noexcept { return make16(x.a + y.a, x.b + y.b); }
TEXTPLANE_SIMD_INLINE v16 sub16(v16 x, v16 y) noexcept { return make16(x.a - y.a, x.b - y.b); }
TEXTPLANE_SIMD_INLINE v16 and16(v16 x, v16 y) noexcept { return make16(x.a & y.a, x.b & y.b); }
TEXTPLANE_SIMD_INLINE v16 half16(v16 x) noexcept { return make16(x.a >> 1, x.b >> 1); }  // rounded down
// -1 in the lanes below n, 0 in the others; any n.
TEXTPLANE_SIMD_INLINE v16 first16(int n) noexcept { return make16(n > 0 ? -1 : 0, n > 1 ? -1 : 0); }
// w0 (p[i] - 128) + w1 (p[i + 1] - 128) in lane i, of pair_weights(w0, w1).
TEXTPLANE_SIMD_INLINE v16 mix_pairs(const std::uint8_t* p, v16 weights) noexcept {
  return make16((weights.a & 255) * (p[0] - 128) + (weights.a >> 8) * (p[1] - 128),
                (weights.b & 255) * (p[1] - 128) + (weights.b >> 8) * (p[2] - 128));
}
// Sum of all lanes: exact, as every partial sum is an integer below 2^53.
TEXTPLANE_SIMD_INLINE double sumw(vw a) noexcept { return static_cast<double>(a); }
// x y / 2^15, rounded to the nearest, halves up; not both -2^15.
TEXTPLANE_SIMD_INLINE v16 mul15(v16 x, v16 y) noexcept {
  return make16((x.a * y.a + 16384) >> 15, (x.b * y.b + 16384) >> 15);
}
// Of the two bytes of each lane, unsigned: low * w0 + high * w1, weights in [-64, 64].
TEXTPLANE_SIMD_INLINE v16 dot_pair(v16 t, int w0, int w1) noexcept {
  return make16((t.a & 255) * w0 + ((t.a >> 8) & 255) * w1, (t.b & 255) * w0 + ((t.b >> 8) & 255) * w1);
}
// int32 lane i: sum[i] + x[2i] y[2i] + x[2i+1] y[2i+1].
TEXTPLANE_SIMD_INLINE vi add_dot16(vi sum, v16 x, v16 y) noexcept { return sum + (x.a * y.a + x.b * y.b); }
TEXTPLANE_SIMD_INLINE vw add_dot16(vw sum, v16 x, v16 y) noexcept { return sum + x.a * y.a + x.b * y.b; }
// 2 kLanes int32 that fit int16, in order.
TEXTPLANE_SIMD_INLINE v16 pack16(vi low, vi high) noexcept { return make16(low, high); }
// Sum of the lanes; it wraps.
TEXTPLANE_SIMD_INLINE int reduce_sum_int(vi v) noexcept { return v; }
// Lane i: the two bytes at upper (lower) + offset[i], the first of them low. Reads these bytes alone.
TEXTPLANE_SIMD_INLINE void gather16(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* first,
                                    v16* second) noexcept {
  *first = make16(static_cast<int>(load_u16(upper + offset[0])), static_cast<int>(load_u16(upper + offset[1])));
  *second = make16(static_cast<int>(load_u16(lower + offset[0])), static_cast<int>(load_u16(lower + offset[1])));
}
// Lane i: the low (high) half of lane i of the 2 kLanes int32 in a and b.
TEXTPLANE_SIMD_INLINE v16 low16(vi a, vi b) noexcept { return make16(a, b); }
TEXTPLANE_SIMD_INLINE v16 high16(vi a, vi b) noexcept { return make16(a >> 16, b >> 16); }
// Lane i: the two int16 at p + offset[i], the first of them low. Reads these alone.
TEXTPLANE_SIMD_INLINE vi gather_pairs(const std::uint16_t* p, const int* offset) noexcept {
  return static_cast<int>(int16_pair(p + offset[0]));
}
// The first and the second half of the lanes as int32.
TEXTPLANE_SIMD_INLINE vi widen_low16(v16 v) noexcept { return v.a; }
TEXTPLANE_SIMD_INLINE vi widen_high16(v16 v) noexcept { return v.b; }

// --- doubles ---
enum : int { kDoubles = 1 };
using vp = double;
struct vd {
  vp part[8];
};

TEXTPLANE_SIMD_INLINE vp set_p(double value) noexcept { return value; }
TEXTPLANE_SIMD_INLINE vp load_p(const double* p) noexcept { return *p; }
TEXTPLANE_SIMD_INLINE vp from_p(const double* const* p, std::ptrdiff_t at) noexcept {
  return p[0][at];
}  // each lane from its own array
TEXTPLANE_SIMD_INLINE void store_p(double* p, vp v) noexcept { *p = v; }
TEXTPLANE_SIMD_INLINE vp madd_p(vp a, vp b, vp c) noexcept { return a * b + c; }  // fused where madd() is
TEXTPLANE_SIMD_INLINE vp min_p(vp a, vp b) noexcept { return a < b ? a : b; }     // b where either is NaN
TEXTPLANE_SIMD_INLINE vp max_p(vp a, vp b) noexcept { return a > b ? a : b; }
TEXTPLANE_SIMD_INLINE vp abs_p(vp a) noexcept { return TEXTPLANE_SIMD_ABS_D(a); }
TEXTPLANE_SIMD_INLINE vp trunc_p(vp a) noexcept { return TEXTPLANE_SIMD_TRUNC_D(a); }
// a where m > 0, else b.
TEXTPLANE_SIMD_INLINE vp positive_p(vp m, vp a, vp b) noexcept { return m > 0 ? a : b; }
// Rounded to float.
TEXTPLANE_SIMD_INLINE void store_as_float(float* p, vp v) noexcept { *p = static_cast<float>(v); }

// The sums of eight vectors that lie one after the other, each as of reduce_sum4.
TEXTPLANE_SIMD_INLINE vd reduce_sum8(const float* p) noexcept {
  vd r;
  for (int i = 0; i < 8; ++i) r.part[i] = static_cast<double>(p[i]);
  return r;
}

// --- tiles ---
// Parts of tile_taps() (kernels/tiles.inl). kTileLanes consecutive pixels share a tile; 0 on a target without byte
// shuffles, where kernels do not call the others.
enum : int { kTileLanes = 0 };
// b[i - i % kTileLanes] in lane i.
TEXTPLANE_SIMD_INLINE vi per_tile(const int* b) noexcept { return b[0]; }
// Every lane is 0 or 1.
TEXTPLANE_SIMD_INLINE bool in_two_rows(vi) noexcept { return false; }
// The 16 bytes at corner[i / kTileLanes] + offset.
TEXTPLANE_SIMD_INLINE vi tile_rows(const std::uint8_t* const*, std::ptrdiff_t) noexcept { return 0; }
// Four byte numbers a lane, x, x + 1, x, x + 1, for pick_bytes(); 0 <= x <= 14.
TEXTPLANE_SIMD_INLINE vi tile_picks(vi x) noexcept { return x; }
TEXTPLANE_SIMD_INLINE vi pick_bytes(vi rows, vi) noexcept { return rows; }
// Taps from the picked bytes of three rows: upper pixels from a and lower ones from b where y is 0; from b and c where
// y is 1.
TEXTPLANE_SIMD_INLINE taps_t two_rows(vi, vi, vi, vi) noexcept { return taps_t{0}; }
// Even and odd ones of 2 kLanes floats.
TEXTPLANE_SIMD_INLINE void load2(const float* p, vf* a, vf* b) noexcept {
  *a = p[0];
  *b = p[1];
}
// The low bytes of the lanes, 0 <= v <= 255.
TEXTPLANE_SIMD_INLINE void store_u8(std::uint8_t* p, vi v) noexcept { *p = static_cast<std::uint8_t>(v); }

#include "textplane/simd/ops/few_bytes.inl"
#include "textplane/simd/ops/no_tiles.inl"
