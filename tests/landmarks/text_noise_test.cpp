// Limits of the ZNCC follow the noise of the images.
#include "textplane/landmarks/text_noise.hpp"

#include <gtest/gtest.h>

namespace text_noise_test {

using namespace textplane;

TEST(ZnccLimit, IsThatOfClearImagesWithoutNoise) {
  const TextOptions options;
  ImageNoise a, b;
  a.noise = b.noise = options.clear_noise;
  EXPECT_FALSE(is_noisy(options, a, b));
  EXPECT_EQ(zncc_limit(options, 0.65, 0, a, 4, b, 4), 0.65);
  b.noise = options.clear_noise + 1e-6;
  EXPECT_TRUE(is_noisy(options, a, b));
  EXPECT_NEAR(zncc_limit(options, 0.65, 0, a, 10, b, 10), 0.65, 1e-6) << "no step";
}

TEST(ZnccLimit, FallsWithTheNoiseBeyondAndGrowsWithTheContrast) {
  const TextOptions options;
  ImageNoise a, b;
  a.noise = b.noise = 5;
  double last = 0;
  for (const double contrast : {8.0, 12.0, 20.0, 60.0}) {
    const double limit = zncc_limit(options, 0.65, 0, a, contrast, b, contrast);
    EXPECT_GT(limit, last);
    EXPECT_NEAR(limit, 0.65 * (1 - (25 - options.clear_noise * options.clear_noise) / (contrast * contrast)), 1e-12);
    EXPECT_LT(zncc_limit(options, 0.65, 0, a, contrast, b, 0.5 * contrast), limit) << "a view of half the gain";
    last = limit;
  }
  EXPECT_NEAR(zncc_limit(options, 0.65, 0, a, 4, b, 4), 0.65 * options.least_expected_zncc, 1e-12);
  EXPECT_GT(zncc_limit(options, 0.65, 2, a, 8, b, 8), zncc_limit(options, 0.65, 0, a, 8, b, 8));
}

}  // namespace text_noise_test
