// Loads, stores and copies of the vectors touch no byte beyond their end, on every target.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "simd/ops/vec_support.hpp"
#include "support/guarded.hpp"

namespace memory_test {

using namespace textplane_test;
using simd::Target;

TEST(VecMemory, PartialLoadsTouchNoMoreThanTheyLoad) {
  const Guarded<float> floats(kMost);
  for (int i = 0; i < kMost; ++i) floats.data()[i] = static_cast<float>(i) + 0.5f;
  on_each_target([&](Target, int lanes) {
    for (int n = 0; n <= lanes; ++n) {
      SCOPED_TRACE(n);
      float f[kMost];
      partial_load(floats.end() - n, n, f);
      for (int i = 0; i < lanes; ++i) EXPECT_EQ(f[i], i < n ? static_cast<float>(kMost - n + i) + 0.5f : 0.0f) << i;
    }
  });
}

TEST(VecMemory, PartialStoresWriteNoMoreThanTheyStore) {
  const Guarded<float> floats(3 * kMost);
  float f[kMost];
  for (int i = 0; i < kMost; ++i) f[i] = static_cast<float>(i) + 1.0f;
  on_each_target([&](Target, int lanes) {
    for (int n = 0; n <= lanes; ++n) {
      SCOPED_TRACE(n);
      for (const int behind : {0, kMost}) {  // at the forbidden page, and with room for a canary
        std::fill(floats.data(), floats.end(), -7.0f);
        const int first = 3 * kMost - behind - n;
        partial_store(floats.data() + first, f, n);
        for (int i = 0; i < 3 * kMost; ++i)
          EXPECT_EQ(floats.data()[i], i >= first && i < first + n ? static_cast<float>(i - first + 1) : -7.0f) << i;
      }
    }
  });
}

TEST(VecMemory, BytesAsNumbersAndCopies) {
  const Guarded<std::uint8_t> bytes(2), target(70), source(70);
  bytes.data()[0] = 0x03, bytes.data()[1] = 0xc4;
  for (int i = 0; i < 70; ++i) source.data()[i] = static_cast<std::uint8_t>(i * 3 + 1);
  on_each_target([&](Target, int) {
    EXPECT_EQ(read_u16(bytes.data()), 0xc403u);
    for (int n = 0; n <= 70; ++n) {
      std::fill(target.data(), target.end(), std::uint8_t{0});
      copy_bytes(target.end() - n, source.end() - n, n);
      for (int i = 0; i < 70; ++i) EXPECT_EQ(target.data()[i], i < 70 - n ? 0 : source.data()[i]);
    }
  });
}

}  // namespace memory_test
