// Vectors of one lane, in plain C++: the definition of every operation.
//
// Lanes are counted from 0. `_n` loads leave the lanes from n on at zero and touch no memory beyond n; `_n` stores write n
// elements and no more; 0 <= n <= kLanes. Memory need not be aligned.

constexpr int kLanes = 1;
constexpr bool kManyRegisters = false;
using vf = float;  // kLanes floats
using vi = int;    // kLanes int32
using vm = bool;   // kLanes truth values

// --- make, load, store ---
TEXTPLANE_SIMD_INLINE vf set1(float value) noexcept { return value; }
TEXTPLANE_SIMD_INLINE vi seti(int value) noexcept { return value; }
TEXTPLANE_SIMD_INLINE vf zero() noexcept { return 0.0f; }
TEXTPLANE_SIMD_INLINE vf iota() noexcept { return 0.0f; }  // 0, 1, 2, ...
TEXTPLANE_SIMD_INLINE vi ioti() noexcept { return 0; }
TEXTPLANE_SIMD_INLINE vf load(const float* p) noexcept { return *p; }
// The same value, in a register from here on: g++ loads from memory several times what is used several times.
TEXTPLANE_SIMD_INLINE vf hold(vf v) noexcept { return v; }
TEXTPLANE_SIMD_INLINE void store(float* p, vf v) noexcept { *p = v; }
TEXTPLANE_SIMD_INLINE vi loadi(const int* p) noexcept { return *p; }
TEXTPLANE_SIMD_INLINE void storei(int* p, vi v) noexcept { *p = v; }
TEXTPLANE_SIMD_INLINE vf load_n(const float* p, int n) noexcept { return n > 0 ? *p : 0.0f; }
TEXTPLANE_SIMD_INLINE void store_n(float* p, vf v, int n) noexcept {
  if (n > 0) *p = v;
}
TEXTPLANE_SIMD_INLINE vi loadi_n(const int* p, int n) noexcept { return n > 0 ? *p : 0; }
TEXTPLANE_SIMD_INLINE void storei_n(int* p, vi v, int n) noexcept {
  if (n > 0) *p = v;
}
TEXTPLANE_SIMD_INLINE vf gather(const float* p, const int* at) noexcept { return p[*at]; }  // p[at[i]]
// kLanes bytes, as int32 and as float.
TEXTPLANE_SIMD_INLINE vi load_u8i(const std::uint8_t* p) noexcept { return *p; }
TEXTPLANE_SIMD_INLINE vf load_u8(const std::uint8_t* p) noexcept { return static_cast<float>(*p); }
TEXTPLANE_SIMD_INLINE vi load_u8i_n(const std::uint8_t* p, int n) noexcept { return n > 0 ? *p : 0; }
TEXTPLANE_SIMD_INLINE vf load_u8_n(const std::uint8_t* p, int n) noexcept {
  return n > 0 ? static_cast<float>(*p) : 0.0f;
}

// --- float arithmetic: IEEE, each operation rounded once ---
TEXTPLANE_SIMD_INLINE vf add(vf a, vf b) noexcept { return a + b; }
TEXTPLANE_SIMD_INLINE vf sub(vf a, vf b) noexcept { return a - b; }
TEXTPLANE_SIMD_INLINE vf mul(vf a, vf b) noexcept { return a * b; }
// By zero it gives what IEEE says, as in the vectors, where a lane that nobody looks at may do so.
#if defined(__clang__)
__attribute__((no_sanitize("float-divide-by-zero")))
#endif
TEXTPLANE_SIMD_INLINE vf
div(vf a, vf b) noexcept {
  return a / b;
}
// a b + c and c - a b: one rounding on the fused targets (avx2, avx512, neon), two on scalar and sse41.
TEXTPLANE_SIMD_INLINE vf madd(vf a, vf b, vf c) noexcept { return a * b + c; }
TEXTPLANE_SIMD_INLINE vf nmadd(vf a, vf b, vf c) noexcept { return c - a * b; }
// The second operand where either is NaN, and where both are zeros of whatever sign.
#if TEXTPLANE_SIMD_HIDE_MINIMA
TEXTPLANE_SIMD_INLINE bool is_nan_(vf a) noexcept {
  unsigned word = 0;
  __builtin_memcpy(&word, &a, sizeof word);
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
TEXTPLANE_SIMD_INLINE vf neg(vf a) noexcept { return -a; }
TEXTPLANE_SIMD_INLINE vf floor_(vf a) noexcept { return TEXTPLANE_SIMD_FLOOR(a); }

// --- conversions: to_int truncates; its result for NaN and beyond int32 is unspecified (no undefined behaviour) ---
TEXTPLANE_SIMD_INLINE vi to_int(vf a) noexcept {
  return a >= -2147483648.0f && a < 2147483648.0f ? static_cast<int>(a) : -2147483647 - 1;
}
TEXTPLANE_SIMD_INLINE vf to_float(vi a) noexcept { return static_cast<float>(a); }

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
TEXTPLANE_SIMD_INLINE vm lti(vi a, vi b) noexcept { return a < b; }
TEXTPLANE_SIMD_INLINE vm gti(vi a, vi b) noexcept { return a > b; }
TEXTPLANE_SIMD_INLINE vm eqi(vi a, vi b) noexcept { return a == b; }
TEXTPLANE_SIMD_INLINE vm and_(vm a, vm b) noexcept { return a && b; }
TEXTPLANE_SIMD_INLINE vm or_(vm a, vm b) noexcept { return a || b; }
TEXTPLANE_SIMD_INLINE vm andnot_(vm a, vm b) noexcept { return !a && b; }  // not a, and b
TEXTPLANE_SIMD_INLINE vm not_(vm a) noexcept { return !a; }
TEXTPLANE_SIMD_INLINE vf select(vm m, vf a, vf b) noexcept { return m ? a : b; }
TEXTPLANE_SIMD_INLINE vi selecti(vm m, vi a, vi b) noexcept { return m ? a : b; }
TEXTPLANE_SIMD_INLINE vf keep(vm m, vf a) noexcept { return m ? a : 0.0f; }
TEXTPLANE_SIMD_INLINE vm first_n(int n) noexcept { return n > 0; }          // lanes below n; any n
TEXTPLANE_SIMD_INLINE unsigned bits(vm m) noexcept { return m ? 1u : 0u; }  // bit i is lane i
TEXTPLANE_SIMD_INLINE int count(vm m) noexcept { return m ? 1 : 0; }
TEXTPLANE_SIMD_INLINE bool any(vm m) noexcept { return m; }
TEXTPLANE_SIMD_INLINE bool all(vm m) noexcept { return m; }

// --- reductions: the upper half of the lanes joins the lower half until one is left; hsum_d does so in double ---
TEXTPLANE_SIMD_INLINE float hsum(vf a) noexcept { return a; }
TEXTPLANE_SIMD_INLINE double hsum_d(vf a) noexcept { return static_cast<double>(a); }
TEXTPLANE_SIMD_INLINE float hmin(vf a) noexcept { return a; }
TEXTPLANE_SIMD_INLINE float hmax(vf a) noexcept { return a; }

// --- bilinear taps: kLanes words I(x,y) | I(x+1,y) << 8 | I(x,y+1) << 16 | I(x+1,y+1) << 24 ---
// value = I(x,y), dx = I(x+1,y) - I(x,y), dy = I(x,y+1) - I(x,y), dxy = I(x,y) - I(x+1,y) - I(x,y+1) + I(x+1,y+1): exact.
struct taps_t {
  std::uint32_t words;
};
TEXTPLANE_SIMD_INLINE taps_t load_taps(const std::uint32_t* p) noexcept { return taps_t{*p}; }
TEXTPLANE_SIMD_INLINE int tap_byte(taps_t t, int i) noexcept { return static_cast<int>((t.words >> (8 * i)) & 255u); }
TEXTPLANE_SIMD_INLINE vf tap_value(taps_t t) noexcept { return static_cast<float>(tap_byte(t, 0)); }
TEXTPLANE_SIMD_INLINE vf tap_dx(taps_t t) noexcept { return static_cast<float>(tap_byte(t, 1) - tap_byte(t, 0)); }
TEXTPLANE_SIMD_INLINE vf tap_dy(taps_t t) noexcept { return static_cast<float>(tap_byte(t, 2) - tap_byte(t, 0)); }
TEXTPLANE_SIMD_INLINE vf tap_dxy(taps_t t) noexcept {
  return static_cast<float>(tap_byte(t, 0) - tap_byte(t, 1) - tap_byte(t, 2) + tap_byte(t, 3));
}

// --- one double, one word ---
TEXTPLANE_SIMD_INLINE double sqrt_d(double a) noexcept { return __builtin_sqrt(a); }
TEXTPLANE_SIMD_INLINE int lowest_bit(
    std::uint64_t word) noexcept {  // the number of the lowest bit that is set; word != 0
  int bit = 0;
  for (; (word & 1u) == 0; word >>= 1) ++bit;
  return bit;
}

// --- 8 doubles, on every target ---
struct vd {
  double lane[8];
};
TEXTPLANE_SIMD_INLINE vd loadd(const double* p) noexcept {
  vd r;
  for (int i = 0; i < 8; ++i) r.lane[i] = p[i];
  return r;
}
TEXTPLANE_SIMD_INLINE void stored(double* p, vd a) noexcept {
  for (int i = 0; i < 8; ++i) p[i] = a.lane[i];
}
TEXTPLANE_SIMD_INLINE vd setd(double value) noexcept {
  vd r;
  for (int i = 0; i < 8; ++i) r.lane[i] = value;
  return r;
}
TEXTPLANE_SIMD_INLINE vd muld(vd a, vd b) noexcept {
  for (int i = 0; i < 8; ++i) a.lane[i] *= b.lane[i];
  return a;
}
TEXTPLANE_SIMD_INLINE vd maddd(vd a, vd b, vd c) noexcept {  // as madd
  for (int i = 0; i < 8; ++i) c.lane[i] += a.lane[i] * b.lane[i];
  return c;
}

// hsum of four vectors to out[0 .. 3]: neighbouring lanes join first.
TEXTPLANE_SIMD_INLINE void hsum4(vf a, vf b, vf c, vf d, float* out) noexcept {
  out[0] = a;
  out[1] = b;
  out[2] = c;
  out[3] = d;
}
// The sums of eight vectors that lie one after the other, each as of hsum4.
TEXTPLANE_SIMD_INLINE vd hsum8(const float* p) noexcept {
  vd r;
  for (int i = 0; i < 8; ++i) r.lane[i] = static_cast<double>(p[i]);
  return r;
}
