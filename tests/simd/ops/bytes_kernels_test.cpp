// Each operation of the byte vectors, on every target, against its meaning in plain C++: all of them are exact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "simd/ops/bytes_support.hpp"
#include "support/guarded.hpp"
#include "support/targets.hpp"

namespace bytes_kernels_test {

using namespace textplane_test;

int at(const std::uint8_t* p, std::size_t i) { return p[i]; }

TEST(ByteVectors, EveryOperationIsWhatItSays) {
  std::mt19937 random(1);
  std::vector<std::uint8_t> a(128), b(128);
  for (int round = 0; round < 300; ++round) {
    const unsigned spread = round % 3 == 0 ? 3 : 256;  // few values: equal bytes are common
    for (std::size_t i = 0; i < 128; ++i) {
      a[i] = static_cast<std::uint8_t>(random() % spread + (round % 2 ? 0 : 256 - spread));
      b[i] = static_cast<std::uint8_t>(random() % spread + (round % 2 ? 0 : 256 - spread));
      if (round % 5 == 4) b[i] = static_cast<std::uint8_t>(i == 40 ? a[i] : std::max<int>(a[i], 1));
      if (round % 5 == 4 && i != 40) a[i] = static_cast<std::uint8_t>(b[i] - 1);  // one bit, of lane 40
    }
    for (const simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      SCOPED_TRACE(simd::to_string(target));
      ByteResults r;
      run_bytes({a.data(), b.data(), &r});
      std::uint64_t bits = 0;
      bool any = false;
      int lowest = -1;
      for (std::size_t i = 0; i < 64; ++i) {
        const int x = a[i], y = b[i];
        ASSERT_EQ(at(r.sum, i), std::min(x + y, 255));
        ASSERT_EQ(at(r.difference, i), std::max(x - y, 0));
        ASSERT_EQ(at(r.least, i), std::min(x, y));
        ASSERT_EQ(at(r.most, i), std::max(x, y));
        ASSERT_EQ(at(r.both, i), x & y);
        ASSERT_EQ(at(r.either, i), x | y);
        ASSERT_EQ(at(r.not_less, i), x >= y ? 255 : 0);
        ASSERT_EQ(at(r.constant, i), a[0]);
        ASSERT_EQ(at(r.mean, i), (a[2 * i] + a[2 * i + 1] + b[2 * i] + b[2 * i + 1] + 2) / 4);
        if (x >= y) bits |= std::uint64_t{1} << i;
        if (x >= y && lowest < 0) lowest = static_cast<int>(i);
        any = any || x > y;
      }
      ASSERT_EQ(r.bits, bits);
      ASSERT_EQ(r.any, any);
      ASSERT_EQ(r.lowest, lowest);
    }
  }
}

TEST(ByteVectors, PartsTouchNothingBeyondTheirEnd) {
  for (int n = 0; n <= 70; ++n) {
    const auto size = static_cast<std::size_t>(n);
    const Guarded<std::uint8_t> from(std::max<std::size_t>(size, 1)), to(std::max<std::size_t>(size, 1));
    for (const simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      SCOPED_TRACE(simd::to_string(target));
      for (std::size_t i = 0; i < size; ++i) (from.end() - n)[i] = static_cast<std::uint8_t>(i * 37 + 11);
      std::fill(to.end() - n, to.end(), std::uint8_t{0});
      copy_parts(from.end() - n, n, to.end() - n);
      ASSERT_TRUE(std::equal(from.end() - n, from.end(), to.end() - n)) << n;
    }
  }
}

std::int16_t wrapped(int value) {
  const int low = ((value % 65536) + 65536) % 65536;
  return static_cast<std::int16_t>(low < 32768 ? low : low - 65536);
}

TEST(ShortVectors, EveryOperationIsWhatItSays) {
  std::mt19937 random(2);
  std::vector<std::int16_t> a(32), b(32);
  std::vector<std::uint8_t> pixels(48);
  std::vector<float> grey(32);
  for (int round = 0; round < 600; ++round) {
    const int n = round % 65;
    for (std::size_t i = 0; i < 32; ++i) {
      const int low = round % 3 == 0 ? -4096 : -32767, range = round % 3 == 0 ? 8192 : 65535;
      a[i] = static_cast<std::int16_t>(low + static_cast<int>(random() % static_cast<unsigned>(range)));
      b[i] = static_cast<std::int16_t>(low + static_cast<int>(random() % static_cast<unsigned>(range)));
      grey[i] = static_cast<float>(random() % 65281) / 256.0F;  // ties among them
    }
    for (std::uint8_t& p : pixels) p = static_cast<std::uint8_t>(random() % 2 ? random() % 256 : random() % 2 * 255);
    for (const simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      SCOPED_TRACE(simd::to_string(target));
      ShortResults r;
      run_shorts({a.data(), b.data(), pixels.data(), grey.data(), n, &r});
      double dot = 0, squares = 0;
      for (std::size_t i = 0; i < 32; ++i) {
        const int x = a[i], y = b[i];
        ASSERT_EQ(r.sum[i], wrapped(x + y));
        ASSERT_EQ(r.difference[i], wrapped(x - y));
        ASSERT_EQ(r.both[i], static_cast<std::int16_t>(x & y));
        ASSERT_EQ(r.half[i], static_cast<int>(std::floor(x / 2.0)));
        ASSERT_EQ(r.product[i], static_cast<int>(std::floor(x * static_cast<double>(y) / 32768 + 0.5)));
        ASSERT_EQ(r.first[i], static_cast<int>(i) < n ? -1 : 0);
        ASSERT_EQ(r.constant[i], n);
        const int mixed = (64 - n) * (pixels[i] - 128) + n * (pixels[i + 1] - 128);
        ASSERT_EQ(r.mixed[i], i < 31 ? mixed : 0);
        ASSERT_EQ(r.grey[i], static_cast<int>(std::floor(grey[i] * 32 + 0.5F)) - 4096);
        dot += static_cast<double>(x) * y;
        squares += static_cast<double>(y) * y;
      }
      ASSERT_EQ(r.dot, dot);
      if (round % 3 == 0) {  // the lanes of larger ones would not hold it
        ASSERT_EQ(r.dot_twice, dot + squares);
      }
    }
  }
}

}  // namespace bytes_kernels_test
