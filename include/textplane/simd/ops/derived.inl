// Operations that read the same on every target. The last file of a region's operations.

TEXTPLANE_SIMD_INLINE vf zero() noexcept { return set1(0.0f); }

// --- float arithmetic: IEEE, each operation rounded once ---
TEXTPLANE_SIMD_INLINE vf add(vf a, vf b) noexcept { return a + b; }
TEXTPLANE_SIMD_INLINE vf sub(vf a, vf b) noexcept { return a - b; }
TEXTPLANE_SIMD_INLINE vf mul(vf a, vf b) noexcept { return a * b; }
// A division by zero is allowed, as IEEE defines it: unused lanes of the vectors do it.
#if defined(__clang__)
__attribute__((no_sanitize("float-divide-by-zero")))
#endif
TEXTPLANE_SIMD_INLINE vf
div(vf a, vf b) noexcept {
  return a / b;
}
TEXTPLANE_SIMD_INLINE vf neg(vf a) noexcept { return -a; }

// --- doubles ---
TEXTPLANE_SIMD_INLINE vp add_p(vp a, vp b) noexcept { return a + b; }
TEXTPLANE_SIMD_INLINE vp sub_p(vp a, vp b) noexcept { return a - b; }
TEXTPLANE_SIMD_INLINE vp mul_p(vp a, vp b) noexcept { return a * b; }
TEXTPLANE_SIMD_INLINE vp div_p(vp a, vp b) noexcept { return a / b; }

// --- 8 doubles ---
constexpr int kParts = 8 / kDoubles;
TEXTPLANE_SIMD_INLINE vd loadd(const double* p) noexcept {
  vd r;
  TEXTPLANE_SIMD_UNROLL
  for (int i = 0; i < kParts; ++i) r.part[i] = load_p(p + i * kDoubles);
  return r;
}
TEXTPLANE_SIMD_INLINE void stored(double* p, vd a) noexcept {
  TEXTPLANE_SIMD_UNROLL
  for (int i = 0; i < kParts; ++i) store_p(p + i * kDoubles, a.part[i]);
}
TEXTPLANE_SIMD_INLINE vd setd(double value) noexcept {
  vd r;
  TEXTPLANE_SIMD_UNROLL
  for (int i = 0; i < kParts; ++i) r.part[i] = set_p(value);
  return r;
}
TEXTPLANE_SIMD_INLINE vd muld(vd a, vd b) noexcept {
  TEXTPLANE_SIMD_UNROLL
  for (int i = 0; i < kParts; ++i) a.part[i] = a.part[i] * b.part[i];
  return a;
}
TEXTPLANE_SIMD_INLINE vd maddd(vd a, vd b, vd c) noexcept {
  TEXTPLANE_SIMD_UNROLL
  for (int i = 0; i < kParts; ++i) c.part[i] = madd_p(a.part[i], b.part[i], c.part[i]);
  return c;
}

// --- fixed point ---
// Weights w0, w1 in [0, 127], w0 + w1 <= 127, for mix_pairs(); and16() with first16() leaves the other lanes without.
TEXTPLANE_SIMD_INLINE v16 pair_weights(int w0, int w1) noexcept { return set16(w0 | (w1 << 8)); }
// 32 x - 4096, rounded half up, of k16Lanes floats in [0, 255]: grey levels as samples of a KLT patch (simd/klt.hpp).
TEXTPLANE_SIMD_INLINE v16 grey_to_fixed(const float* p) noexcept {
  const vf scale = set1(32.0f), half = set1(0.5f);
  return sub16(pack16(to_int(load(p) * scale + half), to_int(load(p + kLanes) * scale + half)), set16(4096));
}
