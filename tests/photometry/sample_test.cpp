#include "textplane/photometry/sample.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "photometry/scene.hpp"
#include "support/dual.hpp"

namespace tp = textplane;
using textplane_test::Dual;
using textplane_test::Random;

namespace sample_test {

template <class T>
class Sample : public testing::Test {};
using PixelTypes = testing::Types<std::uint8_t, float>;
TYPED_TEST_SUITE(Sample, PixelTypes, );

TYPED_TEST(Sample, IsTheBilinearInterpolant) {
  const auto image = textplane_test::texture<TypeParam>(23, 17, 3);
  const tp::ImageView<const TypeParam> view = image.view();
  Random random(4);
  for (int k = 0; k < 500; ++k) {
    const double x = random.uniform(0, 22), y = random.uniform(0, 16);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const double u = x - x0, v = y - y0;
    const double expected =
        (1 - u) * (1 - v) * static_cast<double>(image(x0, y0)) + u * (1 - v) * static_cast<double>(image(x0 + 1, y0)) +
        (1 - u) * v * static_cast<double>(image(x0, y0 + 1)) + u * v * static_cast<double>(image(x0 + 1, y0 + 1));
    double value;
    ASSERT_TRUE(tp::sample_bilinear(view, x, y, &value));
    ASSERT_NEAR(value, expected, 1e-11);
    float single;
    ASSERT_TRUE(tp::sample_bilinear(view, static_cast<float>(x), static_cast<float>(y), &single));
    ASSERT_NEAR(single, expected, 2e-3);
  }
}

TYPED_TEST(Sample, GradientIsThatOfTheInterpolantInsideACell) {
  const auto image = textplane_test::texture<TypeParam>(23, 17, 5);
  const tp::ImageView<const TypeParam> view = image.view();
  Random random(6);
  const double h = 1e-3;
  for (int k = 0; k < 500; ++k) {
    const double x = random.integer(0, 21) + random.uniform(0.01, 0.99);
    const double y = random.integer(0, 15) + random.uniform(0.01, 0.99);
    double value, gx, gy, left, right, above, below;
    ASSERT_TRUE(tp::sample_bilinear(view, x, y, &value, &gx, &gy));
    ASSERT_TRUE(tp::sample_bilinear(view, x - h, y, &left));
    ASSERT_TRUE(tp::sample_bilinear(view, x + h, y, &right));
    ASSERT_TRUE(tp::sample_bilinear(view, x, y - h, &above));
    ASSERT_TRUE(tp::sample_bilinear(view, x, y + h, &below));
    // The interpolant is linear along each axis: the difference is exact up to rounding.
    ASSERT_NEAR(gx, (right - left) / (2 * h), 1e-9);
    ASSERT_NEAR(gy, (below - above) / (2 * h), 1e-9);

    Dual<2> dual;
    ASSERT_TRUE(tp::sample_bilinear(view, Dual<2>(x, 0), Dual<2>(y, 1), &dual));
    ASSERT_NEAR(dual.a, value, 1e-12);
    ASSERT_NEAR(dual.v[0], gx, 1e-12);
    ASSERT_NEAR(dual.v[1], gy, 1e-12);
  }
}

TYPED_TEST(Sample, IncludesTheBorders) {
  const auto image = textplane_test::texture<TypeParam>(9, 7, 8);
  const tp::ImageView<const TypeParam> view = image.view();
  double value, gx, gy;
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 9; ++x) {
      ASSERT_TRUE(tp::sample_bilinear(view, double(x), double(y), &value, &gx, &gy));
      ASSERT_EQ(value, static_cast<double>(image(x, y)));
      const int x0 = std::min(x, 7), y0 = std::min(y, 5);
      ASSERT_EQ(gx, static_cast<double>(image(x0 + 1, y)) - static_cast<double>(image(x0, y)));
      ASSERT_EQ(gy, static_cast<double>(image(x, y0 + 1)) - static_cast<double>(image(x, y0)));
    }
}

TYPED_TEST(Sample, RefusesTheOutsideAndWritesNothing) {
  const auto image = textplane_test::texture<TypeParam>(9, 7, 8);
  const tp::ImageView<const TypeParam> view = image.view();
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const double outside[][2] = {{-1e-9, 3}, {8 + 1e-9, 3}, {4, -1e-9}, {4, 6 + 1e-9}, {nan, 3},   {4, nan},
                               {inf, 3},   {-inf, 3},     {4, inf},   {4, -inf},     {1e300, 3}, {4, -1e300}};
  for (const auto& p : outside) {
    double value = 12.5, gx = 1.5, gy = 2.5;
    EXPECT_FALSE(tp::sample_bilinear(view, p[0], p[1], &value, &gx, &gy)) << p[0] << ' ' << p[1];
    EXPECT_EQ(value, 12.5);
    EXPECT_EQ(gx, 1.5);
    EXPECT_EQ(gy, 2.5);
  }
}

TYPED_TEST(Sample, SinglePixelsRowsAndColumns) {
  // Blocks of exactly the size of the image: a read beyond it is seen by the address sanitizer.
  const std::vector<TypeParam> pixels = {10, 30, 70};
  double value, gx, gy;
  ASSERT_TRUE(tp::sample_bilinear(tp::ImageView<const TypeParam>(pixels.data(), 3, 1), 1.25, 0.0, &value, &gx, &gy));
  EXPECT_EQ(value, 40);
  EXPECT_EQ(gx, 40);
  EXPECT_EQ(gy, 0);
  ASSERT_TRUE(tp::sample_bilinear(tp::ImageView<const TypeParam>(pixels.data(), 1, 3), 0.0, 0.5, &value, &gx, &gy));
  EXPECT_EQ(value, 20);
  EXPECT_EQ(gx, 0);
  EXPECT_EQ(gy, 20);
  const std::vector<TypeParam> single = {42};
  const tp::ImageView<const TypeParam> one(single.data(), 1, 1);
  ASSERT_TRUE(tp::sample_bilinear(one, 0.0, 0.0, &value, &gx, &gy));
  EXPECT_EQ(value, 42);
  EXPECT_EQ(gx, 0);
  EXPECT_EQ(gy, 0);
  EXPECT_FALSE(tp::sample_bilinear(one, 0.25, 0.0, &value));
}

TYPED_TEST(Sample, KeepsToTheStrideAndRefusesBadViews) {
  const auto image = textplane_test::texture<TypeParam>(12, 8, 9);
  const auto row = static_cast<std::ptrdiff_t>(12 * sizeof(TypeParam));
  const tp::ImageView<const TypeParam> crop(image.data() + 3, 5, 8, row);
  double value, expected;
  ASSERT_TRUE(tp::sample_bilinear(crop, 2.3, 6.6, &value));
  ASSERT_TRUE(tp::sample_bilinear(tp::ImageView<const TypeParam>(image.view()), 5.3, 6.6, &expected));
  EXPECT_NEAR(value, expected, 1e-12);
  EXPECT_FALSE(tp::sample_bilinear(crop, 4.5, 6.6, &value));

  using View = tp::ImageView<const TypeParam>;
  for (const View& bad : {View(), View(image.data(), 0, 0), View(image.data(), 12, 8, row - 1), View(nullptr, 12, 8),
                          View(image.data(), -3, 8)})
    EXPECT_FALSE(tp::sample_bilinear(bad, 0.0, 0.0, &value));
}

}  // namespace sample_test
