// Noisy images become as clear as is said, clear ones stay as they are, and limits of the ZNCC follow.
#include "textslam/input/noise_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "textplane/photometry/noise.hpp"
#include "textplane/photometry/zncc.hpp"

namespace textslam {
namespace noise_filter_test {

constexpr int kWidth = 320, kHeight = 240;

Image<std::uint8_t> noisy(double sigma, std::uint64_t seed = 3) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Image<std::uint8_t> image(kWidth, kHeight);
  for (int i = 0; i < kWidth * kHeight; ++i)
    image.data()[i] = static_cast<std::uint8_t>(std::lround(120 + sigma * normal(random)));
  return image;
}

double deviation(const ImageView8& image, int border) {
  double sum = 0, squares = 0, n = 0;
  for (int y = border; y < image.height() - border; ++y)
    for (int x = border; x < image.width() - border; ++x, ++n) {
      sum += image(x, y);
      squares += static_cast<double>(image(x, y)) * image(x, y);
    }
  return std::sqrt(squares / n - sum / n * sum / n);
}

Frame filtered(double sigma, const Parameters& parameters) {
  Image<std::uint8_t> image = noisy(sigma);
  Frame frame;
  smooth_noise(textplane::estimate_noise(image.view()).sigma, parameters, &image, &frame);
  frame.image = std::make_shared<const Pyramid>(image.view(), 4);
  return frame;
}

TEST(NoiseFilter, LeavesClearImagesAlone) {
  const Parameters parameters;
  Image<std::uint8_t> image = noisy(4);
  const Image<std::uint8_t> before = noisy(4);
  Frame frame;
  smooth_noise(4, parameters, &image, &frame);
  EXPECT_EQ(frame.smoothing, 0);
  EXPECT_EQ(frame.noise, 4);
  for (int i = 0; i < kWidth * kHeight; ++i) ASSERT_EQ(image.data()[i], before.data()[i]);
}

TEST(NoiseFilter, LeavesAboutTheNoiseThatItIsToLeave) {
  const Parameters parameters;
  for (const double sigma : {12.0, 20.0}) {
    const Frame frame = filtered(sigma, parameters);
    EXPECT_NEAR(frame.noise, parameters.most_noise, 0.12 * parameters.most_noise) << sigma;
    EXPECT_NEAR(deviation(frame.image->level(0), 4), frame.noise, 0.06 * frame.noise) << sigma;
  }
  // No more than the largest Gaussian.
  const Frame frame = filtered(35, parameters);
  EXPECT_EQ(frame.smoothing, parameters.most_smoothing);
  EXPECT_GT(frame.noise, parameters.most_noise);
}

TEST(NoiseFilter, KnowsTheNoiseOfEveryLevel) {
  const Parameters parameters;
  for (const double sigma : {4.0, 20.0}) {
    const Frame frame = filtered(sigma, parameters);
    for (int level = 0; level < 3; ++level) {
      const double known = deviation(frame.image->level(level), 2);
      const double rounding = std::sqrt((level + 1) / 12.0);
      EXPECT_NEAR(noise_on_level(frame, level), known, 0.08 * known + rounding * rounding / known)
          << sigma << ", level " << level;
    }
  }
}

TEST(ZnccLimit, IsThatOfClearImagesWithoutNoise) {
  const Parameters parameters;
  Frame a, b;
  a.noise = b.noise = parameters.clear_noise;
  EXPECT_FALSE(is_noisy(parameters, a, b));
  EXPECT_EQ(zncc_limit(parameters, 0.65, 0, a, 4, b, 4), 0.65);
  b.noise = parameters.clear_noise + 1e-6;
  EXPECT_TRUE(is_noisy(parameters, a, b));
  EXPECT_NEAR(zncc_limit(parameters, 0.65, 0, a, 10, b, 10), 0.65, 1e-6) << "no step";
}

TEST(ZnccLimit, FallsWithTheNoiseBeyondAndGrowsWithTheContrast) {
  const Parameters parameters;
  Frame a, b;
  a.noise = b.noise = 5;
  double last = 0;
  for (const double contrast : {8.0, 12.0, 20.0, 60.0}) {
    const double limit = zncc_limit(parameters, 0.65, 0, a, contrast, b, contrast);
    EXPECT_GT(limit, last);
    EXPECT_NEAR(limit, 0.65 * (1 - (25 - parameters.clear_noise * parameters.clear_noise) / (contrast * contrast)),
                1e-12);
    EXPECT_LT(zncc_limit(parameters, 0.65, 0, a, contrast, b, 0.5 * contrast), limit) << "a view of half the gain";
    last = limit;
  }
  EXPECT_NEAR(zncc_limit(parameters, 0.65, 0, a, 4, b, 4), 0.65 * parameters.least_expected_zncc, 1e-12);
  EXPECT_GT(zncc_limit(parameters, 0.65, 2, a, 8, b, 8), zncc_limit(parameters, 0.65, 0, a, 8, b, 8));
}

}  // namespace noise_filter_test
}  // namespace textslam
