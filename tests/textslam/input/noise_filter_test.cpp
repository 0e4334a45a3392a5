// Noisy images become as clear as is said, and clear ones stay as they are.
#include "textslam/input/noise_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "textplane/landmarks/text_noise.hpp"
#include "textplane/photometry/noise.hpp"

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

}  // namespace noise_filter_test
}  // namespace textslam
