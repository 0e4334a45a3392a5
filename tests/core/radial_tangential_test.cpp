#include "textplane/core/cameras/radial_tangential.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/calculus.hpp"

namespace tp = textplane;
using textplane_test::central_difference;
using textplane_test::Dual;
using textplane_test::dual_derivative;
using textplane_test::Random;
using textplane_test::relative_error;
using textplane_test::tolerance;
using textplane_test::values;

template struct textplane::RadialTangential<float>;
template struct textplane::RadialTangential<double>;
template struct textplane::RadialTangential<Dual<2>>;

namespace radial_tangential_test {

// A webcam, a wide lens with strong tangential terms, a pincushion, no lens.
const tp::RadialTangential<double> kLenses[] = {{{}, 0.23, -0.82, -0.005, 0.002, 0.97},
                                                {{}, -0.28, 0.07, 0.01, -0.008, -0.005},
                                                {{}, 0.12, 0.03, -0.002, 0.004, 0.01},
                                                {}};

template <class S>
class Lens : public testing::Test {};
using Scalars = testing::Types<float, double, Dual<2>>;
TYPED_TEST_SUITE(Lens, Scalars, );

TEST(RadialTangentialTest, DistortsAsWritten) {
  // One point by hand: x = 0.3, y = -0.2, r^2 = 0.13.
  const tp::RadialTangential<double> lens{{}, 0.1, -0.2, 0.01, -0.02, 0.3};
  const double radial = 1 + 0.1 * 0.13 - 0.2 * 0.13 * 0.13 + 0.3 * 0.13 * 0.13 * 0.13;
  const Eigen::Vector2d expected(0.3 * radial + 2 * 0.01 * 0.3 * -0.2 + -0.02 * (0.13 + 2 * 0.09),
                                 -0.2 * radial + 0.01 * (0.13 + 2 * 0.04) + 2 * -0.02 * 0.3 * -0.2);
  EXPECT_LT((lens.distort({0.3, -0.2}) - expected).norm(), 1e-16);
}

TEST(RadialTangentialTest, DistortJacobian) {
  Random random(3);
  for (const auto& lens : kLenses)
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector2d m = random.vector<2>(0.6);
      Eigen::Matrix2d J;
      lens.distort(m, &J);
      const auto f = [&](const auto& x) {
        using S = typename std::decay_t<decltype(x)>::Scalar;
        return tp::Vector2<S>(lens.template cast<S>().distort(x));
      };
      EXPECT_LT(relative_error(J, (central_difference<2, 2>(f, m))), 1e-10);
      EXPECT_LT(relative_error(J, (dual_derivative<2, 2>(f, m))), 1e-14);
    }
}

TYPED_TEST(Lens, UndistortInvertsDistort) {
  using S = TypeParam;
  for (const auto& lens : kLenses)
    for (double y = -0.45; y <= 0.45; y += 0.05)
      for (double x = -0.5; x <= 0.5; x += 0.05) {
        const tp::Vector2<S> m{S(x), S(y)};
        tp::Vector2<S> back = tp::Vector2<S>::Zero();
        ASSERT_EQ(lens.template cast<S>().undistort(lens.template cast<S>().distort(m), &back), tp::Status::ok);
        EXPECT_LT((values(back) - values(m)).norm(), tolerance<S>(2e-6, 1e-14));
      }
}

// The derivative of the inverse is the inverse of the derivative, at the fixed points of the lens too.
TEST(RadialTangentialTest, UndistortCarriesDerivatives) {
  Random random(4);
  for (const auto& lens : kLenses)
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector2d m = i == 0 ? Eigen::Vector2d::Zero() : random.vector<2>(0.5);
      Eigen::Matrix2d J;
      const Eigen::Vector2d distorted = lens.distort(m, &J);
      const auto f = [&](const auto& x) {
        using S = typename std::decay_t<decltype(x)>::Scalar;
        tp::Vector2<S> out = tp::Vector2<S>::Zero();
        EXPECT_EQ(lens.template cast<S>().undistort(x, &out), tp::Status::ok);
        return out;
      };
      EXPECT_LT(relative_error((dual_derivative<2, 2>(f, distorted)), Eigen::Matrix2d(J.inverse())), 1e-11);
      EXPECT_LT(relative_error((central_difference<2, 2>(f, distorted, 1e-5)), Eigen::Matrix2d(J.inverse())), 1e-9);
    }
  // r^2 = 0.1 is a fixed point of radial = 1 + 0.1 r^2 - r^4.
  const tp::RadialTangential<double> lens{{}, 0.1, -1, 0, 0, 0};
  const Eigen::Vector2d m(std::sqrt(0.1), 0);
  Eigen::Matrix2d J;
  ASSERT_LT((lens.distort(m, &J) - m).norm(), 1e-16);
  const auto f = [&](const auto& x) {
    using S = typename std::decay_t<decltype(x)>::Scalar;
    tp::Vector2<S> out = tp::Vector2<S>::Zero();
    EXPECT_EQ(lens.cast<S>().undistort(x, &out), tp::Status::ok);
    return out;
  };
  EXPECT_LT(relative_error((dual_derivative<2, 2>(f, m)), Eigen::Matrix2d(J.inverse())), 1e-13);
}

TEST(RadialTangentialTest, UndistortRefusesWhatHasNoInverse) {
  const Eigen::Vector2d untouched(7, 8);
  Eigen::Vector2d m = untouched;
  // Barrel so strong that r (1 - r^2) never exceeds 0.385: no point lands on r = 0.6.
  const tp::RadialTangential<double> folded{{}, -1, 0, 0, 0, 0};
  EXPECT_EQ(folded.undistort({0.6, 0}, &m), tp::Status::degenerate);
  EXPECT_EQ(m, untouched);
  EXPECT_EQ(folded.undistort({std::nan(""), 0}, &m), tp::Status::non_finite);
  EXPECT_EQ(m, untouched);
  const tp::RadialTangential<double> broken{{}, std::nan(""), 0, 0, 0, 0};
  EXPECT_FALSE(tp::is_ok(broken.undistort({0.1, 0}, &m)));
  EXPECT_EQ(m, untouched);
}

// r (1 - r^2) grows up to r = 1/sqrt(3).
TEST(RadialTangentialTest, TheDomainEndsWhereTheLensFolds) {
  const tp::RadialTangential<double> folded{{}, -1, 0, 0, 0, 0};
  EXPECT_TRUE(folded.in_domain({0, 1.154, 2}));
  EXPECT_FALSE(folded.in_domain({0, 1.156, 2}));
  EXPECT_TRUE(kLenses[3].in_domain({0, 1.156, 2}));
  // r (1 - r^4 / 5) and r (1 - r^6 / 7) grow up to r = 1.
  for (const tp::RadialTangential<double>& lens :
       {tp::RadialTangential<double>{{}, 0, -1. / 5, 0, 0, 0}, {{}, 0, 0, 0, 0, -1. / 7}}) {
    EXPECT_TRUE(lens.in_domain({0.999, 0, 1}));
    EXPECT_FALSE(lens.in_domain({1.001, 0, 1}));
  }
  // r (1 - r^2 / 2 + r^4 / 10) falls from r^2 = 1 to 2, and then takes the same values again.
  const tp::RadialTangential<double> wave{{}, -0.5, 0.1, 0, 0, 0};
  EXPECT_TRUE(wave.in_domain({0.999, 0, 1}));
  for (const double r : {1.001, 1.2, 1.5, 1.6, 3.0}) EXPECT_FALSE(wave.in_domain({r, 0, 1})) << r;
  Eigen::Vector2d m(7, 8);
  EXPECT_EQ(wave.undistort({0.61, 0}, &m), tp::Status::degenerate) << "r = 1.66 has it";
  EXPECT_EQ(m, Eigen::Vector2d(7, 8));
  ASSERT_EQ(wave.undistort({0, 0.59}, &m), tp::Status::ok);
  EXPECT_LT(m[1], 1);
}

TEST(RadialTangentialTest, IsPinhole) {
  EXPECT_TRUE(kLenses[3].is_pinhole());
  EXPECT_FALSE((tp::RadialTangential<double>{{}, 0, 0, 0, 0, 1e-9}).is_pinhole());
}

}  // namespace radial_tangential_test
