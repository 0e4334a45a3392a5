// The noise of pictures that were given it, and the ZNCC of simulated views.
#include "textplane/photometry/noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "textplane/photometry/zncc.hpp"

namespace tp = textplane;

namespace noise_test {

constexpr int kWidth = 320, kHeight = 240;

/// `light`(x, y) with white noise, as an 8-bit picture.
template <class Light>
std::vector<std::uint8_t> picture(double sigma, const Light& light) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      pixels.push_back(
          static_cast<std::uint8_t>(std::lround(std::clamp(light(x, y) + sigma * normal(random), 0.0, 255.0))));
  return pixels;
}

tp::NoiseEstimate estimate(const std::vector<std::uint8_t>& pixels, const tp::NoiseOptions& options = {}) {
  return tp::estimate_noise(tp::ImageView8(pixels.data(), kWidth, kHeight), options);
}

TEST(EstimateNoise, FindsWhiteNoiseOnEveryBrightness) {
  for (const double sigma : {1.0, 3.0, 8.0, 20.0})
    for (const double light : {80.0, 160.0}) {
      const tp::NoiseEstimate found = estimate(picture(sigma, [&](int, int) { return light; }));
      ASSERT_EQ(found.status, tp::Status::ok);
      EXPECT_GT(found.blocks, 60);
      const double known = std::hypot(sigma, std::sqrt(1.0 / 12));  // rounding to grey levels
      EXPECT_LT(found.sigma, 1.01 * known) << sigma;
      EXPECT_GT(found.sigma, 0.95 * known) << sigma;
    }
}

TEST(EstimateNoise, SlopesAndTextureOnMostOfTheImageAreNoNoise) {
  const auto light = [](int x, int y) {
    const double slope = 60 + 0.3 * x + 0.1 * y;
    return y < kHeight * 3 / 5 ? slope + (((x / 3) + (y / 3)) % 2 ? 40.0 : 0.0) : slope;
  };
  for (const double sigma : {2.0, 10.0}) {
    const double found = estimate(picture(sigma, light)).sigma;
    EXPECT_LT(found, 1.05 * std::hypot(sigma, std::sqrt(1.0 / 12)));
    EXPECT_GT(found, 0.94 * sigma);
  }
}

TEST(EstimateNoise, WhatIsCutOffDoesNotCount) {
  // The left half is black but for a few pixels, the right one is not.
  const auto light = [](int x, int) { return x < kWidth / 2 ? -10.0 : 100.0; };
  const tp::NoiseEstimate found = estimate(picture(20, light));
  EXPECT_NEAR(found.sigma, 20, 1);
  EXPECT_LT(found.blocks, 36);
  const tp::NoiseEstimate none = estimate(std::vector<std::uint8_t>(kWidth * kHeight, 255));
  EXPECT_EQ(none.status, tp::Status::too_few);
  EXPECT_EQ(none.sigma, 0);
}

TEST(EstimateNoise, AnEvenImageHasNone) {
  const tp::NoiseEstimate found = estimate(std::vector<std::uint8_t>(kWidth * kHeight, 90));
  EXPECT_EQ(found.status, tp::Status::ok);
  EXPECT_LT(found.sigma, 0.07);  // a bin of the histogram
}

// On a checkerboard of 128 +- a(y) the high-pass is 4 (a(y - 1) + 2 a(y) + a(y + 1)) everywhere. One row that is a grey
// level stronger adds 16 / 32 to its mean over a block. The estimates run past 128 grey levels, the histogram's end.
TEST(EstimateNoise, WhatIsBeyondTheHistogramIsInItsLastBin) {
  for (int stronger = 0; stronger <= 30; ++stronger) {
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < 34; ++y)
      for (int x = 0; x < 34; ++x) {
        const int a = y > 1 && y <= 1 + stronger ? 39 : 38;
        pixels.push_back(static_cast<std::uint8_t>((x + y) % 2 ? 128 + a : 128 - a));
      }
    const tp::NoiseEstimate found = tp::estimate_noise(tp::ImageView8(pixels.data(), 34, 34));
    ASSERT_EQ(found.blocks, 1);
    const double sigma = std::sqrt(std::acos(-1.0) / 2) * (16 * 38 + 0.5 * stronger) / 6;
    EXPECT_NEAR(found.sigma, std::min(sigma, 128.0), 1.0 / 16) << stronger;
  }
}

TEST(EstimateNoise, RefusesOptionsAndImagesThatMakeNoSense) {
  const std::vector<std::uint8_t> pixels(kWidth * kHeight, 90);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const int block : {7, 65, -1, std::numeric_limits<int>::max()}) {
    tp::NoiseOptions options;
    options.block = block;
    EXPECT_EQ(estimate(pixels, options).status, tp::Status::invalid_argument);
  }
  for (const double share : {-0.1, 1.1, kNaN}) {
    tp::NoiseOptions quantile, clipped;
    quantile.quantile = clipped.clipped = share;
    EXPECT_EQ(estimate(pixels, quantile).status, tp::Status::invalid_argument);
    EXPECT_EQ(estimate(pixels, clipped).status, tp::Status::invalid_argument);
  }
  EXPECT_EQ(tp::estimate_noise(tp::ImageView8()).status, tp::Status::invalid_argument);
  EXPECT_EQ(tp::estimate_noise(tp::ImageView8(pixels.data(), 33, 33)).status, tp::Status::too_few);
  EXPECT_EQ(tp::estimate_noise(tp::ImageView8(pixels.data(), 34, 34)).status, tp::Status::ok);
}

TEST(ExpectedZncc, IsTheMeanOfSimulatedViews) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  constexpr int kPixels = 225, kTrials = 2000;
  const double noise_a = 6, noise_b = 12, gain = 2, signal = 15;
  double zncc = 0, contrast_a = 0, contrast_b = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> a, b;
    for (int i = 0; i < kPixels; ++i) {
      const double light = signal * normal(random);
      a.push_back(90 + light + noise_a * normal(random));
      b.push_back(120 + gain * light + noise_b * normal(random));
    }
    zncc += tp::zncc(a.data(), b.data(), nullptr, kPixels) / kTrials;
    const double root = std::sqrt(static_cast<double>(kPixels));
    contrast_a += tp::intensity_stats(a.data(), nullptr, kPixels).s / root / kTrials;
    contrast_b += tp::intensity_stats(b.data(), nullptr, kPixels).s / root / kTrials;
  }
  EXPECT_NEAR(tp::expected_zncc(contrast_a, noise_a, contrast_b, noise_b), zncc, 0.003);
  // Equal views: 1 / (1 + noise^2 / signal^2), the contrast being the root of the sum of both squares.
  EXPECT_NEAR(tp::expected_zncc(std::hypot(3.0, 4.0), 3, std::hypot(3.0, 4.0), 3), 1 / (1 + 9.0 / 16), 1e-12);
}

TEST(ExpectedZncc, HasNoSurprises) {
  EXPECT_EQ(tp::expected_zncc(10, 0, 5, 0), 1);
  EXPECT_EQ(tp::expected_zncc(10, 10, 5, 0), 0);
  EXPECT_EQ(tp::expected_zncc(10, 0, 5, 6), 0);
  EXPECT_EQ(tp::expected_zncc(0, 0, 5, 1), 0);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_EQ(tp::expected_zncc(10, bad, 5, 1), 0);
    EXPECT_GE(tp::expected_zncc(bad, 1, 5, 1), 0);
  }
  EXPECT_EQ(tp::expected_zncc(kNaN, 1, 5, 1), 0);
}

}  // namespace noise_test
