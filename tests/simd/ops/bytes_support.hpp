// The operations of the byte vectors behind entry points, for bytes_kernels_test.cpp.
#ifndef TEXTPLANE_TESTS_SIMD_OPS_BYTES_SUPPORT_HPP
#define TEXTPLANE_TESTS_SIMD_OPS_BYTES_SUPPORT_HPP

#include "textplane/simd/ops.hpp"

namespace textplane_test {

struct ByteResults {
  std::uint8_t sum[64], difference[64], least[64], most[64], both[64], either[64], not_less[64], constant[64], mean[64];
  std::uint64_t bits;
  bool any;
  int lowest;
};

/// 128 bytes each.
struct ByteArrays {
  const std::uint8_t* a;
  const std::uint8_t* b;
  ByteResults* result;
};

struct ShortResults {
  std::int16_t sum[32], difference[32], both[32], half[32], product[32], first[32], constant[32], mixed[32], grey[32];
  double dot, dot_twice;
};

/// 32 int16 and floats; 48 pixels; n in [0, 64].
struct ShortArrays {
  const std::int16_t* a;
  const std::int16_t* b;
  const std::uint8_t* pixels;
  const float* grey;
  int n;
  ShortResults* result;
};

}  // namespace textplane_test

#define TEXTPLANE_SIMD_KERNEL "simd/ops/bytes_kernel.inl"
#include "textplane/simd/foreach_target.inl"

namespace textplane_test {

inline void run_bytes(const ByteArrays& t) { TEXTPLANE_SIMD_DISPATCH(run_bytes(t)); }
inline void copy_parts(const std::uint8_t* from, int n, std::uint8_t* to) {
  TEXTPLANE_SIMD_DISPATCH(copy_parts(from, n, to));
}
inline void run_shorts(const ShortArrays& t) { TEXTPLANE_SIMD_DISPATCH(run_shorts(t)); }

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SIMD_OPS_BYTES_SUPPORT_HPP
