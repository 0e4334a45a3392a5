// The kernels of KLT on every target: samples within their rounding of the bilinear interpolant, the gradients and sums
// that follow from them exactly, and not a byte beyond what may be read.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "support/guarded.hpp"
#include "support/targets.hpp"
#include "textplane/simd/klt.hpp"

namespace klt_kernels_test {

using namespace textplane_test;
using simd::kKltSide;
using simd::kKltStride;
using simd::KltPatch;
using simd::KltPatchSums;
using simd::KltSums;
using simd::KltWindow;

std::vector<std::uint8_t> noise(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> bytes(size);
  for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random() % 3 ? random() % 256 : random() % 2 * 255);
  return bytes;
}

// The interpolant, and what its documented rounding makes of it: 1/64 grey level along y, then 1/32 downwards.
double interpolated(const KltWindow& w, int x, int y) {
  const std::uint8_t* p = w.data + y * w.stride + x;
  const double fx = w.fx / 64.0, fy = w.fy / 64.0;
  return (1 - fy) * ((1 - fx) * p[0] + fx * p[1]) + fy * ((1 - fx) * p[w.stride] + fx * p[w.stride + 1]);
}

int sample(const KltWindow& w, int x, int y) {
  const std::uint8_t* p = w.data + y * w.stride + x;
  const auto along = [&w](const std::uint8_t* q) { return (64 - w.fx) * (q[0] - 128) + w.fx * (q[1] - 128); };
  const int above = along(p), below = along(p + w.stride);
  const double between = above + std::floor((below - above) * (w.fy / 64.0) + 0.5);
  return static_cast<int>(std::floor(between / 2));
}

int value(const KltPatch& patch, int x, int y) { return patch.value[y * kKltStride + x]; }

// Of samples v(x, y) with a border of one.
template <class Sample>
KltPatchSums plain_patch(int columns, int rows, Sample v, KltPatch* patch) {
  KltPatchSums s;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const auto at = static_cast<std::size_t>(y * kKltStride + x);
      const int t = v(x + 1, y + 1);
      const int gx = static_cast<int>(std::floor((v(x + 2, y + 1) - v(x, y + 1)) / 2.0));
      const int gy = static_cast<int>(std::floor((v(x + 1, y + 2) - v(x + 1, y)) / 2.0));
      patch->value[at] = static_cast<std::int16_t>(t);
      patch->gx[at] = static_cast<std::int16_t>(gx);
      patch->gy[at] = static_cast<std::int16_t>(gy);
      s.v += t;
      s.vv += static_cast<double>(t) * t;
      s.x += gx;
      s.y += gy;
      s.vx += static_cast<double>(t) * gx;
      s.vy += static_cast<double>(t) * gy;
      s.xx += static_cast<double>(gx) * gx;
      s.xy += static_cast<double>(gx) * gy;
      s.yy += static_cast<double>(gy) * gy;
    }
  return s;
}

void expect_equal(const KltPatchSums& a, const KltPatchSums& b) {
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.vv, b.vv);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.vx, b.vx);
  EXPECT_EQ(a.vy, b.vy);
  EXPECT_EQ(a.xx, b.xx);
  EXPECT_EQ(a.xy, b.xy);
  EXPECT_EQ(a.yy, b.yy);
}

void expect_equal(const KltPatch& a, const KltPatch& b, int columns, int rows) {
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const int at = y * kKltStride + x;
      ASSERT_EQ(a.value[at], b.value[at]) << x << " " << y;
      ASSERT_EQ(a.gx[at], b.gx[at]) << x << " " << y;
      ASSERT_EQ(a.gy[at], b.gy[at]) << x << " " << y;
    }
}

struct Size {
  int columns, rows;
};

std::vector<Size> sizes() {
  std::vector<Size> all;
  for (int columns = 1; columns <= kKltSide; ++columns) all.push_back({columns, 1 + columns * 7 % kKltSide});
  for (const int side : {7, 15, 16, 17, kKltSide}) all.push_back({side, side});
  return all;
}

constexpr int kFractions[][2] = {{0, 0}, {1, 63}, {64, 64}, {31, 0}, {0, 17}, {40, 23}};

TEST(KltKernel, ExtractsTheRoundedInterpolantAndItsGradients) {
  unsigned seed = 1;
  for (const Size& size : sizes())
    for (const auto& fraction : kFractions) {
      const int columns = size.columns, rows = size.rows, width = columns + 3 + static_cast<int>(seed % 3) * 20;
      const auto pixels = noise(static_cast<std::size_t>(width * (rows + 3)), seed++);
      const KltWindow window{pixels.data(), width, width, columns + 2, rows + 2, fraction[0], fraction[1]};
      KltPatch expected, found;
      const KltPatchSums sums = plain_patch(
          columns, rows, [&window](int x, int y) { return sample(window, x, y); }, &expected);
      for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {  // off by -3/128 to 1/128
          const double off = value(expected, x, y) / 32.0 + 128 - interpolated(window, x + 1, y + 1);
          ASSERT_LE(off, 1.0 / 128);
          ASSERT_GE(off, -3.0 / 128);
        }
      for (const simd::Target target : testable_targets()) {
        const TargetScope scope(target);
        SCOPED_TRACE(std::string(simd::to_string(target)) + ", " + std::to_string(columns) + " x " +
                     std::to_string(rows));
        expect_equal(simd::klt_extract(window, found), sums);
        expect_equal(found, expected, columns, rows);
      }
    }
}

TEST(KltKernel, TakesGreyLevelsThatWereSampledElsewhere) {
  std::mt19937 random(9);
  for (const Size& size : sizes()) {
    const int columns = size.columns, rows = size.rows;
    std::vector<float> grey(simd::kKltPadded);
    for (float& g : grey)
      g = random() % 4 ? static_cast<float>(random() % 65281) / 256.0F : (random() % 2 ? 0.0F : 255.0F);
    KltPatch expected, found;
    const KltPatchSums sums = plain_patch(
        columns, rows,
        [&grey](int x, int y) {
          return static_cast<int>(std::floor(grey[static_cast<std::size_t>(y * kKltStride + x)] * 32 + 0.5F)) - 4096;
        },
        &expected);
    for (const simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      SCOPED_TRACE(simd::to_string(target));
      expect_equal(simd::klt_from_grey(grey.data(), columns, rows, found), sums);
      expect_equal(found, expected, columns, rows);
    }
  }
}

TEST(KltKernel, SumsAreExactToTheLargestThereAre) {
  unsigned seed = 100;
  for (const Size& size : sizes())
    for (const auto& fraction : kFractions) {
      const int columns = size.columns, rows = size.rows, width = columns + 1 + static_cast<int>(seed % 3) * 20;
      auto pixels = noise(static_cast<std::size_t>(width * (rows + 1)), seed);
      const auto host = noise(static_cast<std::size_t>((columns + 3) * (rows + 3)), seed + 1);
      if (seed % 4 == 0) std::fill(pixels.begin(), pixels.end(), std::uint8_t{0});  // every product 4096^2
      ++seed;
      const KltWindow window{pixels.data(), width, width, columns, rows, fraction[0], fraction[1]};
      KltPatch patch;
      simd::klt_extract({host.data(), columns + 3, columns + 3, columns + 2, rows + 2, 13, 50}, patch);
      KltSums expected;
      for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
          const double v = sample(window, x, y);
          const int at = y * kKltStride + x;
          expected.v += v;
          expected.vv += v * v;
          expected.tv += v * patch.value[at];
          expected.xv += v * patch.gx[at];
          expected.yv += v * patch.gy[at];
        }
      for (const simd::Target target : testable_targets()) {
        const TargetScope scope(target);
        SCOPED_TRACE(std::string(simd::to_string(target)) + ", " + std::to_string(columns) + " x " +
                     std::to_string(rows));
        // What lies past the last column of a patch counts for nothing.
        KltPatch dirty = patch;
        for (int y = 0; y < rows; ++y)
          for (int x = columns; x < kKltStride; ++x)
            dirty.value[y * kKltStride + x] = dirty.gx[y * kKltStride + x] = 4000;
        const KltSums found = simd::klt_sums(window, dirty);
        EXPECT_EQ(found.v, expected.v);
        EXPECT_EQ(found.vv, expected.vv);
        EXPECT_EQ(found.tv, expected.tv);
        EXPECT_EQ(found.xv, expected.xv);
        EXPECT_EQ(found.yv, expected.yv);
      }
    }
}

// The window is the last one of an image whose last pixel touches a forbidden page, and the first one of one that
// follows one.
TEST(KltKernel, ReadsWhatMayBeRead) {
  for (const Size& size : sizes())
    for (const int more : {0, 1, 8, 40}) {  // readable bytes beyond the window
      const int columns = size.columns, rows = size.rows, width = columns + 3 + more;
      const Guarded<std::uint8_t> image(static_cast<std::size_t>(width * (rows + 3)));
      for (const bool low : {false, true}) {
        std::uint8_t* const data = low ? image.front() : image.data();
        std::fill(data, data + image.size(), std::uint8_t{50});
        const KltWindow padded{data, width, width, columns + 2, rows + 2, 20, 20};
        const KltWindow window{data, width, width, columns, rows + 2, 20, 20};
        const double v = 32 * (50 - 128);
        for (const simd::Target target : testable_targets()) {
          const TargetScope scope(target);
          KltPatch patch;
          EXPECT_EQ(simd::klt_extract(padded, patch).v, v * columns * rows) << simd::to_string(target);
          if (rows + 2 > kKltSide) continue;
          EXPECT_EQ(simd::klt_sums(window, patch).v, v * columns * (rows + 2)) << simd::to_string(target);
        }
      }
    }
}

}  // namespace klt_kernels_test
