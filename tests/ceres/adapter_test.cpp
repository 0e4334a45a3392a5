// The cost functions and the manifold of adapters/ceres.hpp against numeric differences.
#include "textplane/adapters/ceres.hpp"

#include <ceres/gradient_checker.h>
#include <ceres/product_manifold.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "photometry/scene.hpp"

namespace textplane_test {
namespace {

namespace ad = tp::adapters;
using ad::PoseOrder;
using ad::TextRows;

template <PoseOrder Order = PoseOrder::quaternion_translation>
std::array<double, 7> block(const tp::SE3d& T) {
  std::array<double, 7> out;
  ad::pose_to_block<Order>(T, out.data());
  return out;
}

constexpr double kDerivative = 1e-8;

// Half the sum of squares of another cost and its gradient, for which alone TextRows::sums has derivatives.
class HalfSquare : public ceres::CostFunction {
 public:
  explicit HalfSquare(const ceres::CostFunction& inner) : inner_(inner) {
    set_num_residuals(1);
    *mutable_parameter_block_sizes() = inner.parameter_block_sizes();
  }
  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    const int n = inner_.num_residuals();
    Eigen::VectorXd r(n);
    std::vector<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> J;
    std::vector<double*> rows;
    for (int size : parameter_block_sizes()) J.emplace_back(n, size);
    for (std::size_t k = 0; k < J.size(); ++k) rows.push_back(jacobians && jacobians[k] ? J[k].data() : nullptr);
    if (!inner_.Evaluate(blocks, r.data(), jacobians ? rows.data() : nullptr)) return false;
    residuals[0] = 0.5 * r.squaredNorm();
    for (std::size_t k = 0; k < J.size(); ++k)
      if (rows[k]) Eigen::Map<Eigen::VectorXd>(jacobians[k], J[k].cols()) = J[k].transpose() * r;
    return true;
  }

 private:
  const ceres::CostFunction& inner_;
};

// The largest difference between derivatives in the tangent space and numeric ones, relative to the largest of their
// block: some are zero, of which ceres::GradientChecker itself would ask the impossible.
double derivative_error(const ceres::CostFunction& cost, const std::vector<const double*>& blocks,
                        const std::vector<const ceres::Manifold*>& manifolds) {
  ceres::NumericDiffOptions numeric;
  numeric.ridders_relative_initial_step_size = 1e-5;  // Stays in a cell of the bilinear interpolant.
  numeric.max_num_ridders_extrapolations = 3;         // More of them, with ever smaller steps, differentiate rounding.
  const ceres::GradientChecker checker(&cost, &manifolds, numeric);
  ceres::GradientChecker::ProbeResults results;
  checker.Probe(blocks.data(), 1e-6, &results);
  EXPECT_TRUE(results.return_value);
  EXPECT_EQ(results.local_numeric_jacobians.size(), blocks.size());
  double error = 0;
  for (std::size_t k = 0; k < results.local_numeric_jacobians.size(); ++k) {
    const double scale = results.local_numeric_jacobians[k].cwiseAbs().maxCoeff();
    EXPECT_GT(scale, 0);
    error = std::max(error,
                     (results.local_jacobians[k] - results.local_numeric_jacobians[k]).cwiseAbs().maxCoeff() / scale);
  }
  return error;
}

struct CeresAdapter : testing::Test {
  Scene<std::uint8_t> scene{5};
  tp::PhotometricInput input = scene.input();
  ad::TextCostOptions options;
  ad::PoseManifold<> manifold;
  std::array<double, 7> host = block(scene.T_w_h), target = block(scene.T_w_t);

  CeresAdapter() {
    options.photometric.precise = true;
    options.photometric.robust.delta = 0.4;  // Some pixels on either side of it.
    options.weight = 0.7;
  }
  std::vector<const double*> blocks() const { return {host.data(), target.data(), scene.theta.data()}; }
};

TEST_F(CeresAdapter, PixelsHaveTheirDerivatives) {
  options.rows = TextRows::pixels;
  const std::vector<const ceres::Manifold*> all = {&manifold, &manifold, nullptr};
  EXPECT_LT(derivative_error(ad::TextCost<>(input, options), blocks(), all), kDerivative);
  EXPECT_LT(
      derivative_error(ad::TextPoseCost<>(input, scene.T_w_h, scene.theta, options), {target.data()}, {&manifold}),
      kDerivative);
  EXPECT_LT(derivative_error(ad::TextPlaneCost(input, scene.T_t_h, options), {scene.theta.data()}, {nullptr}),
            kDerivative);
}

TEST_F(CeresAdapter, PixelsHaveTheirDerivativesForEveryRobustCost) {
  options.rows = TextRows::pixels;
  for (tp::RobustKind kind : {tp::RobustKind::l2, tp::RobustKind::cauchy, tp::RobustKind::tukey}) {
    options.photometric.robust = {kind, 1.5};
    EXPECT_LT(derivative_error(ad::TextPlaneCost(input, scene.T_t_h, options), {scene.theta.data()}, {nullptr}),
              kDerivative);
  }
}

TEST_F(CeresAdapter, SumsHaveTheGradientOfTheirCost) {
  const std::vector<const ceres::Manifold*> all = {&manifold, &manifold, nullptr};
  const ad::TextCost<> three(input, options);
  const ad::TextPoseCost<> pose(input, scene.T_w_h, scene.theta, options);
  const ad::TextPlaneCost plane(input, scene.T_t_h, options);
  EXPECT_EQ(three.num_residuals(), 10);
  EXPECT_EQ(pose.num_residuals(), 7);
  EXPECT_EQ(plane.num_residuals(), 4);
  EXPECT_LT(derivative_error(HalfSquare(three), blocks(), all), kDerivative);
  EXPECT_LT(derivative_error(HalfSquare(pose), {target.data()}, {&manifold}), kDerivative);
  EXPECT_LT(derivative_error(HalfSquare(plane), {scene.theta.data()}, {nullptr}), kDerivative);
}

TEST_F(CeresAdapter, SumsAndPixelsAreOneCostAndAgreeWithTheNormalEquations) {
  const ad::TextCost<> sums(input, options);
  options.rows = TextRows::pixels;
  const ad::TextCost<> pixels(input, options);
  Eigen::Matrix<double, 10, 1> r;
  Eigen::VectorXd each(scene.n());
  Eigen::Matrix<double, 10, 7, Eigen::RowMajor> J;
  double* jacobians[3] = {nullptr, J.data(), nullptr};
  ASSERT_TRUE(sums.Evaluate(blocks().data(), r.data(), jacobians));
  ASSERT_TRUE(pixels.Evaluate(blocks().data(), each.data(), nullptr));
  const tp::NormalEquations<6> e = tp::linearise<tp::Parameters::pose>(
      tp::ResidualRequest{input, scene.theta, scene.T_t_h, options.photometric}, scene.workspace);
  const double factor = options.weight * tp::text_weight(options.weighting, 1, options.sigma_photo, e.visible);
  EXPECT_EQ(e.visible, scene.n());
  EXPECT_NEAR(r.squaredNorm(), factor * e.cost, 1e-12 * factor);
  EXPECT_NEAR(each.squaredNorm(), factor * e.cost, 1e-12 * factor);
  const Eigen::Matrix<double, 10, 6> rows = J * ad::block_by_perturbation(target.data());
  EXPECT_LT((rows.transpose() * rows - factor * e.H).norm(), 1e-9 * factor * e.H.norm());
  EXPECT_LT((rows.transpose() * r + factor * e.b).norm(), 1e-9 * factor * e.b.norm());
}

TEST_F(CeresAdapter, OtherOrderAndOtherManifold) {
  constexpr PoseOrder kOrder = PoseOrder::translation_quaternion;
  const std::array<double, 7> swapped = block<kOrder>(scene.T_w_t);
  EXPECT_EQ(swapped[6], target[3]);
  EXPECT_EQ(swapped[0], target[4]);
  const ad::PoseManifold<kOrder> own;
  options.rows = TextRows::pixels;
  const ad::TextPoseCost<kOrder> cost(input, scene.T_w_h, scene.theta, options);
  EXPECT_LT(derivative_error(cost, {swapped.data()}, {&own}), kDerivative);
  const ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>> other;
  EXPECT_LT(derivative_error(ad::TextPoseCost<>(input, scene.T_w_h, scene.theta, options), {target.data()}, {&other}),
            kDerivative);
}

TEST_F(CeresAdapter, PointHasItsDerivatives) {
  const tp::Vector3<double> p_w = scene.T_w_t * tp::Vector3<double>(0.3, -0.2, 2.5);
  EXPECT_LT(derivative_error(ad::PointCost<>(scene.target_camera, {100, 90}, 1.7), {target.data(), p_w.data()},
                             {&manifold, nullptr}),
            kDerivative);
  const tp::Vector3<double> behind = scene.T_w_t * tp::Vector3<double>(0.3, -0.2, -2.5);
  const double* blocks[2] = {target.data(), behind.data()};
  double r[2];
  EXPECT_FALSE(ad::PointCost<>(scene.target_camera, {100, 90}).Evaluate(blocks, r, nullptr));
}

TEST_F(CeresAdapter, ManifoldIsTheRightPerturbation) {
  tp::Vector6<double> xi;
  xi << 0.3, -0.2, 0.1, 0.5, -0.4, 0.7;
  std::array<double, 7> moved;
  ASSERT_TRUE(manifold.Plus(target.data(), xi.data(), moved.data()));
  const tp::SE3d expected = scene.T_w_t * tp::se3_exp(xi), T = ad::pose_from_block(moved.data());
  EXPECT_LT((T.R - expected.R).norm() + (T.t - expected.t).norm(), 1e-14);
  tp::Vector6<double> back;
  ASSERT_TRUE(manifold.Minus(moved.data(), target.data(), back.data()));
  EXPECT_LT((back - xi).norm(), 1e-13);

  Eigen::Matrix<double, 7, 6, Eigen::RowMajor> plus;
  Eigen::Matrix<double, 6, 7, Eigen::RowMajor> minus;
  ASSERT_TRUE(manifold.PlusJacobian(target.data(), plus.data()));
  ASSERT_TRUE(manifold.MinusJacobian(target.data(), minus.data()));
  EXPECT_LT((minus * plus - Eigen::Matrix<double, 6, 6>::Identity()).norm(), 1e-14);
  for (int k = 0; k < 6; ++k) {
    constexpr double kStep = 1e-6;
    std::array<double, 7> ahead, behind;
    tp::Vector6<double> step = tp::Vector6<double>::Zero();
    step[k] = kStep;
    manifold.Plus(target.data(), step.data(), ahead.data());
    step[k] = -kStep;
    manifold.Plus(target.data(), step.data(), behind.data());
    for (int i = 0; i < 7; ++i)
      EXPECT_NEAR(plus(i, k), (ahead[static_cast<std::size_t>(i)] - behind[static_cast<std::size_t>(i)]) / (2 * kStep),
                  1e-9);
  }
}

TEST_F(CeresAdapter, NoResultIsFalse) {
  tp::SE3d aside = scene.T_w_t;
  aside.t[0] += 100;
  const std::array<double, 7> away = block(aside);
  const double* blocks[3] = {host.data(), away.data(), scene.theta.data()};
  std::vector<double> r(static_cast<std::size_t>(scene.n()));
  for (TextRows rows : {TextRows::sums, TextRows::pixels}) {
    options.rows = rows;
    EXPECT_FALSE(ad::TextCost<>(input, options).Evaluate(blocks, r.data(), nullptr));
  }
}

}  // namespace
}  // namespace textplane_test
