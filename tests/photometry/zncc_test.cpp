#include "textplane/photometry/zncc.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "photometry/scene.hpp"

namespace tp = textplane;
using textplane_test::Random;

namespace zncc_test {

TEST(IntensityStats, MeanAndNormOfTheCounted) {
  const std::vector<double> values = {1, 2, 1000, 3, 6};
  const std::vector<std::uint8_t> mask = {1, 255, 0, 1, 1};
  const tp::IntensityStats stats = tp::intensity_stats(values.data(), mask.data(), 5);
  ASSERT_EQ(stats.status, tp::Status::ok);
  EXPECT_EQ(stats.n, 4);
  EXPECT_EQ(stats.mean, 3);
  EXPECT_DOUBLE_EQ(stats.s, std::sqrt(4.0 + 1 + 0 + 9));
}

TEST(IntensityStats, NormalisedIntensitiesHaveZeroMeanAndUnitNorm) {
  Random random(1);
  std::vector<float> values;
  for (int i = 0; i < 200; ++i) values.push_back(static_cast<float>(random.uniform(20, 200)));
  const tp::IntensityStats stats = tp::intensity_stats(values.data(), nullptr, 200);
  double sum = 0, squares = 0;
  for (const float v : values) {
    const double normalised = (static_cast<double>(v) - stats.mean) / stats.s;
    sum += normalised;
    squares += normalised * normalised;
  }
  EXPECT_NEAR(sum, 0, 1e-13);
  EXPECT_NEAR(squares, 1, 1e-13);
}

TEST(IntensityStats, Refusals) {
  const std::vector<float> flat(20, 0.1f);
  const std::vector<std::uint8_t> none(20, 0);
  EXPECT_EQ(tp::intensity_stats(flat.data(), nullptr, 20).status, tp::Status::no_contrast);
  EXPECT_EQ(tp::intensity_stats(flat.data(), none.data(), 20).status, tp::Status::too_few);
  EXPECT_EQ(tp::intensity_stats(flat.data(), nullptr, 0).status, tp::Status::too_few);
  EXPECT_EQ(tp::intensity_stats(flat.data(), nullptr, 20, 21).status, tp::Status::too_few);
  EXPECT_EQ(tp::intensity_stats(flat.data(), nullptr, -1).status, tp::Status::invalid_argument);
  EXPECT_EQ(tp::intensity_stats<float>(nullptr, nullptr, 3).status, tp::Status::invalid_argument);
  EXPECT_EQ(tp::intensity_stats<float>(nullptr, nullptr, 0).status, tp::Status::too_few);

  std::vector<double> values = {1, 3, 1, 3};  // sigma 1
  EXPECT_EQ(tp::intensity_stats(values.data(), nullptr, 4, 4, 0.999).status, tp::Status::ok);
  EXPECT_EQ(tp::intensity_stats(values.data(), nullptr, 4, 4, 1.0).status, tp::Status::no_contrast);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200}) {
    values[2] = bad;
    const tp::IntensityStats stats = tp::intensity_stats(values.data(), nullptr, 4);
    EXPECT_EQ(stats.status, tp::Status::non_finite);
    EXPECT_EQ(stats.mean, 0);
    EXPECT_EQ(stats.s, 0);
  }
}

TEST(Zncc, IsOneUnderGainAndBiasAndMinusOneUnderInversion) {
  Random random(2);
  std::vector<double> a, b, c;
  for (int i = 0; i < 50; ++i) {
    a.push_back(random.uniform(0, 255));
    b.push_back(0.7 * a.back() + 31);
    c.push_back(200 - 1.3 * a.back());
  }
  EXPECT_NEAR(tp::zncc(a.data(), b.data(), nullptr, 50), 1, 1e-14);
  EXPECT_NEAR(tp::zncc(a.data(), c.data(), nullptr, 50), -1, 1e-14);
}

TEST(Zncc, IsOneMinusHalfTheSquaredDistance) {
  Random random(3);
  std::vector<float> a;
  std::vector<std::uint8_t> b, mask;
  for (int i = 0; i < 80; ++i) {
    a.push_back(static_cast<float>(random.uniform(0, 255)));
    b.push_back(static_cast<std::uint8_t>(random.integer(0, 255)));
    mask.push_back(static_cast<std::uint8_t>(random.integer(0, 2)));
  }
  const tp::IntensityStats sa = tp::intensity_stats(a.data(), mask.data(), 80);
  const tp::IntensityStats sb = tp::intensity_stats(b.data(), mask.data(), 80);
  double e = 0;
  for (std::size_t i = 0; i < 80; ++i) {
    if (!mask[i]) continue;
    const double r = (static_cast<double>(a[i]) - sa.mean) / sa.s - (b[i] - sb.mean) / sb.s;
    e += r * r;
  }
  tp::Status status;
  EXPECT_NEAR(tp::zncc(a.data(), b.data(), mask.data(), 80, &status), 1 - e / 2, 1e-14);
  EXPECT_EQ(status, tp::Status::ok);
}

TEST(Zncc, ZeroAndAStatusWhereUndefined) {
  const std::vector<double> flat(10, 7.0), steps = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  tp::Status status = tp::Status::ok;
  EXPECT_EQ(tp::zncc(flat.data(), steps.data(), nullptr, 10, &status), 0);
  EXPECT_EQ(status, tp::Status::no_contrast);
  EXPECT_EQ(tp::zncc(steps.data(), flat.data(), nullptr, 10, &status), 0);
  EXPECT_EQ(status, tp::Status::no_contrast);
  EXPECT_EQ(tp::zncc(steps.data(), flat.data(), nullptr, 0, &status), 0);
  EXPECT_EQ(status, tp::Status::too_few);
}

}  // namespace zncc_test
