#include "textplane/photometry/pyramid.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "textplane/core/cameras/pinhole.hpp"

namespace tp = textplane;

namespace pyramid_test {

tp::Image<std::uint8_t> ramp(int width, int height) {
  tp::Image<std::uint8_t> image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image(x, y) = static_cast<std::uint8_t>(2 * x + 2 * y);
  return image;
}

TEST(Halve, RoundsTheMeanOfFour) {
  const std::vector<std::uint8_t> src = {0, 1, 1, 1, 255, 255,  //
                                         0, 0, 0, 0, 255, 255};
  std::vector<std::uint8_t> dst(3, 77);
  ASSERT_EQ(tp::halve({src.data(), 6, 2}, {dst.data(), 3, 1}), tp::Status::ok);
  EXPECT_EQ(dst, (std::vector<std::uint8_t>{0, 1, 255}));  // 1/4, 2/4 and 4 * 255 / 4
}

TEST(Halve, DropsOddRowsAndColumnsAndKeepsToStrides) {
  // 5 x 3 in rows of 7 bytes; the padding would show in the mean.
  std::vector<std::uint8_t> src(7 * 3, 200);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x) src[static_cast<std::size_t>(y * 7 + x)] = static_cast<std::uint8_t>(10 * x + 4 * y);
  std::vector<std::uint8_t> dst(9, 99);
  ASSERT_EQ(tp::halve({src.data(), 5, 3, 7}, {dst.data() + 3, 2, 1, 6}), tp::Status::ok);
  EXPECT_EQ(dst, (std::vector<std::uint8_t>{99, 99, 99, 7, 27, 99, 99, 99, 99}));
}

TEST(Halve, RefusesWrongSizesAndViews) {
  std::vector<std::uint8_t> src(64), dst(64, 5);
  const tp::ImageView8 s(src.data(), 8, 8);
  EXPECT_EQ(tp::halve(s, {dst.data(), 4, 3}), tp::Status::invalid_argument);
  EXPECT_EQ(tp::halve(s, {dst.data(), 5, 4}), tp::Status::invalid_argument);
  EXPECT_EQ(tp::halve(s, {nullptr, 4, 4}), tp::Status::invalid_argument);
  EXPECT_EQ(tp::halve({src.data(), 8, 8, 7}, {dst.data(), 4, 4}), tp::Status::invalid_argument);
  EXPECT_EQ(tp::halve({}, {}), tp::Status::invalid_argument);
  EXPECT_EQ(tp::halve({src.data(), 1, 1}, {dst.data(), 0, 0}), tp::Status::invalid_argument);
  EXPECT_EQ(dst, std::vector<std::uint8_t>(64, 5));
}

TEST(Pyramid, PixelOfALevelLiesAtTheCentreOfItsBlock) {
  // On a linear image the mean of a block is the value at its centre, exactly representable here.
  const tp::Image<std::uint8_t> image = ramp(60, 52);
  const tp::Pyramid pyramid(image.view(), 3);
  ASSERT_EQ(pyramid.levels(), 3);
  for (int l = 0; l < 3; ++l) {
    const tp::ImageView8 level = pyramid.level(l);
    ASSERT_EQ(level.width(), 60 >> l);
    ASSERT_EQ(level.height(), 52 >> l);
    const double k = 1 << l;
    for (int y = 0; y < level.height(); ++y)
      for (int x = 0; x < level.width(); ++x) {
        const double x0 = (x + 0.5) * k - 0.5, y0 = (y + 0.5) * k - 0.5;
        ASSERT_EQ(level(x, y), 2 * x0 + 2 * y0) << "level " << l;
      }
  }
}

TEST(Pyramid, CameraOfALevelFits) {
  const tp::Pinhole<double> camera(300, 310, 31.2, 24.9);
  const tp::Vector3<double> p(0.1, -0.05, 2.0);
  const tp::Vector2<double> px = camera.project(p);
  for (int l = 0; l < 4; ++l) {
    const tp::Vector2<double> at = camera.at_level(l).project(p);
    EXPECT_NEAR(at[0], (px[0] + 0.5) / (1 << l) - 0.5, 1e-12);
    EXPECT_NEAR(at[1], (px[1] + 0.5) / (1 << l) - 0.5, 1e-12);
  }
}

TEST(Pyramid, OwnsItsPixels) {
  tp::Image<std::uint8_t> image = ramp(16, 16);
  const tp::Pyramid pyramid(image.view(), 2);
  image.resize(16, 16, 0);
  EXPECT_EQ(pyramid.level(0)(3, 2), 10);
  const tp::Pyramid copy = pyramid;
  EXPECT_NE(copy.level(0).data(), pyramid.level(0).data());
  EXPECT_EQ(copy.level(1)(3, 2), pyramid.level(1)(3, 2));
}

TEST(Pyramid, TakesStridesAndReusesItsMemory) {
  const tp::Image<std::uint8_t> image = ramp(64, 48);
  const tp::ImageView8 crop(image.data() + 5, 40, 32, 64);
  tp::Pyramid pyramid(image.view(), 4);
  const std::uint8_t* before = pyramid.level(0).data();
  ASSERT_EQ(pyramid.build(crop, 4), tp::Status::ok);
  EXPECT_EQ(pyramid.level(0).data(), before);
  EXPECT_EQ(pyramid.level(0)(7, 3), image(12, 3));
  EXPECT_EQ(pyramid.level(3).width(), 5);
}

TEST(Pyramid, StopsWhereALevelWouldBeEmpty) {
  const tp::Image<std::uint8_t> image = ramp(7, 100);
  const tp::Pyramid pyramid(image.view(), 8);
  EXPECT_EQ(pyramid.levels(), 3);  // 7, 3, 1
  EXPECT_EQ(pyramid.level(2).width(), 1);
  EXPECT_FALSE(pyramid.level(3).valid());
  EXPECT_FALSE(pyramid.level(-1).valid());
  EXPECT_EQ(tp::Pyramid(tp::ImageView8(image.data(), 1, 1), 4).levels(), 1);
}

TEST(Pyramid, RefusesInvalidInput) {
  const tp::Image<std::uint8_t> image = ramp(16, 16);
  tp::Pyramid pyramid(image.view(), 3);
  EXPECT_EQ(pyramid.build({}, 3), tp::Status::invalid_argument);
  EXPECT_EQ(pyramid.levels(), 0);
  EXPECT_FALSE(pyramid.level(0).valid());
  EXPECT_EQ(pyramid.build(image.view(), 0), tp::Status::invalid_argument);
  EXPECT_EQ(pyramid.build(image.view(), tp::kMaxPyramidLevels + 1), tp::Status::invalid_argument);
  EXPECT_EQ(pyramid.build({image.data(), 16, 16, 15}, 2), tp::Status::invalid_argument);
  EXPECT_EQ(pyramid.build({image.data(), 16, 0}, 2), tp::Status::invalid_argument);
  EXPECT_EQ(pyramid.build({nullptr, 16, 16}, 2), tp::Status::invalid_argument);
  EXPECT_EQ(static_cast<tp::PyramidView>(pyramid).levels, 0);
}

TEST(PyramidView, HoldsTheLevelsAndNothingBeyond) {
  const tp::Image<std::uint8_t> image = ramp(32, 32);
  const tp::Pyramid pyramid(image.view(), 3);
  const tp::PyramidView view = pyramid;
  EXPECT_EQ(view.levels, 3);
  for (std::size_t l = 0; l < 3; ++l) EXPECT_EQ(view.level[l].data(), pyramid.level(static_cast<int>(l)).data());
  EXPECT_FALSE(view.level[3].valid());
}

}  // namespace pyramid_test
