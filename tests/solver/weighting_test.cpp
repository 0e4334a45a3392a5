// lambda_w against what each weighting promises: the printed ratio, and residuals of unit variance.
#include "textplane/solver/weighting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace weighting_test {

using textplane::is_finite;
using textplane::text_weight;
using textplane::valid_sigma;
using textplane::Weighting;

TEST(TextWeight, PaperIsThePrintedRatio) {
  EXPECT_DOUBLE_EQ(text_weight(Weighting::paper, 2.0, 0.5, 40), 4.0);
  EXPECT_DOUBLE_EQ(text_weight(Weighting::paper, 2.0, 0.5, 400), 4.0);
}

// N residuals of sigma_photo / sqrt(N) each cost what N reprojection errors of sigma_rep do: N sigma_rep^2.
TEST(TextWeight, VarianceMakesPixelsAndPointsComparable) {
  for (const int n : {15, 300}) {
    const double sigma_rep = 1.5, sigma_photo = 0.3, r = sigma_photo / std::sqrt(n);
    EXPECT_NEAR(text_weight(Weighting::variance, sigma_rep, sigma_photo, n) * n * r * r, n * sigma_rep * sigma_rep,
                1e-12 * n);
  }
}

TEST(TextWeight, ZeroForWhatIsNotPositive) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Weighting weighting : {Weighting::paper, Weighting::variance}) {
    EXPECT_EQ(text_weight(weighting, 0.0, 0.3, 40), 0.0);
    EXPECT_EQ(text_weight(weighting, 1.0, -0.3, 40), 0.0);
    EXPECT_EQ(text_weight(weighting, 1.0, nan, 40), 0.0);
    EXPECT_EQ(text_weight(weighting, 1.0, 0.3, 0), 0.0);
  }
}

TEST(ValidSigma, ItsSquareAndTheSquaresInverseAreNumbers) {
  for (const double sigma : {1e-50, 1.0, 1e50}) {
    EXPECT_TRUE(valid_sigma(sigma));
    EXPECT_TRUE(is_finite(1 / (sigma * sigma)));
    EXPECT_TRUE(is_finite(text_weight(Weighting::variance, sigma, 1e-50, 100)));
  }
  for (const double sigma : {0.0, -1.0, 1e-300, 1e300, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(valid_sigma(sigma));
    EXPECT_EQ(text_weight(Weighting::variance, sigma, 1, 100), 0);
    EXPECT_EQ(text_weight(Weighting::variance, 1, sigma, 100), 0);
  }
}

}  // namespace weighting_test
