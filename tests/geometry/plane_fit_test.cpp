#include "textplane/geometry/plane_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "geometry/plane_fit_scene.hpp"
#include "support/calculus.hpp"
#include "support/dense.hpp"
#include "textplane/geometry/homography.hpp"

namespace tp = textplane;
using textplane_test::central_difference;
using textplane_test::Dual;
using textplane_test::dual_derivative;
using textplane_test::relative_error;
using textplane_test::tolerance;
using textplane_test::value;
using textplane_test::values;

#define TEXTPLANE_INSTANTIATE(S)                                                                             \
  template struct tp::PlaneFit<S>;                                                                           \
  template tp::PlaneFit<S> tp::plane_from_inverse_depths<S>(const tp::Vector3<S>*, const S*, const S*, int); \
  template tp::PlaneFit<S> tp::plane_from_matches<S>(const tp::Vector3<S>*, const tp::Vector3<S>*, int,      \
                                                     const tp::SE3<S>&, const S*);                           \
  template tp::PlaneFit<S> tp::plane_from_points<S>(const tp::Vector3<S>*, int, const S*);
TEXTPLANE_INSTANTIATE(float)
TEXTPLANE_INSTANTIATE(double)
TEXTPLANE_INSTANTIATE(Dual<6>)
#undef TEXTPLANE_INSTANTIATE

namespace plane_fit_test {

template <class S>
class PlaneFits : public testing::Test {};
TYPED_TEST_SUITE(PlaneFits, Scalars, );

TYPED_TEST(PlaneFits, ExactDataGiveThetaBack) {
  using S = TypeParam;
  Random random(1);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const Scene<S> scene = make_scene<S>(random, repeat % 2 == 0 ? 3 : 20);
    const auto by_depth = tp::plane_from_inverse_depths(scene.host, scene.rho);
    const auto by_match = tp::plane_from_matches(scene.host, scene.target, scene.T_t_h);
    const auto by_point = tp::plane_from_points(scene.points);
    for (const auto& fit : {by_depth, by_match, by_point}) {
      if (fit.condition > S(1000)) continue;  // three random points can lie almost on a line
      EXPECT_EQ(fit.status, tp::Status::ok) << repeat;
      EXPECT_EQ(fit.rank, 3);
      EXPECT_GE(value(fit.condition), 1);
      // float input is rounded to 6e-8, which the system amplifies by its condition and, for matches, by 1 / parallax.
      EXPECT_LT((values(fit.value) - scene.theta).norm(), tolerance<S>(0.02, 1e-10)) << repeat;
      EXPECT_LT(value(fit.sigma), tolerance<S>(3e-6, 1e-13));
    }
  }
}

TEST(PlaneFitTest, ExactRecoveryIsNotOnlyForWellShapedSigns) {
  Random random(2);
  for (int repeat = 0; repeat < 50; ++repeat) {
    // A line of small print: 0.2 rad long, 0.002 rad high.
    const auto scene = make_scene<double>(random, 30, 0.1, 0.001);
    const auto by_depth = tp::plane_from_inverse_depths(scene.host, scene.rho);
    const auto by_match = tp::plane_from_matches(scene.host, scene.target, scene.T_t_h);
    EXPECT_GT(by_depth.condition, 500);
    EXPECT_LT((by_depth.value - scene.theta).norm(), 1e-10);
    EXPECT_LT((by_match.value - scene.theta).norm(), 1e-10);
    EXPECT_LT((tp::plane_from_points(scene.points).value - scene.theta).norm(), 1e-10);
  }
}

// Condition of a design matrix from its normal matrix, by Eigen.
double condition_of(const Eigen::Matrix3d& normal) {
  const Vector3d e = textplane_test::symmetric_eigenvalues(normal);
  return std::sqrt(e[2] / e[0]);
}

// The printed rows [m'_i]x t m~_i^T theta = -[m'_i]x R m~_i, solved by Eigen's QR, agree on exact data.
TEST(PlaneFitTest, AgreesWithThePrintedSystem) {
  Random random(3);
  const auto scene = make_scene<double>(random, 12);
  Eigen::Matrix<double, 36, 3> A;
  Eigen::Matrix<double, 36, 1> b;
  for (int i = 0; i < 12; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Eigen::Matrix3d mx = tp::hat(scene.target[k]);
    A.middleRows<3>(3 * i) = mx * scene.T_t_h.t * scene.host[k].transpose();
    b.segment<3>(3 * i) = -mx * scene.T_t_h.R * scene.host[k];
  }
  const Vector3d theta = textplane_test::dense_solve(A, b);
  const auto fit = tp::plane_from_matches(scene.host, scene.target, scene.T_t_h);
  EXPECT_LT((fit.value - theta).norm(), 1e-11);
  EXPECT_NEAR(fit.condition, condition_of(A.transpose() * A), 1e-6 * fit.condition);
}

TEST(PlaneFitTest, ConditionIsThatOfTheWeightedDesign) {
  Random random(4);
  const auto scene = make_scene<double>(random, 9);
  std::vector<double> weight;
  Eigen::Matrix<double, 9, 3> A;
  for (std::size_t i = 0; i < 9; ++i) {
    weight.push_back(random.uniform(0.2, 5));
    A.row(static_cast<Eigen::Index>(i)) = std::sqrt(weight[i]) * scene.host[i].transpose();
  }
  const auto fit = tp::plane_from_inverse_depths(scene.host.data(), scene.rho.data(), weight.data(), 9);
  EXPECT_NEAR(fit.condition, condition_of(A.transpose() * A), 1e-9 * fit.condition);
  EXPECT_LT(relative_error(fit.covariance, Eigen::Matrix3d((A.transpose() * A).inverse())), 1e-9);
}

// Statistics of `draws` noisy fits: the covariance that each reports must be the covariance that they have. E[e^T C^-1
// e] = 3 with standard error sqrt(6 / draws) = 0.0245, so 0.1 is four of them; the sample covariance, whitened by the
// reported one, is the identity with standard errors sqrt(2 / draws) = 0.014 on and 0.01 off the diagonal.
template <class Fit>
void check_covariance(const Vector3d& truth, const Fit& fit_noisy, int degrees) {
  constexpr int kDraws = 10000;
  Eigen::Matrix3d sample = Eigen::Matrix3d::Zero();
  Vector3d mean = Vector3d::Zero();
  double mahalanobis = 0, chi2 = 0;
  Eigen::Matrix3d reported = Eigen::Matrix3d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    const tp::PlaneFit<double> fit = fit_noisy();
    ASSERT_EQ(fit.status, tp::Status::ok);
    const Vector3d e = fit.value - truth;
    mahalanobis += e.dot(fit.covariance.llt().solve(e)) / kDraws;
    sample += e * e.transpose() / kDraws;
    mean += e / kDraws;
    reported += fit.covariance / kDraws;
    chi2 += fit.sigma * fit.sigma / kDraws;
  }
  EXPECT_NEAR(mahalanobis, 3, 0.1);
  const Eigen::Matrix3d L = reported.llt().matrixL(), inverse = L.inverse();
  const Eigen::Matrix3d ratio = inverse * sample * inverse.transpose();
  EXPECT_LT((ratio - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.06) << ratio;
  EXPECT_LT((inverse * mean).cwiseAbs().maxCoeff(), 0.05) << "bias in standard deviations";
  // sigma^2 estimates the variance of unit weight: 1, with standard error sqrt(2 / (degrees * draws)).
  EXPECT_NEAR(chi2, 1, 4.5 * std::sqrt(2.0 / (degrees * kDraws)));
}

// Ten thousand draws each; every measurement has its own variance.
TEST(PlaneFitCovariance, InverseDepths) {
  Random random(5);
  const auto scene = make_scene<double>(random, 15);
  std::vector<double> sigma, weight;
  for (std::size_t i = 0; i < scene.host.size(); ++i) {
    sigma.push_back(random.uniform(0.002, 0.01));
    weight.push_back(1 / (sigma[i] * sigma[i]));
  }
  check_covariance(
      scene.theta,
      [&] {
        auto rho = scene.rho;
        for (std::size_t i = 0; i < rho.size(); ++i) rho[i] += sigma[i] * random.normal();
        return tp::plane_from_inverse_depths(scene.host.data(), rho.data(), weight.data(), 15);
      },
      15 - 3);
}

TEST(PlaneFitCovariance, Matches) {
  Random random(6);
  for (int geometry = 0; geometry < 3; ++geometry) {
    auto scene = make_scene<double>(random, 25, 0.15, 0.1);
    // Sideways, forward, and both with a large turn: the depth of the target points then varies much.
    scene.T_t_h = tp::SE3d();
    if (geometry == 0) scene.T_t_h.t = Vector3d(0.3, 0.05, 0);
    if (geometry == 1) scene.T_t_h.t = Vector3d(0.1, 0.1, -0.3);
    if (geometry == 2) scene.T_t_h = {tp::so3_exp<double>({0.1, -0.4, 0.2}), Vector3d(0.4, -0.1, 0.1)};
    std::vector<double> sigma, weight;
    for (std::size_t i = 0; i < scene.host.size(); ++i) {
      sigma.push_back(random.uniform(0.0003, 0.001));
      weight.push_back(1 / (sigma[i] * sigma[i]));
      const Vector3d q = scene.T_t_h * scene.points[i];
      ASSERT_GT(q[2], 0.1);
      scene.target[i] = q / q[2];
    }
    SCOPED_TRACE(geometry);
    check_covariance(
        scene.theta,
        [&] {
          auto target = scene.target;
          for (std::size_t i = 0; i < target.size(); ++i) {
            target[i][0] += sigma[i] * random.normal();
            target[i][1] += sigma[i] * random.normal();
          }
          return tp::plane_from_matches(scene.host.data(), target.data(), 25, scene.T_t_h, weight.data());
        },
        2 * 25 - 3);
  }
}

TEST(PlaneFitCovariance, Points) {
  Random random(7);
  const auto scene = make_scene<double>(random, 20, 0.3, 0.2);
  std::vector<double> sigma, weight;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    sigma.push_back(random.uniform(0.002, 0.006));
    weight.push_back(1 / (sigma[i] * sigma[i]));
  }
  check_covariance(
      scene.theta,
      [&] {
        auto p = scene.points;
        for (std::size_t i = 0; i < p.size(); ++i)
          for (int k = 0; k < 3; ++k) p[i][k] += sigma[i] * random.normal();
        return tp::plane_from_points(p.data(), 20, weight.data());
      },
      20 - 3);
}

// The fit of noisy matches is the minimum of the target reprojection error: its gradient vanishes there.
TEST(PlaneFitTest, MatchesMinimiseTheReprojectionError) {
  Random random(8);
  for (int repeat = 0; repeat < 10; ++repeat) {
    auto scene = make_scene<double>(random, 12, 0.2, 0.15);
    scene.T_t_h.t = Vector3d(0.3, -0.1, 0.1);
    for (std::size_t i = 0; i < 12; ++i) {
      const Vector3d q = scene.T_t_h * scene.points[i];
      scene.target[i] = q / q[2] + Vector3d(0.0005 * random.normal(), 0.0005 * random.normal(), 0);
    }
    const auto cost = [&](const Vector3d& theta) {
      Eigen::Matrix<double, 1, 1> sum = Eigen::Matrix<double, 1, 1>::Zero();
      for (std::size_t i = 0; i < 12; ++i) {
        Eigen::Vector2d m = Eigen::Vector2d::Zero();
        EXPECT_EQ(tp::warp_point(theta, scene.T_t_h, scene.host[i], &m), tp::Status::ok);
        sum[0] += (m - scene.target[i].head<2>()).squaredNorm();
      }
      return sum;
    };
    const auto fit = tp::plane_from_matches(scene.host, scene.target, scene.T_t_h);
    ASSERT_EQ(fit.status, tp::Status::ok);
    // Distance to the stationary point, in standard deviations of theta.
    const Vector3d gradient = central_difference<1, 3>(cost, fit.value, 1e-4).transpose();
    const Vector3d step = fit.covariance * gradient / 2;
    EXPECT_LT(std::sqrt(step.dot(fit.covariance.llt().solve(step))) / 0.0005, 1e-3);
  }
}

// Dual numbers pass through each fit: d theta by the measurements of two of the matches.
TEST(PlaneFitTest, DualsThroughTheFits) {
  Random random(15);
  for (int repeat = 0; repeat < 10; ++repeat) {
    const auto scene = make_scene<double>(random, 8, 0.2, 0.15);
    const auto lift = [](const std::vector<Vector3d>& v, const auto& delta) {
      using S = typename std::decay_t<decltype(delta)>::Scalar;
      std::vector<tp::Vector3<S>> out;
      for (const auto& x : v) out.push_back(x.cast<S>());
      for (int k = 0; k < 6; ++k) out[static_cast<std::size_t>(k / 2)][k % 2] += delta[k];
      return out;
    };
    const auto by_depth = [&](const auto& delta) {
      using S = typename std::decay_t<decltype(delta)>::Scalar;
      const std::vector<S> rho(scene.rho.begin(), scene.rho.end());
      return tp::Vector3<S>(tp::plane_from_inverse_depths(lift(scene.host, delta), rho).value);
    };
    const auto by_match = [&](const auto& delta) {
      using S = typename std::decay_t<decltype(delta)>::Scalar;
      const auto zero = Eigen::Matrix<S, 6, 1>(Eigen::Matrix<S, 6, 1>::Zero());
      return tp::Vector3<S>(
          tp::plane_from_matches(lift(scene.host, zero), lift(scene.target, delta), tp::SE3<S>(scene.T_t_h.cast<S>()))
              .value);
    };
    const auto by_point = [&](const auto& delta) {
      using S = typename std::decay_t<decltype(delta)>::Scalar;
      return tp::Vector3<S>(tp::plane_from_points(lift(scene.points, delta)).value);
    };
    const Eigen::Matrix<double, 6, 1> zero = Eigen::Matrix<double, 6, 1>::Zero();
    EXPECT_LT(relative_error((dual_derivative<3, 6>(by_depth, zero)), (central_difference<3, 6>(by_depth, zero, 1e-6))),
              1e-6);
    EXPECT_LT(relative_error((dual_derivative<3, 6>(by_match, zero)), (central_difference<3, 6>(by_match, zero, 1e-6))),
              1e-6);
    EXPECT_LT(relative_error((dual_derivative<3, 6>(by_point, zero)), (central_difference<3, 6>(by_point, zero, 1e-6))),
              1e-6);
  }
}

}  // namespace plane_fit_test
