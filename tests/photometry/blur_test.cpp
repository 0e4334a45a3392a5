#include "textplane/photometry/blur.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/noise.hpp"

namespace textplane {
namespace blur_test {

using textplane_test::noise;

Matrix2d covariance(double xx, double xy, double yy) {
  Matrix2d c;
  c << xx, xy, xy, yy;
  return c;
}

double least_eigenvalue(const Matrix2d& c) { return symmetric_eigen<double, 2>(c).values[0]; }

// The filter's definition, in double, pixel by pixel.
double filtered(const ImageView8& image, const BlurKernel& kernel, int x, int y) {
  double sum = 0;
  for (int dy = -kernel.radius(); dy <= kernel.radius(); ++dy)
    for (int dx = -kernel.radius(); dx <= kernel.radius(); ++dx)
      sum += static_cast<double>(kernel.at(dx, dy)) *
             image(std::clamp(x + dx, 0, image.width() - 1), std::clamp(y + dy, 0, image.height() - 1));
  return sum;
}

TEST(Blur, BothViewsEndWithTheSameBlurOnThePlane) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 200; ++i) {
    Matrix2d A;
    A << 1 + 0.6 * u(random), 0.5 * u(random), 0.5 * u(random), 1 + 0.6 * u(random);
    const double host = 0.2 + 0.2 * std::abs(u(random)), target = 0.3 + 0.3 * std::abs(u(random)), spread = 1.0 + i % 3;
    BlurMatch match;
    ASSERT_EQ(match_blur(A, host, target, spread, &match), Status::ok);
    EXPECT_GE(least_eigenvalue(match.host), (spread - 1) * host - 1e-12);
    EXPECT_GE(least_eigenvalue(match.target), (spread - 1) * target - 1e-12);
    const Matrix2d in_target = A * (match.host + host * Matrix2d::Identity()) * A.transpose();
    EXPECT_LT((in_target - match.target - target * Matrix2d::Identity()).norm(), 1e-12 * (1 + in_target.norm()));
    // No wider than it must be: along one direction at least, a view gets no more than the spread.
    if (spread == 1.0) {
      EXPECT_LT(std::min(least_eigenvalue(match.host), least_eigenvalue(match.target)), 1e-9);
    }
  }
}

TEST(Blur, TheNearerViewIsFilteredTheOtherLeftAsItIs) {
  BlurMatch match;
  ASSERT_EQ(match_blur(0.5 * Matrix2d::Identity(), 0.25, 0.25, 1.0, &match), Status::ok);
  EXPECT_LT((match.host - 0.75 * Matrix2d::Identity()).norm(), 1e-12);  // 0.25 target px^2 are 1 host px^2
  EXPECT_LT(match.target.norm(), 1e-12);
}

TEST(Blur, MatchReportsWhatItCannotDo) {
  BlurMatch match;
  match.host.setConstant(7);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(match_blur(covariance(1, 1, 1), 0.2, 0.2, 1, &match), Status::degenerate);
  EXPECT_EQ(match_blur(covariance(1, nan, 1), 0.2, 0.2, 1, &match), Status::non_finite);
  EXPECT_EQ(match_blur(Matrix2d::Identity(), nan, 0.2, 1, &match), Status::non_finite);
  EXPECT_EQ(match_blur(Matrix2d::Identity(), -0.1, 0.2, 1, &match), Status::invalid_argument);
  EXPECT_EQ(match_blur(Matrix2d::Identity(), 0.1, 0.2, 0.9, &match), Status::invalid_argument);
  EXPECT_EQ(match.host(0, 0), 7);
}

// Finite input beyond what squares of numbers hold: a status, never a covariance that is not finite, or is wrong.
TEST(Blur, MatchOfExtremesIsAStatus) {
  BlurMatch match;
  match.host.setConstant(7);
  Matrix2d A = Matrix2d::Identity();
  for (const double large : {1e101, 1e140, 1e154, 1e200, 1e308}) {
    A(0, 0) = large;
    EXPECT_EQ(match_blur(A, 0.2, 0.2, 1, &match), Status::degenerate) << large;
    EXPECT_EQ(match_blur(covariance(large, large / 2, large), 0.2, 0.2, 1, &match), Status::degenerate) << large;
    EXPECT_EQ(match_blur(covariance(1 / large, 0, large), 0.2, 0.2, 1, &match), Status::degenerate) << large;
  }
  EXPECT_EQ(match_blur(Matrix2d::Identity(), 1.7e308, 0.2, 2, &match), Status::non_finite);
  EXPECT_EQ(match_blur(Matrix2d::Identity(), 0.2, 1.7e308, 2, &match), Status::non_finite);
  EXPECT_EQ(match_blur(2 * Matrix2d::Identity(), 1.7e308, 0.2, 1, &match), Status::non_finite);
  EXPECT_EQ(match_blur(Matrix2d::Identity(), 0.2, 0.2, 1.7e308, &match), Status::ok);
  EXPECT_TRUE(all_finite(match.host) && all_finite(match.target));
  A(0, 0) = 1e99;
  ASSERT_EQ(match_blur(A, 0.2, 0.2, 1, &match), Status::ok);
  EXPECT_NEAR(match.target(0, 0) / (0.2 * 1e198), 1, 1e-12);
  EXPECT_NEAR(match.host(0, 0), 0, 1e-12);
}

// What squares do not hold is cut at kMaxVariance, too, along the axes that it has.
TEST(Blur, AKernelOfExtremesIsAFilter) {
  for (const double large : {1e12, 1e101, 1e154, 1e200, 1.7e308}) {
    const BlurKernel kernel(covariance(large, 0, 1)), wide(covariance(100, 0, 1));
    ASSERT_EQ(kernel.radius(), wide.radius()) << large;
    for (int y = -kernel.radius(); y <= kernel.radius(); ++y)
      for (int x = -kernel.radius(); x <= kernel.radius(); ++x) EXPECT_EQ(kernel.at(x, y), wide.at(x, y)) << large;
    const BlurKernel turned(covariance(large, -large, large)), ridge(covariance(100, -100, 100));
    ASSERT_EQ(turned.radius(), ridge.radius()) << large;
    EXPECT_NEAR(turned.at(2, -2), ridge.at(2, -2), 1e-6) << large;
    EXPECT_FLOAT_EQ(BlurKernel(covariance(-large, 0, -large)).at(0, 0), 1.0F) << large;
  }
}

TEST(Blur, AKernelHasTheCovarianceAskedFor) {
  for (const Matrix2d& wanted :
       {covariance(0.4, 0, 0.4), covariance(1, 0.3, 0.7), covariance(4, -1.5, 1.2), covariance(2, 0, 0.3)}) {
    const BlurKernel kernel(wanted);
    EXPECT_EQ(kernel.width(), 2 * kernel.radius() + 1);
    double sum = 0;
    Vector2<double> mean = Vector2<double>::Zero();
    Matrix2d second = Matrix2d::Zero();
    for (int y = -kernel.radius(); y <= kernel.radius(); ++y)
      for (int x = -kernel.radius(); x <= kernel.radius(); ++x) {
        const double w = kernel.at(x, y);
        const Vector2<double> p(x, y);
        sum += w;
        mean += w * p;
        second += w * p * p.transpose();
      }
    EXPECT_NEAR(sum, 1, 1e-6);
    EXPECT_LT(mean.norm(), 1e-6);
    EXPECT_LT((second - wanted).norm(), 0.06 * wanted.norm());  // cut at 2.7 standard deviations
  }
}

TEST(Blur, NoCovarianceIsNoFilter) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Matrix2d& none : {covariance(0, 0, 0), covariance(-1, 0, -2), covariance(nan, 0, 1)}) {
    const BlurKernel kernel(none);
    EXPECT_FLOAT_EQ(kernel.at(0, 0), 1.0F);
  }
  EXPECT_LE(BlurKernel(covariance(1e9, 0, 1e9)).radius(), BlurKernel::kMaxRadius);
}

TEST(Blur, ARegionIsFilteredAndTheRestIsLeft) {
  const Image<std::uint8_t> image = noise(61, 47, 5);
  const BlurKernel kernel(covariance(1.1, 0.4, 0.8));
  BlurFilter filter;
  const int rectangles[][4] = {{10, 12, 33, 30}, {-5, -5, 20, 9}, {50, 40, 70, 60}, {0, 0, 61, 47}, {3, 3, 4, 4}};
  for (const auto& r : rectangles) {
    Image<std::uint8_t> out(61, 47);
    std::fill_n(out.data(), 61 * 47, std::uint8_t{99});
    ASSERT_EQ(filter(image.view(), kernel, r[0], r[1], r[2], r[3], out.view()), Status::ok);
    for (int y = 0; y < 47; ++y)
      for (int x = 0; x < 61; ++x) {
        const bool inside = x >= r[0] && y >= r[1] && x < r[2] && y < r[3];
        ASSERT_NEAR(out(x, y), inside ? filtered(image.view(), kernel, x, y) : 99.0, inside ? 0.501 : 0.0)
            << x << ' ' << y;
      }
  }
  Image<std::uint8_t> other(60, 47);
  EXPECT_EQ(filter(image.view(), kernel, 0, 0, 9, 9, other.view()), Status::invalid_argument);
}

TEST(Blur, APatchTakesTheFilteredIntensities) {
  const Image<std::uint8_t> image = noise(61, 47, 6);
  const BlurKernel kernel(covariance(0.7, -0.2, 1.3));
  PatchLevel level;
  for (const auto& [x, y] : {std::pair<int, int>{5, 7}, {0, 0}, {60, 46}, {33, 20}, {61, 20}, {34, 20}}) {
    level.x.push_back(static_cast<float>(x));
    level.y.push_back(static_cast<float>(y));
    level.intensity.push_back(-1);
  }
  BlurFilter filter;
  ASSERT_EQ(filter(image.view(), kernel, &level), Status::ok);
  for (std::size_t i = 0; i < level.x.size(); ++i) {
    if (level.x[i] > 60) {
      EXPECT_EQ(level.intensity[i], -1);
      continue;
    }
    EXPECT_NEAR(level.intensity[i],
                filtered(image.view(), kernel, static_cast<int>(level.x[i]), static_cast<int>(level.y[i])), 1e-3);
  }
}

}  // namespace blur_test
}  // namespace textplane
