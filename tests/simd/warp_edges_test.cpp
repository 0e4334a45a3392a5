// The warps on every target: what they refuse, what they read and write, and divisors that vanish.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "simd/warp_support.hpp"
#include "support/guarded.hpp"

namespace warp_edges_test {

using namespace warp_support;

TEST(WarpEdges, RefusesWhatItCannotDo) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  Padded<std::uint8_t> source(20, 10, 0, 200), mask(7, 4, 0, 5), small(6, 4, 0);
  Padded<float> out(7, 4, 0, -1);
  const Matrix3<double> identity = Matrix3<double>::Identity();
  on_each_target([&](Target) {
    for (int i = 0; i < 9; ++i)
      for (const double bad : {nan, inf, -inf}) {
        Matrix3<double> H = identity;
        H(i / 3, i % 3) = bad;
        EXPECT_EQ(warp_patch(ImageView8(source.view()), H, out.view()).status, Status::non_finite);
      }
    EXPECT_EQ(warp_patch(ImageView8(), identity, out.view()).status, Status::invalid_argument);
    EXPECT_EQ(warp_patch(ImageView8(source.view()), identity, ImageView<float>()).status, Status::invalid_argument);
    EXPECT_EQ(warp_patch(ImageView8(source.view()), identity, out.view(), 0, small.view()).status,
              Status::invalid_argument);
    for (const float v : out.pixels) EXPECT_EQ(v, -1);

    // All zero: nothing is in front. Huge, tiny and far away: fill and no harm.
    for (const double scale : {0.0, 1e-300, 1e300}) {
      Padded<float> filled(7, 4, 0, -1);
      Matrix3<double> H = identity * scale;
      H(0, 2) = 1e7 * scale;
      const WarpSummary summary = warp_patch(ImageView8(source.view()), H, filled.view(), kFill, mask.view());
      EXPECT_EQ(summary.status, Status::out_of_view) << scale;
      EXPECT_EQ(summary.inside, 0);
      for (const float v : filled.pixels) EXPECT_EQ(v, kFill);
      for (const std::uint8_t m : mask.pixels) EXPECT_EQ(m, 0);
    }

    // One row or one column: the reference serves.
    Padded<std::uint8_t> row(20, 1, 0, 90), column(1, 10, 0, 91);
    Padded<float> one(20, 1, 0), other(1, 10, 0);
    EXPECT_EQ(warp_patch(ImageView8(row.view()), identity, one.view()).inside, 20);
    EXPECT_EQ(warp_patch(ImageView8(column.view()), identity, other.view()).inside, 10);
    for (const float v : one.pixels) EXPECT_EQ(v, 90);
    for (const float v : other.pixels) EXPECT_EQ(v, 91);
  });
}

template <class S, class D>
void stay_inside() {
  Random random(9);
  for (int k = 0; k < 300; ++k) {
    const int width = static_cast<int>(random.uniform(2, 40)), height = static_cast<int>(random.uniform(2, 30));
    const int out_width = static_cast<int>(random.uniform(1, 40)), out_height = static_cast<int>(random.uniform(1, 12));
    const textplane_test::Guarded<S> memory(static_cast<std::size_t>(width * height));
    const textplane_test::Guarded<D> out_memory(static_cast<std::size_t>(out_width * out_height));
    for (const bool at_end : {false, true}) {
      S* pixels = at_end ? memory.data() : memory.front();
      D* out = at_end ? out_memory.data() : out_memory.front();
      for (int i = 0; i < width * height; ++i) pixels[i] = static_cast<S>(i % 251);
      Matrix3<double> H = random_warp(random, width, height, out_width, out_height, 0.6);
      if (k % 3 == 0) H << 1, 0, 0, 0, 1, 0, 0, 0, 1;
      if (k % 3 == 1) H << 1, 0, width - out_width, 0, 1, height - out_height, 0, 0, 1;
      warp_patch(ImageView<const S>(pixels, width, height), H, ImageView<D>(out, out_width, out_height));
    }
  }
}

TEST(WarpEdges, TouchesNothingOutside) {
  on_each_target([](Target) {
    stay_inside<std::uint8_t, float>();
    stay_inside<std::uint8_t, std::uint8_t>();
    stay_inside<float, float>();
  });
}

// All output pixels come from one source pixel; the divisor vanishes, or nearly, at a corner of the output.
TEST(WarpEdges, DivisorThatVanishesAtACorner) {
  const int width = 55, height = 40, out_width = 6, out_height = 9;
  const textplane_test::Guarded<std::uint8_t> memory(static_cast<std::size_t>(width * height));
  for (int i = 0; i < width * height; ++i) memory.front()[i] = memory.data()[i] = static_cast<std::uint8_t>(i % 251);
  on_each_target([&](Target) {
    Random random(14);
    for (int k = 0; k < 400; ++k) {
      const double u = k % 2 ? out_width - 1 : 0, v = k / 2 % 2 ? out_height - 1 : 0;
      const double a = random.uniform(0.1, 2) * (k % 2 ? -1 : 1), b = random.uniform(0.1, 2) * (k / 2 % 2 ? -1 : 1);
      const double left = k % 5 == 0 ? 0 : std::pow(10.0, random.uniform(-17, -2));
      const Eigen::RowVector3d divisor(a, b, left - a * u - b * v);
      Matrix3<double> H;
      H.row(0) = random.uniform(1, width - 2) * divisor;
      H.row(1) = random.uniform(1, height - 2) * divisor;
      H.row(2) = divisor;
      for (const std::uint8_t* pixels : {memory.front(), memory.data()}) {
        Image<float> values(out_width, out_height);
        Image<std::uint8_t> bytes(out_width, out_height);
        warp_patch(ImageView8(pixels, width, height), H, values.view(), kFill);
        warp_patch(ImageView8(pixels, width, height), H, bytes.view(), kFill);
        for (int y = 0; y < out_height; ++y)
          for (int x = 0; x < out_width; ++x) ASSERT_TRUE(values(x, y) >= 0 && values(x, y) < 255.01F) << H;
      }
    }
  });
}

}  // namespace warp_edges_test
