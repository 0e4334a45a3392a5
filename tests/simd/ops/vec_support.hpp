// The vector operations behind run-time dispatch, for vec_test.cpp.
#ifndef TEXTPLANE_TESTS_SIMD_OPS_VEC_SUPPORT_HPP
#define TEXTPLANE_TESTS_SIMD_OPS_VEC_SUPPORT_HPP

#include <cmath>
#include <cstdint>
#include <cstring>

#include "simd/rounding_support.hpp"
#include "support/targets.hpp"
#include "textplane/simd/ops.hpp"

#define TEXTPLANE_SIMD_KERNEL "simd/ops/vec_kernel.inl"
#include "textplane/simd/foreach_target.inl"

namespace textplane_test {

inline void float_operations(const float* a, const float* b, const float* c, float* out) {
  TEXTPLANE_SIMD_DISPATCH(float_operations(a, b, c, out))
}
inline int double_operations(const double* a, const double* b, const double* c, double* out) {
  TEXTPLANE_SIMD_DISPATCH(double_operations(a, b, c, out))
}
inline void int_operations(const int* a, const int* b, int shift, int* out) {
  TEXTPLANE_SIMD_DISPATCH(int_operations(a, b, shift, out))
}
inline void conversions(const float* a, const int* b, int* ints, float* floats) {
  TEXTPLANE_SIMD_DISPATCH(conversions(a, b, ints, floats))
}
inline void mask_operations(const float* a, const float* b, const int* i, const int* j, unsigned* out) {
  TEXTPLANE_SIMD_DISPATCH(mask_operations(a, b, i, j, out))
}
inline void inverse_roots(const float* p, float* out) { TEXTPLANE_SIMD_DISPATCH(inverse_roots(p, out)) }
inline void reductions(const float* a, double* out) { TEXTPLANE_SIMD_DISPATCH(reductions(a, out)) }
inline void eight_sums(const float* p, double* out) { TEXTPLANE_SIMD_DISPATCH(eight_sums(p, out)) }
inline void taps(const std::uint32_t* words, float* out) { TEXTPLANE_SIMD_DISPATCH(taps(words, out)) }
inline void partial_load(const float* p, int n, float* out) { TEXTPLANE_SIMD_DISPATCH(partial_load(p, n, out)) }
inline void partial_store(float* p, const float* from, int n) { TEXTPLANE_SIMD_DISPATCH(partial_store(p, from, n)) }
inline unsigned first_lanes(int n) { TEXTPLANE_SIMD_DISPATCH(first_lanes(n)) }
inline unsigned read_u16(const std::uint8_t* p) { TEXTPLANE_SIMD_DISPATCH(read_u16(p)) }
inline void copy_bytes(void* to, const void* from, int n) { TEXTPLANE_SIMD_DISPATCH(copy(to, from, n)) }

/// a b + c rounded once. Not std::fma, which rounds twice in MinGW's library. The product is exact in double; a sum
/// whose last bit is set where something was cut off ("round to odd") rounds to float as the exact one would.
inline float fused_sum(float a, float b, float c) {
  const double product = static_cast<double>(a) * b;
  double sum = product + c;
  if (!std::isfinite(sum)) return static_cast<float>(sum);
  const double from_product = sum - c;
  const double cut = (product - from_product) + (c - (sum - from_product));
  std::int64_t bits = 0;
  std::memcpy(&bits, &sum, sizeof bits);
  if (cut != 0 && bits % 2 == 0) sum = std::nextafter(sum, cut > 0 ? HUGE_VAL : -HUGE_VAL);
  return static_cast<float>(sum);
}

constexpr int kMost = 16;  // lanes

/// Whether madd() of the target whose scope is open rounds once.
inline bool is_fused(simd::Target target) {
  if (rounding(target) != as_the_engine_does) return rounding(target) == rounds_once;
  const float a[kMost] = {1 + std::ldexp(1.0f, -12)}, c[kMost] = {-1 - std::ldexp(1.0f, -11)};
  float out[19 * kMost];
  float_operations(a, a, c, out);
  return out[4 * simd::lanes(target)] != 0;
}

template <class Body>
void on_each_target(Body body) {
  for (const simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    SCOPED_TRACE(simd::to_string(target));
    body(target, simd::lanes(target));
  }
}

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SIMD_OPS_VEC_SUPPORT_HPP
