// Every derivative of the photometric reference against central differences and against a dual number.
#include <gtest/gtest.h>

#include <vector>

#include "photometry/scene.hpp"
#include "support/dual.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/photometry/residual_autodiff.hpp"

namespace tp = textplane;
using textplane_test::Dual;
using textplane_test::Scene;
using textplane_test::unknowns;
using tp::Normalisation;
using tp::PerturbationSide;

namespace residual_jacobian_test {

template <int P>
using Rows = Eigen::Matrix<double, Eigen::Dynamic, P, Eigen::RowMajor>;

constexpr unsigned kSeeds = 6;
constexpr Normalisation kNormalisations[] = {Normalisation::exact, Normalisation::frozen};

// theta and T_t_h after a step of (v, omega, theta).
template <class S>
struct Relative {
  tp::Vector3<S> theta;
  tp::SE3<S> T_t_h;
};
template <class S, class T>
Relative<S> step9(const Scene<T>& scene, const Eigen::Matrix<S, 9, 1>& p) {
  const tp::Vector6<S> xi = p.template head<6>();
  return {scene.theta.template cast<S>() + p.template tail<3>(), tp::se3_exp<S>(xi) * scene.T_t_h.template cast<S>()};
}
// The same after a step of (xi_h, xi_t, theta).
template <class S, class T>
Relative<S> step15(const Scene<T>& scene, const Eigen::Matrix<S, 15, 1>& p, PerturbationSide side) {
  const tp::SE3<S> host = tp::se3_exp<S>(tp::Vector6<S>(p.template head<6>()));
  const tp::SE3<S> target = tp::se3_exp<S>(tp::Vector6<S>(p.template segment<6>(6)));
  const tp::SE3<S> T_w_h = scene.T_w_h.template cast<S>(), T_w_t = scene.T_w_t.template cast<S>();
  const bool left = side == PerturbationSide::left;
  const tp::SE3<S> h = left ? host * T_w_h : T_w_h * host, t = left ? target * T_w_t : T_w_t * target;
  return {scene.theta.template cast<S>() + p.template tail<3>(), t.inverse() * h};
}

// The residuals at a step, mean and s held where `frozen` says so.
template <class S, class T>
std::vector<S> residuals_at(const Scene<T>& scene, const Relative<S>& at, const std::uint8_t* visible,
                            const tp::IntensityStats* frozen) {
  std::vector<S> r(scene.x.size());
  EXPECT_EQ(tp::reference::residuals_t(scene.input(), at.theta, at.T_t_h, visible, frozen, r.data()), tp::Status::ok);
  return r;
}

// Jacobian of `step` (parameters -> Relative) by central differences of fourth order. A radian moves a pixel by
// hundreds of pixels and the norm of the intensities bends on the scale of one: the second-order stencil is off by h^2
// 1e4 relatively.
template <int P, class T, class Step>
Rows<P> by_differences(const Scene<T>& scene, const Step& step, const std::uint8_t* visible,
                       const tp::IntensityStats* frozen) {
  Rows<P> J(scene.n(), P);
  const double h = 5e-6;
  for (int j = 0; j < P; ++j) {
    const auto at = [&](double distance) {
      Eigen::Matrix<double, P, 1> p = Eigen::Matrix<double, P, 1>::Zero();
      p[j] = distance;
      return residuals_at<double>(scene, step(p), visible, frozen);
    };
    const auto far_plus = at(2 * h), plus = at(h), minus = at(-h), far_minus = at(-2 * h);
    for (std::size_t i = 0; i < plus.size(); ++i)
      J(static_cast<Eigen::Index>(i), j) = (8 * (plus[i] - minus[i]) - (far_plus[i] - far_minus[i])) / (12 * h);
  }
  return J;
}

// The same by a dual number.
template <int P, class T, class Step>
Rows<P> by_dual(const Scene<T>& scene, const Step& step, const std::uint8_t* visible,
                const tp::IntensityStats* frozen) {
  Eigen::Matrix<Dual<P>, P, 1> p;
  for (int j = 0; j < P; ++j) p[j] = Dual<P>(0.0, j);
  const auto r = residuals_at<Dual<P>>(scene, step(p), visible, frozen);
  Rows<P> J(scene.n(), P);
  for (int i = 0; i < scene.n(); ++i)
    for (int j = 0; j < P; ++j) J(i, j) = r[static_cast<std::size_t>(i)].v[static_cast<std::size_t>(j)];
  return J;
}

// Each column to `tolerance` of its largest entry.
template <class A, class B>
void expect_columns_near(const A& actual, const B& expected, double tolerance, const char* what) {
  ASSERT_EQ(actual.cols(), expected.cols());
  for (Eigen::Index j = 0; j < expected.cols(); ++j) {
    const double scale = expected.col(j).cwiseAbs().maxCoeff();
    ASSERT_GT(scale, 1e-3) << what << ": column " << j << " is zero and proves nothing";
    EXPECT_LT((actual.col(j) - expected.col(j)).cwiseAbs().maxCoeff() / scale, tolerance) << what << ", column " << j;
  }
}

template <class T>
class ResidualJacobian : public testing::Test {};
using PixelTypes = testing::Types<std::uint8_t, float>;
TYPED_TEST_SUITE(ResidualJacobian, PixelTypes, );

template <int P, class T>
void check_rows(Scene<T>& scene, Normalisation normalisation) {
  tp::PhotometricOptions options;
  options.normalisation = normalisation;
  std::vector<double> r(scene.x.size());
  Rows<P> J(scene.n(), P);
  const tp::ResidualSummary summary =
      tp::reference::residuals<unknowns<P>()>(scene.request(options), scene.workspace, r.data(), J.data());
  ASSERT_EQ(summary.status, tp::Status::ok);
  ASSERT_EQ(summary.visible, scene.n());
  const std::vector<std::uint8_t> visible(scene.workspace.visible(), scene.workspace.visible() + scene.n());
  tp::IntensityStats held;
  held.mean = summary.mean;
  held.s = summary.s;
  const tp::IntensityStats* frozen = normalisation == Normalisation::frozen ? &held : nullptr;

  const auto same = residuals_at<double>(scene, {scene.theta, scene.T_t_h}, visible.data(), nullptr);
  for (std::size_t i = 0; i < r.size(); ++i) ASSERT_NEAR(r[i], same[i], 1e-13);

  const auto step = [&](const auto& p) { return step9<typename std::decay_t<decltype(p)>::Scalar>(scene, p); };
  const Rows<9> differences = by_differences<9>(scene, step, visible.data(), frozen);
  const Rows<9> dual = by_dual<9>(scene, step, visible.data(), frozen);
  const int first = P == 3 ? 6 : 0;
  expect_columns_near(J, differences.middleCols(first, P), 1e-6, "differences");
  expect_columns_near(J, dual.middleCols(first, P), 1e-11, "dual");
}

TYPED_TEST(ResidualJacobian, RowsOfPosePlaneAndBoth) {
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    Scene<TypeParam> scene(seed);
    for (const Normalisation normalisation : kNormalisations) {
      check_rows<6>(scene, normalisation);
      check_rows<3>(scene, normalisation);
      check_rows<9>(scene, normalisation);
    }
  }
}

// J^T W J and J^T W r from explicit rows, with Huber weights of r sqrt(N) written out here.
template <int P>
void explicit_sums(const Rows<P>& J, const std::vector<double>& r, double delta, Eigen::Matrix<double, P, P>* H,
                   Eigen::Matrix<double, P, 1>* b) {
  H->setZero();
  b->setZero();
  const double threshold = delta / std::sqrt(static_cast<double>(r.size()));
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double w = std::abs(r[i]) > threshold ? threshold / std::abs(r[i]) : 1.0;
    const Eigen::Matrix<double, P, 1> j = J.row(static_cast<Eigen::Index>(i)).transpose();
    *H += w * j * j.transpose();
    *b += w * r[i] * j;
  }
}

// Entry (i, j) of H relative to sqrt(H_ii H_jj), b_i relative to sqrt(H_ii sum w r^2).
template <int P>
void expect_sums_near(const tp::NormalEquations<P>& actual, const Eigen::Matrix<double, P, P>& H,
                      const Eigen::Matrix<double, P, 1>& b, double tolerance, const char* what) {
  const Eigen::Matrix<double, P, 1> d = H.diagonal().cwiseSqrt();
  ASSERT_GT(d.minCoeff(), 1e-3) << what;
  for (int i = 0; i < P; ++i) {
    for (int j = 0; j < P; ++j)
      EXPECT_LT(std::abs(actual.H(i, j) - H(i, j)) / (d[i] * d[j]), tolerance) << what << ' ' << i << ' ' << j;
    EXPECT_LT(std::abs(actual.b[i] - b[i]) / (d[i] * std::sqrt(actual.error)), tolerance) << what << ' ' << i;
  }
}

TYPED_TEST(ResidualJacobian, HostTargetAndPlaneFromBothSides) {
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    Scene<TypeParam> scene(seed);
    for (const Normalisation normalisation : kNormalisations)
      for (const PerturbationSide side : {PerturbationSide::left, PerturbationSide::right}) {
        tp::PhotometricOptions options;
        options.normalisation = normalisation;
        const tp::NormalEquations<15> sums = tp::reference::linearise<tp::Parameters::host_target_plane>(
            tp::world_request(scene.input(), scene.theta, scene.T_w_h, scene.T_w_t, side, options), scene.workspace);
        ASSERT_EQ(sums.status, tp::Status::ok);
        const std::vector<std::uint8_t> visible(scene.workspace.visible(), scene.workspace.visible() + scene.n());
        tp::IntensityStats held;
        held.mean = sums.mean;
        held.s = sums.s;
        const tp::IntensityStats* frozen = normalisation == Normalisation::frozen ? &held : nullptr;

        const auto step = [&](const auto& p) {
          return step15<typename std::decay_t<decltype(p)>::Scalar>(scene, p, side);
        };
        const auto r =
            residuals_at<double>(scene, {scene.theta, scene.T_w_t.inverse() * scene.T_w_h}, visible.data(), nullptr);
        Eigen::Matrix<double, 15, 15> H;
        Eigen::Matrix<double, 15, 1> b;
        explicit_sums(by_differences<15>(scene, step, visible.data(), frozen), r, options.robust.delta, &H, &b);
        expect_sums_near(sums, H, b, 1e-6, "differences");
        explicit_sums(by_dual<15>(scene, step, visible.data(), frozen), r, options.robust.delta, &H, &b);
        expect_sums_near(sums, H, b, 1e-10, "dual");
        EXPECT_EQ(sums.H, sums.H.transpose());
      }
  }
}

template <int P, class T>
tp::NormalEquations<P> linearise(Scene<T>& scene, const tp::PhotometricOptions& options) {
  return tp::reference::linearise<unknowns<P>()>(scene.request(options), scene.workspace);
}

template <int P, class T>
void check_sums(Scene<T>& scene, const tp::PhotometricOptions& options) {
  const tp::NormalEquations<P> sums = linearise<P>(scene, options);
  ASSERT_EQ(sums.status, tp::Status::ok);
  std::vector<double> r(scene.x.size());
  Rows<P> J(scene.n(), P);
  const tp::ResidualSummary summary =
      tp::reference::residuals<unknowns<P>()>(scene.request(options), scene.workspace, r.data(), J.data());
  Eigen::VectorXd w(scene.n());
  double cost = 0, error = 0;
  for (int i = 0; i < scene.n(); ++i) {
    const double r2 = r[static_cast<std::size_t>(i)] * r[static_cast<std::size_t>(i)];
    w[i] = options.robust.weight(scene.n() * r2);
    cost += options.robust.rho(scene.n() * r2) / scene.n();
    error += r2;
  }
  const Eigen::Matrix<double, P, P> H = J.transpose() * w.asDiagonal() * J;
  const Eigen::Matrix<double, P, 1> b =
      J.transpose() * w.asDiagonal() * Eigen::Map<const Eigen::VectorXd>(r.data(), scene.n());
  expect_sums_near(sums, H, b, 1e-12, "rows");
  EXPECT_EQ(sums.H, sums.H.transpose());
  EXPECT_NEAR(sums.cost, cost, 1e-13);
  EXPECT_NEAR(sums.error, error, 1e-13);
  EXPECT_NEAR(sums.zncc, 1 - error / 2, 1e-13);
  EXPECT_EQ(sums.visible, scene.n());
  EXPECT_EQ(sums.mean, summary.mean);
  EXPECT_EQ(sums.s, summary.s);
}

TYPED_TEST(ResidualJacobian, NormalEquationsAreTheSumsOfTheRows) {
  for (unsigned seed = 11; seed <= 13; ++seed) {
    Scene<TypeParam> scene(seed);
    for (const Normalisation normalisation : kNormalisations)
      for (const tp::RobustKind kind :
           {tp::RobustKind::l2, tp::RobustKind::huber, tp::RobustKind::cauchy, tp::RobustKind::tukey}) {
        tp::PhotometricOptions options;
        options.normalisation = normalisation;
        options.robust = {kind, 0.4};
        check_sums<3>(scene, options);
        check_sums<6>(scene, options);
        check_sums<9>(scene, options);
      }
  }
}

// b is half the gradient of the cost: through the robust function too.
TYPED_TEST(ResidualJacobian, RightHandSideIsHalfTheGradientOfTheCost) {
  for (unsigned seed = 21; seed <= 23; ++seed) {
    Scene<TypeParam> scene(seed);
    for (const tp::RobustKind kind : {tp::RobustKind::l2, tp::RobustKind::cauchy, tp::RobustKind::tukey}) {
      tp::PhotometricOptions options;
      options.robust = {kind, 0.7};
      const tp::NormalEquations<9> sums = linearise<9>(scene, options);
      const double h = 1e-5;
      for (int j = 0; j < 9; ++j) {
        Eigen::Matrix<double, 9, 1> p = Eigen::Matrix<double, 9, 1>::Zero();
        p[j] = h;
        const Relative<double> plus = step9<double>(scene, p), minus = step9<double>(scene, -p);
        const double rise = tp::reference::evaluate(tp::ResidualRequest{scene.input(), plus.theta, plus.T_t_h, options},
                                                    scene.workspace)
                                .cost -
                            tp::reference::evaluate(
                                tp::ResidualRequest{scene.input(), minus.theta, minus.T_t_h, options}, scene.workspace)
                                .cost;
        EXPECT_NEAR(sums.b[j], rise / (4 * h), 1e-6 * std::sqrt(sums.H(j, j) * sums.error));
      }
    }
  }
}

}  // namespace residual_jacobian_test
