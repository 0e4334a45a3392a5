// Each operation of the vectors, on every target, against its definition in plain C++.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "simd/ops/vec_support.hpp"

namespace vec_test {

using namespace textplane_test;
using simd::Target;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr int kMin = std::numeric_limits<int>::min(), kMax = std::numeric_limits<int>::max();

const std::vector<float> kFloats = {
    0.0f, -0.0f, 1.0f,  -1.0f,  0.5f, 2.5f,  -2.5f, 0.99999994f, 1.0000001f, 1e-40f, -1e-3f,  255.0f, 16777217.0f,
    1e9f, -3e9f, 3e30f, -3e30f, kInf, -kInf, kNaN,  0.1f,        -0.33333f,  12.75f, -12.75f, 1e-20f};
const std::vector<int> kInts = {0,     1,     -1,        2,          7,    -8,   255,      -256,
                                65535, 65536, 123456789, -123456789, kMax, kMin, kMax - 1, kMin + 1};

/// The same bits, or both NaN: which NaN is nobody's business.
bool same(float a, float b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// a b rounded to float, which no compiler may fuse with what follows.
float rounded_product(float a, float b) {
  const volatile float product = a * b;
  return product;
}

int wrap(std::int64_t value) {
  const auto low = static_cast<std::uint32_t>(static_cast<std::uint64_t>(value));
  int result = 0;
  std::memcpy(&result, &low, sizeof result);
  return result;
}

void expect_float_operations(Target target, const float* a, const float* b, const float* c) {
  const int lanes = simd::lanes(target);
  const bool fused = is_fused(target);
  float out[19 * kMost];
  float_operations(a, b, c, out);
  for (int i = 0; i < lanes; ++i) {
    const float x = a[i], y = b[i], z = c[i];
    const float product = rounded_product(x, y);
    const float expected[] = {x + y,
                              x - y,
                              x * y,
                              x / y,  //
                              fused ? fused_sum(x, y, z) : product + z,
                              fused ? fused_sum(-x, y, z) : z - product,
                              product + z,
                              z - product,  //
                              x < y ? x : y,
                              x > y ? x : y,
                              std::sqrt(x),
                              std::fabs(x),
                              -x,
                              std::floor(x),  //
                              x < y ? x : z,
                              x < y ? x : 0.0f,
                              a[0],
                              0.0f,
                              static_cast<float>(i)};
    for (int k = 0; k < 19; ++k) {
      EXPECT_TRUE(same(out[lanes * k + i], expected[k])) << "operation " << k << " of " << x << ", " << y << ", " << z
                                                         << ": " << out[lanes * k + i] << ", not " << expected[k];
    }
  }
}

TEST(Vec, FloatOperationsGiveTheIeeeBits) {
  on_each_target([](Target target, int) {
    const std::size_t n = kFloats.size();
    for (std::size_t first = 0; first < n * n; first += 5) {  // pairs, shifted against the lanes
      float a[kMost], b[kMost], c[kMost];
      for (std::size_t i = 0; i < kMost; ++i) {
        const std::size_t k = (first + i) % (n * n);
        a[i] = kFloats[k / n], b[i] = kFloats[k % n], c[i] = kFloats[(k * 7 + k / n) % n];
      }
      expect_float_operations(target, a, b, c);
    }
    std::mt19937 random(5);
    const auto uniform = [&random] {
      return static_cast<float>(static_cast<double>(random()) / 4294967296.0 * 600 - 300);
    };
    for (int round = 0; round < 200; ++round) {
      float a[kMost], b[kMost], c[kMost];
      for (int i = 0; i < kMost; ++i) a[i] = uniform(), b[i] = uniform(), c[i] = uniform() * 100;
      expect_float_operations(target, a, b, c);
    }
  });
}

TEST(Vec, IntOperationsWrap) {
  on_each_target([](Target, int lanes) {
    const std::size_t n = kInts.size();
    for (std::size_t first = 0; first < n * n; first += 3) {
      int a[kMost], b[kMost], out[13 * kMost];
      for (std::size_t i = 0; i < kMost; ++i) a[i] = kInts[(first + i) % (n * n) / n], b[i] = kInts[(first + i) % n];
      const int shift = static_cast<int>(first % 32);
      int_operations(a, b, shift, out);
      for (int i = 0; i < lanes; ++i) {
        const std::int64_t x = a[i], y = b[i];
        const int expected[13] = {
            wrap(x + y),
            wrap(x - y),
            wrap(static_cast<std::int64_t>(static_cast<std::uint64_t>(x) * static_cast<std::uint64_t>(y))),
            std::min(a[i], b[i]),
            std::max(a[i], b[i]),
            a[i] & b[i],
            a[i] | b[i],
            wrap(x * (std::int64_t{1} << shift)),
            a[i] >> shift,
            wrap(x * 8),
            a[i] >> 3,
            a[0],
            i};
        for (int k = 0; k < 13; ++k)
          EXPECT_EQ(out[lanes * k + i], expected[k]) << "operation " << k << " of " << x << ", " << y;
      }
    }
  });
}

TEST(Vec, ConversionsTruncateAndRound) {
  const std::vector<float> floats = {0.0f,          -0.0f,          0.999f,     -0.999f,     1.5f, -1.5f,
                                     2147483520.0f, -2147483648.0f, 8388607.5f, -8388607.5f, 3.0f, -7.9999995f,
                                     1e-30f,        100.01f,        -100.99f,   0.5f};
  on_each_target([&](Target, int lanes) {
    for (std::size_t first = 0; first < kMost; ++first) {
      float a[kMost], to_floats[kMost];
      int b[kMost], to_ints[kMost];
      for (std::size_t i = 0; i < kMost; ++i) a[i] = floats[(first + i) % kMost], b[i] = kInts[(first + i) % kMost];
      conversions(a, b, to_ints, to_floats);
      for (int i = 0; i < lanes; ++i) {
        EXPECT_EQ(to_ints[i], static_cast<int>(a[i])) << a[i];
        EXPECT_EQ(to_floats[i], static_cast<float>(b[i])) << b[i];
      }
    }
    // Unspecified, but nothing traps: the sanitizers and the emulators look on.
    float wild[kMost], floats_out[kMost];
    int zeros[kMost] = {}, ints_out[kMost];
    const float values[] = {kNaN, kInf, -kInf, 3e9f, -3e9f, 2147483648.0f};
    for (int first = 0; first < 6; ++first) {
      for (int i = 0; i < kMost; ++i) wild[i] = values[(first + i) % 6];
      conversions(wild, zeros, ints_out, floats_out);
      EXPECT_EQ(floats_out[0], 0.0f);
    }
  });
}

TEST(Vec, MasksAndTheirBits) {
  on_each_target([](Target, int lanes) {
    const unsigned every = (1u << lanes) - 1u;
    const std::size_t n = kFloats.size(), m = kInts.size();
    for (std::size_t first = 0; first < n * n; ++first) {
      float a[kMost], b[kMost];
      int p[kMost], q[kMost];
      for (std::size_t i = 0; i < kMost; ++i) {
        const std::size_t k = (first + i) % (n * n), j = (first + i) % (m * m);
        a[i] = kFloats[k / n], b[i] = kFloats[k % n], p[i] = kInts[j / m], q[i] = kInts[j % m];
      }
      if (first % 4 == 1) std::fill(a, a + kMost, -kInf), std::fill(b, b + kMost, 1.0f);  // all
      if (first % 4 == 2) std::fill(a, a + kMost, 2.0f), std::fill(b, b + kMost, 1.0f);   // none
      unsigned e[10] = {}, out[10];
      for (int i = 0; i < lanes; ++i) {
        const unsigned bit = 1u << i;
        const auto set = [&](int k, bool value) { e[k] |= value ? bit : 0u; };
        set(0, a[i] < b[i]), set(1, a[i] <= b[i]), set(2, a[i] > b[i]), set(3, a[i] >= b[i]), set(4, a[i] == b[i]);
        set(5, p[i] == q[i]);
      }
      e[6] = e[0] & e[5], e[7] = ~e[0] & e[5];
      for (int i = 0; i < lanes; ++i) e[8] += (e[0] >> i) & 1u;
      e[9] = e[0] == every;
      mask_operations(a, b, p, q, out);
      for (int k = 0; k < 10; ++k) EXPECT_EQ(out[k], e[k]) << "operation " << k << ", pairs from " << first;
    }
    for (int k = -3; k <= lanes + 3; ++k) {
      const unsigned expected = (1u << std::clamp(k, 0, lanes)) - 1u;
      EXPECT_EQ(first_lanes(k), expected) << k;
    }
    EXPECT_EQ(first_lanes(kMax), every);
    EXPECT_EQ(first_lanes(kMin), 0u);
  });
}

TEST(Vec, InverseRootsWithinTheirBound) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> exponent(-30, 30);
  on_each_target([&](Target, int lanes) {
    for (int round = 0; round < 1000; ++round) {
      float a[kMost], out[kMost];
      for (float& x : a) x = static_cast<float>(std::pow(10.0, exponent(random)));
      a[0] = 1.0f;
      inverse_roots(a, out);
      for (int i = 0; i < lanes; ++i) {
        const double expected = 1 / std::sqrt(static_cast<double>(a[i]));
        EXPECT_NEAR(static_cast<double>(out[i]), expected, 3e-7 * expected) << a[i];
      }
    }
  });
}

// Of quarters, on which all of them are exact.
TEST(Vec, OperationsOfDoubles) {
  std::mt19937 random(14);
  on_each_target([&](Target, int) {
    for (int round = 0; round < 200; ++round) {
      double a[8], b[8], c[8], out[80];
      for (double* p : {a, b, c})
        for (int i = 0; i < 8; ++i) p[i] = 0.25 * (static_cast<int>(random() % 17) - 8);
      const int n = double_operations(a, b, c, out);
      for (int i = 0; i < n; ++i) {
        const double want[10] = {a[i] + b[i],        a[i] - b[i],           a[i] * b[i],          a[i] / 4,
                                 a[i] * b[i] + c[i], std::min(a[i], b[i]),  std::max(a[i], b[i]), std::abs(a[i]),
                                 std::trunc(a[i]),   a[i] > 0 ? b[i] : c[i]};
        for (int k = 0; k < 10; ++k) EXPECT_EQ(out[n * k + i], want[k]) << k;
      }
    }
  });
}

TEST(Vec, ReductionsHalveTheLanes) {
  std::mt19937 random(11);
  on_each_target([&](Target, int lanes) {
    for (int round = 0; round < 100; ++round) {
      float a[kMost], sum[kMost];
      double sum_d[kMost], out[4];
      for (int i = 0; i < kMost; ++i) {
        a[i] = static_cast<float>(static_cast<double>(random()) / 4294967296.0 - 0.5) *
               std::pow(10.0f, static_cast<float>(i % 5));
        sum[i] = a[i], sum_d[i] = static_cast<double>(a[i]);
      }
      for (int half = lanes / 2; half > 0; half /= 2) {
        for (int i = 0; i < half; ++i) sum[i] += sum[i + half], sum_d[i] += sum_d[i + half];
      }
      reductions(a, out);
      EXPECT_EQ(out[0], static_cast<double>(sum[0]));
      EXPECT_EQ(out[1], sum_d[0]);
      EXPECT_EQ(out[2], static_cast<double>(*std::min_element(a, a + lanes)));
      EXPECT_EQ(out[3], static_cast<double>(*std::max_element(a, a + lanes)));
    }
  });
}

TEST(Vec, SumsOfSeveralVectorsKeepThemApart) {
  std::mt19937 random(12);
  on_each_target([&](Target, int lanes) {
    for (int round = 0; round < 100; ++round) {
      // Integers, whose sums are exact in any order.
      float p[8 * kMost];
      for (float& value : p) value = static_cast<float>(static_cast<int>(random() % 20001) - 10000);
      double want[8] = {}, out[12];
      for (int k = 0; k < 8 * lanes; ++k) want[k / lanes] += static_cast<double>(p[k]);
      eight_sums(p, out);
      for (int k = 0; k < 4; ++k) EXPECT_EQ(out[k], want[k]);
      for (int k = 0; k < 8; ++k) EXPECT_EQ(out[4 + k], want[k]);
    }
  });
}

TEST(Vec, TapsAreExactDifferencesOfBytes) {
  std::mt19937 random(13);
  on_each_target([&](Target, int lanes) {
    for (int round = 0; round < 300; ++round) {
      std::uint32_t words[kMost];
      float out[4 * kMost];
      for (std::uint32_t& word : words) {
        word = static_cast<std::uint32_t>(random());
        if (round % 3 == 0) word = (word & 0x01010101u) * 255u;  // each byte 0 or 255
      }
      taps(words, out);
      for (int i = 0; i < lanes; ++i) {
        const auto byte = [&](int k) { return static_cast<int>(words[i] >> (8 * k) & 255u); };
        EXPECT_EQ(out[i], static_cast<float>(byte(0)));
        EXPECT_EQ(out[lanes + i], static_cast<float>(byte(1) - byte(0)));
        EXPECT_EQ(out[2 * lanes + i], static_cast<float>(byte(2) - byte(0)));
        EXPECT_EQ(out[3 * lanes + i], static_cast<float>(byte(0) - byte(1) - byte(2) + byte(3)));
      }
    }
  });
}

}  // namespace vec_test
