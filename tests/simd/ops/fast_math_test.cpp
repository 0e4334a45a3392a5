#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/targets.hpp"

namespace textplane_test {
void clamp_to_int_fast_math(const float* p, float low, float high, int* out);  // fast_math_unit.cpp
}  // namespace textplane_test

namespace fast_math_test {

using namespace textplane_test;

TEST(FastMath, AClampHoldsForNotANumberToo) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const float values[] = {nan, -nan, infinity, -infinity, 3.5f, -1e30f, 1e30f, 10.0f, 0.0f};
  for (const simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    SCOPED_TRACE(simd::to_string(target));
    for (const float value : values) {
      float p[16];
      int out[16];
      std::fill(p, p + 16, value);
      std::fill(out, out + 16, -1);
      clamp_to_int_fast_math(p, 0.0f, 10.0f, out);
      for (int i = 0; i < simd::lanes(target); ++i) {
        EXPECT_GE(out[i], 0) << value;
        EXPECT_LE(out[i], 10) << value;
      }
    }
  }
}

}  // namespace fast_math_test
