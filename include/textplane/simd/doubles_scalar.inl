// One double in plain C++: the definition of every operation.

enum : int { kDoubles = 1 };
using vp = double;

TEXTPLANE_SIMD_INLINE vp set_p(double value) noexcept { return value; }
TEXTPLANE_SIMD_INLINE vp load_p(const double* p) noexcept { return *p; }
TEXTPLANE_SIMD_INLINE vp from_p(const double* const* p, std::ptrdiff_t at) noexcept {
  return p[0][at];
}  // each lane from its own array
TEXTPLANE_SIMD_INLINE void store_p(double* p, vp v) noexcept { *p = v; }
TEXTPLANE_SIMD_INLINE vp add_p(vp a, vp b) noexcept { return a + b; }
TEXTPLANE_SIMD_INLINE vp sub_p(vp a, vp b) noexcept { return a - b; }
TEXTPLANE_SIMD_INLINE vp mul_p(vp a, vp b) noexcept { return a * b; }
TEXTPLANE_SIMD_INLINE vp div_p(vp a, vp b) noexcept { return a / b; }
TEXTPLANE_SIMD_INLINE vp madd_p(vp a, vp b, vp c) noexcept { return a * b + c; }  // fused where madd() is
TEXTPLANE_SIMD_INLINE vp min_p(vp a, vp b) noexcept { return a < b ? a : b; }     // b where either is NaN
TEXTPLANE_SIMD_INLINE vp max_p(vp a, vp b) noexcept { return a > b ? a : b; }
TEXTPLANE_SIMD_INLINE vp abs_p(vp a) noexcept { return __builtin_fabs(a); }
TEXTPLANE_SIMD_INLINE vp trunc_p(vp a) noexcept { return __builtin_trunc(a); }
// a where m > 0, else b.
TEXTPLANE_SIMD_INLINE vp positive_p(vp m, vp a, vp b) noexcept { return m > 0 ? a : b; }
// Rounded to float.
TEXTPLANE_SIMD_INLINE void store_as_float(float* p, vp v) noexcept { *p = static_cast<float>(v); }
