// Bytes one at a time and int16 in eights, in plain C++: the definition of every operation.
//
// Lanes are counted from 0. `_n` loads leave the lanes from n on at zero and touch no memory beyond n; `_n` stores write n
// elements and no more; 0 <= n <= kBytes. Memory need not be aligned.

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
// Means (a + b + c + d + 2) / 4, rounded down, of 2 x 2 blocks: `upper0` and `upper1` hold 2 kBytes neighbours of one row, `lower0`
// and `lower1` those below.
TEXTPLANE_SIMD_INLINE vb mean4b(vb upper0, vb upper1, vb lower0, vb lower1) noexcept {
  return (upper0 + upper1 + lower0 + lower1 + 2) >> 2;
}

// --- masks: 255 where true, 0 where not ---
TEXTPLANE_SIMD_INLINE vb geb(vb a, vb b) noexcept { return a >= b ? 255 : 0; }
TEXTPLANE_SIMD_INLINE bool anyb(vb a) noexcept { return a != 0; }  // any byte that is not 0; a need not be a mask
TEXTPLANE_SIMD_INLINE std::uint64_t bitsb(vb mask) noexcept { return mask != 0 ? 1u : 0u; }  // bit i is lane i
TEXTPLANE_SIMD_INLINE int lowest_lane(std::uint64_t) noexcept { return 0; }  // index of the lowest bit of bitsb(); not for 0

// --- int16 ---
constexpr int kShorts = 8;
constexpr int kPairsReach = 9;  // bytes from p on that mix_pairs() may read; it needs kShorts + 1
struct vh {
  std::int16_t lane[kShorts];
};

TEXTPLANE_SIMD_INLINE vh seth(int value) noexcept {
  vh r;
  for (int i = 0; i < kShorts; ++i) r.lane[i] = static_cast<std::int16_t>(value);
  return r;
}
TEXTPLANE_SIMD_INLINE vh loadh(const std::int16_t* p) noexcept {
  vh r;
  for (int i = 0; i < kShorts; ++i) r.lane[i] = p[i];
  return r;
}
TEXTPLANE_SIMD_INLINE void storeh(std::int16_t* p, vh a) noexcept {
  for (int i = 0; i < kShorts; ++i) p[i] = a.lane[i];
}
// Wraps.
TEXTPLANE_SIMD_INLINE vh addh(vh a, vh b) noexcept {
  for (int i = 0; i < kShorts; ++i) a.lane[i] = static_cast<std::int16_t>(a.lane[i] + b.lane[i]);
  return a;
}
TEXTPLANE_SIMD_INLINE vh subh(vh a, vh b) noexcept {
  for (int i = 0; i < kShorts; ++i) a.lane[i] = static_cast<std::int16_t>(a.lane[i] - b.lane[i]);
  return a;
}
TEXTPLANE_SIMD_INLINE vh andh(vh a, vh b) noexcept {
  for (int i = 0; i < kShorts; ++i) a.lane[i] = static_cast<std::int16_t>(a.lane[i] & b.lane[i]);
  return a;
}
// a / 2, rounded down.
TEXTPLANE_SIMD_INLINE vh halfh(vh a) noexcept {
  for (int i = 0; i < kShorts; ++i) a.lane[i] = static_cast<std::int16_t>(a.lane[i] >> 1);
  return a;
}
// a b / 2^15, rounded to the nearest and half up; not both -2^15.
TEXTPLANE_SIMD_INLINE vh mulhrsh(vh a, vh b) noexcept {
  for (int i = 0; i < kShorts; ++i) a.lane[i] = static_cast<std::int16_t>((a.lane[i] * b.lane[i] + (1 << 14)) >> 15);
  return a;
}
// -1 in the lanes below n, 0 in the others; any n.
TEXTPLANE_SIMD_INLINE vh firsth(int n) noexcept {
  vh r;
  for (int i = 0; i < kShorts; ++i) r.lane[i] = i < n ? -1 : 0;
  return r;
}
// Weights w0, w1 in [0, 127], w0 + w1 <= 127, for mix_pairs(); andh() with firsth() makes those of the other lanes zero.
TEXTPLANE_SIMD_INLINE vh pair_weights(int w0, int w1) noexcept { return seth(w0 | (w1 << 8)); }
// w0 (p[i] - 128) + w1 (p[i + 1] - 128) in lane i.
TEXTPLANE_SIMD_INLINE vh mix_pairs(const std::uint8_t* p, vh weights) noexcept {
  for (int i = 0; i < kShorts; ++i) {
    const int w0 = weights.lane[i] & 255, w1 = (weights.lane[i] >> 8) & 255;
    weights.lane[i] = static_cast<std::int16_t>(w0 * (p[i] - 128) + w1 * (p[i + 1] - 128));
  }
  return weights;
}

// x / 2^-5 - 4096, rounded half up, of kShorts floats in [0, 255]: grey levels as samples of a KLT patch (simd/klt.hpp).
TEXTPLANE_SIMD_INLINE vh grey_to_fixed(const float* p) noexcept {
  vh r;
  for (int i = 0; i < kShorts; ++i) r.lane[i] = static_cast<std::int16_t>(static_cast<int>(p[i] * 32.0f + 0.5f) - 4096);
  return r;
}

// --- int32 sums of products of int16 ---
constexpr int kWords = 4;
struct vw {
  std::int32_t lane[kWords];
};

TEXTPLANE_SIMD_INLINE vw zerow() noexcept { return vw{{0, 0, 0, 0}}; }
// sum + a b, neighbouring products added to one lane. The caller keeps the lanes below 2^31.
TEXTPLANE_SIMD_INLINE vw dotw(vw sum, vh a, vh b) noexcept {
  for (int i = 0; i < kWords; ++i)
    sum.lane[i] += a.lane[2 * i] * b.lane[2 * i] + a.lane[2 * i + 1] * b.lane[2 * i + 1];
  return sum;
}
// Sum of all lanes: exact, as every partial sum is an integer below 2^53.
TEXTPLANE_SIMD_INLINE double sumw(vw a) noexcept {
  double sum = 0;
  for (int i = 0; i < kWords; ++i) sum += static_cast<double>(a.lane[i]);
  return sum;
}
