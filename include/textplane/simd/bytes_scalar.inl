// Bytes and int16 one at a time, in plain C++: the definition of every operation.
//
// Lanes are counted from 0. `_n` loads leave the lanes from n on at zero and touch no memory beyond n; `_n` stores
// write n elements and no more; 0 <= n <= kBytes. Memory need not be aligned.

constexpr int kBytes = 1;
using vb = int;  // kBytes uint8; here one in [0, 255]

// --- make, load, store ---
TEXTPLANE_SIMD_INLINE vb setb(int value) noexcept { return value & 255; }  // value in [0, 255] in all lanes
TEXTPLANE_SIMD_INLINE vb loadb(const std::uint8_t* p) noexcept { return *p; }
TEXTPLANE_SIMD_INLINE void storeb(std::uint8_t* p, vb a) noexcept { *p = static_cast<std::uint8_t>(a); }
TEXTPLANE_SIMD_INLINE vb loadb_n(const std::uint8_t* p, int n) noexcept { return n > 0 ? *p : 0; }
TEXTPLANE_SIMD_INLINE void storeb_n(std::uint8_t* p, vb a, int n) noexcept {
  if (n > 0) *p = static_cast<std::uint8_t>(a);
}

// --- arithmetic, unsigned: addsb and subsb end at 255 and 0 ---
TEXTPLANE_SIMD_INLINE vb addsb(vb a, vb b) noexcept { return a + b < 255 ? a + b : 255; }
TEXTPLANE_SIMD_INLINE vb subsb(vb a, vb b) noexcept { return a > b ? a - b : 0; }
TEXTPLANE_SIMD_INLINE vb minb(vb a, vb b) noexcept { return a < b ? a : b; }
TEXTPLANE_SIMD_INLINE vb maxb(vb a, vb b) noexcept { return a > b ? a : b; }
TEXTPLANE_SIMD_INLINE vb andb(vb a, vb b) noexcept { return a & b; }
TEXTPLANE_SIMD_INLINE vb orb(vb a, vb b) noexcept { return a | b; }
TEXTPLANE_SIMD_INLINE vb xorb(vb a, vb b) noexcept { return a ^ b; }
// Means (a + b + c + d + 2) / 4, rounded down, of 2 x 2 blocks: `upper0` and `upper1` hold 2 kBytes neighbours of one
// row, `lower0` and `lower1` those below.
TEXTPLANE_SIMD_INLINE vb mean4b(vb upper0, vb upper1, vb lower0, vb lower1) noexcept {
  return (upper0 + upper1 + lower0 + lower1 + 2) >> 2;
}

// --- masks: 255 where true, 0 where not ---
TEXTPLANE_SIMD_INLINE vb geb(vb a, vb b) noexcept { return a >= b ? 255 : 0; }
TEXTPLANE_SIMD_INLINE bool anyb(vb a) noexcept { return a != 0; }  // any byte that is not 0; a need not be a mask
TEXTPLANE_SIMD_INLINE std::uint64_t bitsb(vb mask) noexcept { return mask != 0 ? 1u : 0u; }  // bit i is lane i
TEXTPLANE_SIMD_INLINE int lowest_lane(std::uint64_t) noexcept { return 0; }  // index of the lowest bit, which there is

// --- int16 ---
constexpr int kShorts = 1;
constexpr int kPairsReach = 2;  // bytes from p on that mix_pairs() may read; it needs kShorts + 1
using vh = int;                 // kShorts int16; here one in [-2^15, 2^15)

TEXTPLANE_SIMD_INLINE vh wraph(int value) noexcept { return static_cast<std::int16_t>(value); }
TEXTPLANE_SIMD_INLINE vh seth(int value) noexcept { return wraph(value); }
TEXTPLANE_SIMD_INLINE vh loadh(const std::int16_t* p) noexcept { return *p; }
TEXTPLANE_SIMD_INLINE void storeh(std::int16_t* p, vh a) noexcept { *p = static_cast<std::int16_t>(a); }
// Wraps.
TEXTPLANE_SIMD_INLINE vh addh(vh a, vh b) noexcept { return wraph(a + b); }
TEXTPLANE_SIMD_INLINE vh subh(vh a, vh b) noexcept { return wraph(a - b); }
TEXTPLANE_SIMD_INLINE vh andh(vh a, vh b) noexcept { return a & b; }
// a / 2, rounded down.
TEXTPLANE_SIMD_INLINE vh halfh(vh a) noexcept { return a >> 1; }
// a b / 2^15, rounded to the nearest and half up; not both -2^15.
TEXTPLANE_SIMD_INLINE vh mulhrsh(vh a, vh b) noexcept { return (a * b + (1 << 14)) >> 15; }
// -1 in the lanes below n, 0 in the others; any n.
TEXTPLANE_SIMD_INLINE vh firsth(int n) noexcept { return n > 0 ? -1 : 0; }
// Weights w0, w1 in [0, 127], w0 + w1 <= 127, for mix_pairs(); andh() with firsth() leaves the other lanes without.
TEXTPLANE_SIMD_INLINE vh pair_weights(int w0, int w1) noexcept { return w0 | (w1 << 8); }
// w0 (p[i] - 128) + w1 (p[i + 1] - 128) in lane i.
TEXTPLANE_SIMD_INLINE vh mix_pairs(const std::uint8_t* p, vh weights) noexcept {
  return (weights & 255) * (p[0] - 128) + (weights >> 8) * (p[1] - 128);
}
// 32 x - 4096, rounded half up, of kShorts floats in [0, 255]: grey levels as samples of a KLT patch (simd/klt.hpp).
TEXTPLANE_SIMD_INLINE vh grey_to_fixed(const float* p) noexcept { return static_cast<int>(*p * 32.0f + 0.5f) - 4096; }

// --- int32 sums of products of int16 ---
using vw = std::int64_t;  // int32 in the vectors, each for two neighbouring products

TEXTPLANE_SIMD_INLINE vw zerow() noexcept { return 0; }
// sum + a b, neighbouring products added to one lane. The caller keeps the lanes below 2^31.
TEXTPLANE_SIMD_INLINE vw dotw(vw sum, vh a, vh b) noexcept { return sum + a * b; }
// Sum of all lanes: exact, as every partial sum is an integer below 2^53.
TEXTPLANE_SIMD_INLINE double sumw(vw a) noexcept { return static_cast<double>(a); }
