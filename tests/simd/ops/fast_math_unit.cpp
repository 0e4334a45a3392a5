// Compiled with -Ofast: a NaN must not get past a clamp, which is what keeps the kernels inside their images.
#include "textplane/simd/ops.hpp"

#define TEXTPLANE_SIMD_KERNEL "simd/ops/fast_math_kernel.inl"
#include "textplane/simd/foreach_target.inl"

namespace textplane_test {
void clamp_to_int_fast_math(const float* p, float low, float high, int* out) {
  TEXTPLANE_SIMD_DISPATCH(clamp_to_int(p, low, high, out))
}
}  // namespace textplane_test
