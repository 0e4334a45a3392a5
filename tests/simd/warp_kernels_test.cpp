// The warps on every target against the double reference: values, masks, bits and borders.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "simd/rounding_support.hpp"
#include "simd/warp_support.hpp"

namespace warp_kernels_test {

using namespace warp_support;
using textplane_test::kRoundings;
using textplane_test::rounding;

// Distance of the source point of (x, y) from the border of the domain; negative outside. Zero where q_z is near zero.
double clearance(const Matrix3<double>& H, int x, int y, int width, int height) {
  const Vector3<double> q = H * Vector3<double>(x, y, 1);
  if (!(std::abs(q[2]) > 1e-6 * H.cwiseAbs().maxCoeff())) return 0;
  if (q[2] < 0) return -1;
  const double px = q[0] / q[2], py = q[1] / q[2];
  return std::min({px, py, width - 1 - px, height - 1 - py});
}

// One warp against the reference; the kernel's pixels are appended to `bits`.
template <class S, class D>
void compare(const ImageView<const S>& source, const Matrix3<double>& H, int width, int height, int gap, double bound,
             std::vector<D>* bits) {
  Padded<double> expected(width, height, 0);
  Padded<std::uint8_t> expected_mask(width, height, 0), mask(width, height, 5, 99);
  Padded<D> out(width, height, gap, D(13));
  reference::warp_patch(source, H, expected.view(), kFill, expected_mask.view());
  const WarpSummary summary = warp_patch(source, H, out.view(), kFill, mask.view());
  int inside = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      inside += mask.at(x, y);
      const bool unsure = std::abs(clearance(H, x, y, source.width(), source.height())) < 1e-4;
      if (!unsure) {
        ASSERT_EQ(mask.at(x, y), expected_mask.at(x, y)) << x << " " << y;
      }
      if (mask.at(x, y) != expected_mask.at(x, y)) continue;
      const double want = expected.at(x, y), got = static_cast<double>(out.at(x, y));
      if constexpr (std::is_same<D, std::uint8_t>::value) {
        const double tie = std::abs(want - std::floor(want) - 0.5);
        if (tie > bound) {
          ASSERT_EQ(got, std::floor(want + 0.5)) << x << " " << y << " of " << want;
        }
        ASSERT_LE(std::abs(got - want), 0.5 + bound);
      } else {
        ASSERT_NEAR(got, want, bound) << x << " " << y;
      }
    }
    for (int g = 0; g < gap; ++g) ASSERT_EQ(out.at(width + g, y), D(13));
    for (int g = 0; g < 5; ++g) ASSERT_EQ(mask.at(width + g, y), 99);
  }
  EXPECT_EQ(summary.inside, inside);
  EXPECT_EQ(summary.status, inside > 0 ? Status::ok : Status::out_of_view);
  bits->insert(bits->end(), out.pixels.begin(), out.pixels.end());
}

// The same cases on every target; targets with fused multiply-add must agree in every bit, and so must the others.
template <class S, class D>
void compare_everywhere(double bound) {
  std::vector<D> first[kRoundings];
  on_each_target([&](Target target) {
    Random random(5);
    std::vector<D> bits;
    for (int size = 1; size <= 65; ++size)
      for (int k = 0; k < 4; ++k) {
        const int width = k % 2 ? size : 1 + static_cast<int>(random.uniform(0, 40)), height = k % 2 ? 5 : size;
        const int source_width = static_cast<int>(random.uniform(2, 140)),
                  source_height = static_cast<int>(random.uniform(2, 90));
        const Padded<S> source = noise<S>(random, source_width, source_height, k);
        const double reach = k < 2 ? 0.1 : 0.7;
        const Matrix3<double> H = random_warp(random, source_width, source_height, width, height, reach);
        compare<S, D>(source.view(), H, width, height, k, bound, &bits);
        if (testing::Test::HasFatalFailure()) return;
      }
    for (int k = 0; k < 12; ++k) {
      const Padded<S> source = noise<S>(random, 640, 480, 3);
      const int width = 100 + 37 * k, height = 40 + 3 * k;
      const Matrix3<double> H = random_warp(random, 640, 480, width, height, k < 6 ? 0.02 : 0.6);
      compare<S, D>(source.view(), H, width, height, 1, bound, &bits);
      if (testing::Test::HasFatalFailure()) return;
    }
    std::vector<D>& group = first[rounding(target)];
    if (group.empty()) group = bits;
    EXPECT_EQ(std::memcmp(group.data(), bits.data(), bits.size() * sizeof(D)), 0);
  });
}

TEST(WarpKernels, BytesToFloat) { compare_everywhere<std::uint8_t, float>(0.01); }
TEST(WarpKernels, BytesToBytes) { compare_everywhere<std::uint8_t, std::uint8_t>(0.01); }
TEST(WarpKernels, FloatToFloat) { compare_everywhere<float, float>(0.01); }

// On a ridged image of slope one the error of a value is the error of its coordinate.
TEST(WarpKernels, CoordinatesOfWidePatches) {
  Padded<float> ridges(1100, 64, 0), folds(1100, 64, 0);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 1100; ++x) {
      ridges.view()(x, y) = static_cast<float>(x & 1);
      folds.view()(x, y) = static_cast<float>(y & 1);
    }
  on_each_target([&](Target) {
    double worst = 0;
    for (const int width : {100, 300, 1000}) {
      Matrix3<double> H;
      H << 1.0471, -0.0312, 20.317, 0.0213, 0.9713, 12.713, 3.1e-5, -2.3e-5, 1;
      for (const auto* image : {&ridges, &folds}) {
        Padded<float> out(width, 20, 0);
        Padded<double> expected(width, 20, 0);
        ASSERT_EQ(warp_patch(image->view(), H, out.view()).inside, width * 20);
        reference::warp_patch(image->view(), H, expected.view());
        for (std::size_t i = 0; i < out.pixels.size(); ++i)
          worst = std::max(worst, std::abs(static_cast<double>(out.pixels[i]) - expected.pixels[i]));
      }
    }
    EXPECT_LT(worst, 1.5e-5);
  });
}

// Level, nearly level and upright rows: neighbours share a row of the source, or cross a pixel line by rounding alone.
TEST(WarpKernels, RowsAlongPixelLines) {
  Random random(11);
  const Padded<std::uint8_t> source = noise<std::uint8_t>(random, 300, 200, 0);
  on_each_target([&](Target) {
    for (const double slope : {0.0, 1e-9, -1e-9, 3e-8, -3e-8, 1e-6, -1e-6, 1e-4, -1e-4})
      for (const double offset : {50.0, 50.0 + 1e-7, 50.0 - 1e-7, 50.5}) {
        Matrix3<double> level, upright;
        level << 1, 0, 40.25, slope, 1, offset, 0, 0, 1;
        upright << slope, 1, offset, 1, 0, 40.25, 0, 0, 1;
        std::vector<float> bits;
        compare<std::uint8_t, float>(source.view(), level, 150, 9, 0, 0.01, &bits);
        compare<std::uint8_t, float>(source.view(), upright, 150, 9, 0, 0.01, &bits);
        if (HasFatalFailure()) return;
      }
  });
}

// Exact where the arithmetic is: whole pixels are copied, up to and including the borders.
TEST(WarpKernels, IdentityCopies) {
  Random random(3);
  on_each_target([&](Target) {
    for (const int width : {2, 3, 15, 16, 17, 18, 40, 130})
      for (const int height : {2, 3, 4, 33}) {
        const Padded<std::uint8_t> source = noise<std::uint8_t>(random, width, height, 1);
        Padded<std::uint8_t> out(width, height, 0);
        const WarpSummary summary = warp_patch(source.view(), Matrix3<double>(Matrix3<double>::Identity()), out.view());
        ASSERT_EQ(summary.inside, width * height);
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x) ASSERT_EQ(out.at(x, y), source.at(x, y)) << width << " " << height;
      }
  });
}

// The horizon crosses the output: what lies behind is filled, and nothing else goes wrong.
TEST(WarpKernels, HorizonInsideTheOutput) {
  Random random(4);
  const Padded<std::uint8_t> source = noise<std::uint8_t>(random, 90, 70, 0);
  on_each_target([&](Target) {
    for (int k = 0; k < 40; ++k) {
      Matrix3<double> H;
      H << random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-40, 60), random.uniform(-1, 1),
          random.uniform(-1, 1), random.uniform(-40, 60), random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05),
          random.uniform(-1, 1);
      Padded<float> out(97, 33, 0);
      Padded<std::uint8_t> mask(97, 33, 0), expected(97, 33, 0);
      Padded<double> values(97, 33, 0);
      warp_patch(source.view(), H, out.view(), kFill, mask.view());
      reference::warp_patch(source.view(), H, values.view(), kFill, expected.view());
      for (int y = 0; y < 33; ++y)
        for (int x = 0; x < 97; ++x) {
          ASSERT_TRUE(out.at(x, y) >= 0 && out.at(x, y) <= 255);
          // Near the horizon a step covers many pixels, so that only clear cases are compared.
          if (std::abs(clearance(H, x, y, 90, 70)) > 0.05) {
            ASSERT_EQ(mask.at(x, y), expected.at(x, y));
          }
          if (!mask.at(x, y)) {
            ASSERT_EQ(out.at(x, y), kFill);
          }
        }
    }
  });
}

}  // namespace warp_kernels_test
