#include "textplane/photometry/local_contrast.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "support/noise.hpp"
#include "textplane/photometry/residual.hpp"

namespace textplane {
namespace local_contrast_test {

using textplane_test::noise;

// The definition, in double, pixel by pixel.
double expected(const ImageView8& image, const LocalContrastOptions& o, int x, int y) {
  double sum = 0, squares = 0, n = 0;
  for (int v = std::max(y - o.radius, 0); v <= std::min(y + o.radius, image.height() - 1); ++v)
    for (int u = std::max(x - o.radius, 0); u <= std::min(x + o.radius, image.width() - 1); ++u) {
      const double value = image(u, v);
      sum += value, squares += value * value, ++n;
    }
  const double mean = sum / n, variance = squares / n - mean * mean;
  return std::clamp(128 + o.scale * (image(x, y) - mean) / std::sqrt(variance + o.floor * o.floor), 0.0, 255.0);
}

TEST(LocalContrast, IsItsDefinitionUpToTheBorder) {
  const Image<std::uint8_t> image = noise(41, 33, 1);
  for (const int radius : {1, 6, LocalContrastOptions::kMaxRadius}) {
    LocalContrastOptions options;
    options.radius = radius;
    LocalContrast contrast(options);
    for (const auto& [x0, y0, width, height] : {std::array<int, 4>{0, 0, 41, 33}, {7, 5, 20, 9}, {40, 32, 1, 1}}) {
      Image<std::uint8_t> out(width, height);
      ASSERT_EQ(contrast(image.view(), x0, y0, out.view()), Status::ok);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          ASSERT_NEAR(out(x, y), expected(image.view(), options, x0 + x, y0 + y), 0.51)
              << x << ' ' << y << ' ' << radius;
    }
  }
}

// The memory of one image does for a wider one.
TEST(LocalContrast, GrowsWithItsImages) {
  LocalContrast contrast;
  for (const int width : {20, 31, 45, 70, 400}) {
    const Image<std::uint8_t> image = noise(width, 15, 7);
    Image<std::uint8_t> out(width, 15);
    ASSERT_EQ(contrast(image.view(), 0, 0, out.view()), Status::ok);
    for (int y = 0; y < 15; ++y)
      for (int x = 0; x < width; ++x) ASSERT_NEAR(out(x, y), expected(image.view(), {}, x, y), 0.51) << x << ' ' << y;
  }
}

TEST(LocalContrast, EvenPlacesAreGreyWhateverTheirBrightness) {
  for (const int grey : {0, 97, 255}) {
    const Image<std::uint8_t> image(30, 20, static_cast<std::uint8_t>(grey));
    Image<std::uint8_t> out(30, 20);
    LocalContrastOptions options;
    options.radius = LocalContrastOptions::kMaxRadius;
    ASSERT_EQ(LocalContrast(options)(image.view(), 0, 0, out.view()), Status::ok);
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 30; ++x) ASSERT_EQ(out(x, y), 128);
  }
}

// What it is for: half of the patch in the shade. On grey levels the shade's edge is most of what there is to see.
TEST(LocalContrast, TheEdgeOfAShadowHardlyLowersZncc) {
  const Image<std::uint8_t> sharp = noise(80, 40, 2);
  Image<std::uint8_t> light(80, 40), shaded(80, 40);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 80; ++x) {
      light(x, y) = static_cast<std::uint8_t>(100 + sharp(x / 3, y / 3) / 4);
      shaded(x, y) = static_cast<std::uint8_t>(x < 40 ? light(x, y) : light(x, y) / 4);
    }
  const Pinhole<double> camera{200, 200, 40, 20};
  const Quad<double> quad{{Vector2<double>(8, 8), {72, 8}, {72, 32}, {8, 32}}};
  std::vector<std::vector<Vector2<float>>> pixels(1);
  for (int y = 8; y <= 32; ++y)
    for (int x = 8; x <= 72; ++x) pixels[0].emplace_back(static_cast<float>(x), static_cast<float>(y));
  const Pyramid host(light.view(), 1), target(shaded.view(), 1);
  TextPatch patch = patch_from_pixels(host.view(), camera, quad, pixels);
  PhotometricWorkspace workspace(patch.max_pixels());
  const Vector3<double> theta = Vector3<double>::UnitZ();
  PhotometricInput in = photometric_input(patch, 0, target.view(), camera);
  const double grey = evaluate(ResidualRequest{in, theta}, workspace).zncc;

  LocalContrast contrast;
  Image<std::uint8_t> light_window(70, 30), shaded_window(70, 30);
  ASSERT_EQ(contrast(light.view(), 5, 5, light_window.view()), Status::ok);
  ASSERT_EQ(contrast(shaded.view(), 5, 5, shaded_window.view()), Status::ok);
  LocalContrast::take(light_window.view(), 5, 5, &patch.levels[0]);
  in = photometric_input(patch, 0, target.view(), camera);
  in.target = shaded_window.view();
  in.target_camera.cx -= 5;
  in.target_camera.cy -= 5;
  const PhotometricCost local = evaluate(ResidualRequest{in, theta}, workspace);
  ASSERT_TRUE(is_ok(local.status));
  EXPECT_EQ(local.visible, patch.max_pixels());
  EXPECT_LT(grey, 0.6);
  EXPECT_GT(local.zncc, 0.8);
}

TEST(LocalContrast, GradientsAreTakenAnewAndWhatIsOutsideStays) {
  const Image<std::uint8_t> image = noise(20, 20, 3);
  PatchLevel level;
  level.x = {6, 15};
  level.y = {7, 15};
  level.intensity = {1, 2};
  level.gx = level.gy = {3, 4};
  LocalContrast::take(ImageView8(image.data(), 10, 10, 20), 2, 2, &level);
  EXPECT_EQ(level.intensity[0], static_cast<float>(image(4, 5)));
  EXPECT_FLOAT_EQ(level.gx[0], 0.5F * static_cast<float>(image(5, 5) - image(3, 5)));
  EXPECT_FLOAT_EQ(level.gy[0], 0.5F * static_cast<float>(image(4, 6) - image(4, 4)));
  EXPECT_EQ(level.intensity[1], 2.0F);
  EXPECT_EQ(level.gx[1], 4.0F);
}

// Whatever its grey level: rounding of the mean is not contrast, at the smallest floor either.
TEST(LocalContrast, AFlatImageIsMiddleGrey) {
  for (const int level : {0, 1, 77, 100, 254, 255})
    for (const double floor : {0.01, 4.0, 1e6}) {
      const Image<std::uint8_t> image(40, 30, static_cast<std::uint8_t>(level));
      Image<std::uint8_t> out(40, 30);
      LocalContrastOptions options;
      options.floor = floor;
      ASSERT_EQ(LocalContrast(options)(image.view(), 0, 0, out.view()), Status::ok);
      for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) ASSERT_EQ(out(x, y), 128) << level << ' ' << floor << ' ' << x << ' ' << y;
    }
}

TEST(LocalContrast, RefusesWhatMakesNoSense) {
  const Image<std::uint8_t> image = noise(20, 20, 4);
  Image<std::uint8_t> out(10, 10, 7);
  LocalContrast contrast;
  EXPECT_EQ(contrast(image.view(), 11, 0, out.view()), Status::invalid_argument);
  EXPECT_EQ(contrast(image.view(), 0, -1, out.view()), Status::invalid_argument);
  EXPECT_EQ(contrast(ImageView8(), 0, 0, out.view()), Status::invalid_argument);
  EXPECT_EQ(contrast(image.view(), 0, 0, ImageView<std::uint8_t>()), Status::invalid_argument);
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    LocalContrastOptions options;
    options.floor = bad;
    EXPECT_EQ(LocalContrast(options)(image.view(), 0, 0, out.view()), Status::invalid_argument);
    options = {};
    options.scale = bad;
    EXPECT_EQ(LocalContrast(options)(image.view(), 0, 0, out.view()), Status::invalid_argument);
  }
  for (const double bad : {1e-25, 0.009, 1.1e6, 1e300, std::numeric_limits<double>::infinity()}) {
    LocalContrastOptions options;
    options.floor = bad;
    EXPECT_EQ(LocalContrast(options)(image.view(), 0, 0, out.view()), Status::invalid_argument);
    options = {};
    options.scale = std::max(bad, 1.1e6);
    EXPECT_EQ(LocalContrast(options)(image.view(), 0, 0, out.view()), Status::invalid_argument);
  }
  for (const int radius : {0, LocalContrastOptions::kMaxRadius + 1}) {
    LocalContrastOptions options;
    options.radius = radius;
    EXPECT_EQ(LocalContrast(options)(image.view(), 0, 0, out.view()), Status::invalid_argument);
  }
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x) ASSERT_EQ(out(x, y), 7);
}

}  // namespace local_contrast_test
}  // namespace textplane
