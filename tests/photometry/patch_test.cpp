#include "textplane/photometry/patch.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "photometry/scene.hpp"
#include "textplane/photometry/photometric_input.hpp"

namespace tp = textplane;

namespace patch_test {

using Pixels = std::vector<std::vector<tp::Vector2<float>>>;

struct PatchFromPixels : testing::Test {
  PatchFromPixels() : image(textplane_test::texture<std::uint8_t>(64, 48, 3)), pyramid(image.view(), 3), pixels(2) {
    for (int i = 0; i < 20; ++i) pixels[0].emplace_back(static_cast<float>(10 + i), static_cast<float>(12 + i % 5));
    for (int i = 0; i < 6; ++i) pixels[1].emplace_back(static_cast<float>(5 + i) + 0.25f, 7.5f);
    quad.corner = {tp::Vector2<double>(10, 12), {30, 12}, {30, 17}, {10, 17}};
  }

  tp::Image<std::uint8_t> image;
  tp::Pyramid pyramid;
  Pixels pixels;
  tp::Quad<double> quad;
  tp::Pinhole<double> camera{60, 61, 31, 23};
};

TEST_F(PatchFromPixels, SamplesEachLevelInItsOwnPixels) {
  const tp::TextPatch patch = tp::patch_from_pixels(pyramid, camera, quad, pixels);
  ASSERT_EQ(patch.status, tp::Status::ok);
  ASSERT_EQ(patch.level_count(), 2);
  ASSERT_EQ(patch.levels[0].view().n, 20);
  ASSERT_EQ(patch.levels[1].view().n, 6);
  for (std::size_t l = 0; l < 2; ++l)
    for (std::size_t i = 0; i < pixels[l].size(); ++i) {
      double expected;
      ASSERT_TRUE(tp::sample_bilinear(pyramid.level(static_cast<int>(l)), static_cast<double>(pixels[l][i][0]),
                                      static_cast<double>(pixels[l][i][1]), &expected));
      EXPECT_EQ(patch.levels[l].x[i], pixels[l][i][0]);
      EXPECT_EQ(patch.levels[l].y[i], pixels[l][i][1]);
      EXPECT_NEAR(patch.levels[l].intensity[i], expected, 1e-4);
    }
  EXPECT_EQ(patch.camera.cx, 31);
  EXPECT_EQ(patch.quad.corner[2][0], 30);
}

TEST_F(PatchFromPixels, DropsPixelsOutsideAndNaN) {
  pixels[0].emplace_back(64.0f, 3.0f);
  pixels[0].emplace_back(-0.5f, 3.0f);
  pixels[0].emplace_back(3.0f, std::numeric_limits<float>::quiet_NaN());
  const tp::TextPatch patch = tp::patch_from_pixels(pyramid, camera, quad, pixels);
  EXPECT_EQ(patch.status, tp::Status::ok);
  EXPECT_EQ(patch.levels[0].view().n, 20);
}

TEST_F(PatchFromPixels, IgnoresLevelsThatTheHostLacks) {
  pixels.resize(6, pixels[1]);
  EXPECT_EQ(tp::patch_from_pixels(pyramid, camera, quad, pixels).level_count(), 3);
}

TEST_F(PatchFromPixels, Refusals) {
  pixels[0].resize(14);
  EXPECT_EQ(tp::patch_from_pixels(pyramid, camera, quad, pixels).status, tp::Status::too_few);
  EXPECT_EQ(tp::patch_from_pixels(pyramid, camera, quad, pixels, 14).status, tp::Status::ok);
  EXPECT_EQ(tp::patch_from_pixels(pyramid, camera, quad, Pixels(2), 0).status, tp::Status::too_few);
  EXPECT_EQ(tp::patch_from_pixels(pyramid, camera, quad, {}).status, tp::Status::invalid_argument);
  EXPECT_EQ(tp::patch_from_pixels(tp::PyramidView(), camera, quad, pixels).status, tp::Status::invalid_argument);
  EXPECT_EQ(tp::patch_from_pixels(pyramid, {0, 60, 31, 23}, quad, pixels).status, tp::Status::invalid_argument);
  quad.corner[1][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(tp::patch_from_pixels(pyramid, camera, quad, pixels).status, tp::Status::non_finite);
}

TEST_F(PatchFromPixels, InputOfALevelHasThatLevelsCameras) {
  const tp::TextPatch patch = tp::patch_from_pixels(pyramid, camera, quad, pixels);
  const tp::Pinhole<double> target_camera(70, 72, 30, 20);
  const tp::PhotometricInput in = tp::photometric_input(patch, 1, pyramid, target_camera);
  EXPECT_EQ(in.patch.n, 6);
  EXPECT_EQ(in.target.width(), 32);
  EXPECT_EQ(in.host_camera.fx, 30);
  EXPECT_EQ(in.host_camera.cx, 15.25);
  EXPECT_EQ(in.target_camera.fy, 36);
  for (const int level : {-1, 2, 9}) {
    EXPECT_EQ(tp::photometric_input(patch, level, pyramid, target_camera).patch.x, nullptr);
  }
}

TEST_F(PatchFromPixels, ScaleShiftPairsLevelsOfOneScale) {
  const tp::TextPatch patch = tp::patch_from_pixels(pyramid, camera, quad, pixels);
  const tp::PhotometricInput larger = tp::photometric_input(patch, 0, pyramid, camera, 1);
  EXPECT_EQ(larger.host_camera.fx, camera.fx);
  EXPECT_EQ(larger.target_camera.fx, camera.fx / 2);
  EXPECT_EQ(larger.target.width(), pyramid.level(1).width());
  const tp::PhotometricInput smaller = tp::photometric_input(patch, 0, pyramid, camera, -1);
  EXPECT_EQ(smaller.patch.n, patch.levels[1].view().n);
  EXPECT_EQ(smaller.host_camera.fx, camera.fx / 2);
  EXPECT_EQ(smaller.target_camera.fx, camera.fx);
  for (const int shift : {-99, -2, 9, 99}) {
    EXPECT_EQ(tp::photometric_input(patch, 0, pyramid, camera, shift).patch.x, nullptr);
  }
}

TEST(ScaleShift, IsTheDifferenceOfScalesInOctaves) {
  EXPECT_EQ(tp::scale_shift(100, 100), 0);
  EXPECT_EQ(tp::scale_shift(100, 190), 0);
  EXPECT_EQ(tp::scale_shift(100, 210), 1);
  EXPECT_EQ(tp::scale_shift(400, 100), -1);
  EXPECT_EQ(tp::scale_shift(100, 6400), 1);
  EXPECT_EQ(tp::scale_shift(100, 6400, 3), 3);
  EXPECT_EQ(tp::scale_shift(6400, 100, 2), -2);
  for (const double bad :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(tp::scale_shift(bad, 100), 0);
    EXPECT_EQ(tp::scale_shift(100, bad), 0);
  }
}

}  // namespace patch_test
