// The texts of a TextMap in a problem of Ceres.
#include <gtest/gtest.h>

#include <ceres/solver.h>

#include "landmarks/text_map_support.hpp"
#include "textplane/adapters/ceres_text_map.hpp"

namespace text_map_test {
namespace {
namespace adapters = textplane::adapters;

constexpr int kLast = 7;

TEST_F(TextMapTest, BlocksLeadKeyFramesBack) {
  TextMap map(scene.camera);
  walk(map, kLast);
  // The last two key frames are off, one by twice as much. No point holds them.
  std::array<SE3d, 2> truth, start;
  std::array<std::array<double, 7>, 2> blocks;
  for (std::size_t k = 0; k < 2; ++k) {
    truth[k] = pose(kLast - static_cast<int>(k));
    start[k] = textplane::se3_exp<double>(Random(6).twist(0.004, 0.002) * (1.0 + static_cast<double>(k))) * truth[k];
    adapters::pose_to_block(start[k].inverse(), blocks[k].data());
  }
  const auto of = [&](int id) { return static_cast<std::size_t>(kLast - id); };
  map.move([&](int id) { return of(id) < 2 ? start[of(id)] : pose(id); });
  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  adapters::PoseManifold<> manifold;
  ceres::Problem problem(ownership);
  for (auto& block : blocks) problem.AddParameterBlock(block.data(), 7, &manifold);
  adapters::TextBlocks<> texts(
      map, [&](int id) { return of(id) < 2 ? blocks[of(id)].data() : nullptr; }, problem);
  EXPECT_EQ(texts.texts(), 3);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  ASSERT_TRUE(summary.IsSolutionUsable());
  for (std::size_t k = 0; k < 2; ++k) {
    const SE3d end = adapters::pose_from_block(blocks[k].data()).inverse();
    EXPECT_LT(shift(end, truth[k]), 0.1 * shift(start[k], truth[k])) << k;
  }
  const double before = largest_angle(map);
  texts.write_back();
  EXPECT_LT(largest_angle(map), before + 0.2) << "degrees";
}

TEST_F(TextMapTest, WeightsFollowTheScaleOfTheProblemsPoints) {
  const double sigma = 0.3;
  Random random(9);
  std::array<double, 7> pose_block;
  adapters::pose_to_block(SE3d{}, pose_block.data());
  std::vector<Vec3> points_w;
  for (int i = 0; i < 600; ++i)
    points_w.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(2, 4));
  ceres::Problem problem;
  const auto add = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Vec2 px = scene.camera.project(points_w[i]) + sigma * Vec2(random.normal(), random.normal());
      problem.AddResidualBlock(new adapters::PointCost<>(scene.camera, px), nullptr, pose_block.data(),
                               points_w[i].data());
    }
  };
  add(0, 19);
  EXPECT_EQ(adapters::point_scale(problem, 7), 7) << "too few";
  add(19, points_w.size());
  EXPECT_NEAR(adapters::point_scale(problem, 7), sigma, 0.1 * sigma);
}

// A host may name the block of every key frame that it has: only those that its problem moves are asked.
TEST_F(TextMapTest, BlocksThatTheProblemDoesNotMoveStay) {
  TextMap map(scene.camera);
  walk(map, kLast);
  std::array<std::array<double, 7>, kLast + 1> blocks;
  for (int id = 0; id <= kLast; ++id)
    adapters::pose_to_block(pose(id).inverse(), blocks[static_cast<std::size_t>(id)].data());
  const auto block_of = [&](int id) { return blocks[static_cast<std::size_t>(id)].data(); };
  ceres::Problem one, all;
  for (const int id : {kLast - 1, kLast}) all.AddParameterBlock(block_of(id), 7, new adapters::PoseManifold<>);
  one.AddParameterBlock(block_of(kLast), 7, new adapters::PoseManifold<>);
  all.SetParameterBlockConstant(block_of(kLast - 1));
  adapters::TextBlocks<> of_one(
      map, [&](int id) { return id == kLast ? block_of(id) : nullptr; }, one);
  adapters::TextBlocks<> of_all(map, block_of, all);
  EXPECT_EQ(of_one.texts(), 3);
  EXPECT_EQ(of_all.texts(), 3);
  EXPECT_EQ(all.NumResidualBlocks(), one.NumResidualBlocks());
  for (int id = 0; id < kLast - 1; ++id) EXPECT_FALSE(all.HasParameterBlock(block_of(id))) << id;
}

TEST_F(TextMapTest, ThePriorHasItsInformation) {
  textplane::TextObject text;
  text.theta = Vec3(0.1, -0.2, 0.5);
  textplane::Matrix3<double> root;
  root << 3, 0, 0, 1, 2, 0, -1, 0.5, 4;
  textplane::TextPrior prior;
  prior.text = &text;
  prior.information = root * root.transpose();
  const adapters::TextPriorCost cost(prior, 0.5);
  const Vec3 theta = text.theta + Vec3(0.01, 0.02, -0.03);
  const double* blocks[] = {theta.data()};
  Vec3 residual;
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> J;
  double* jacobians[] = {J.data()};
  ASSERT_TRUE(cost.Evaluate(blocks, residual.data(), jacobians));
  const Vec3 off = theta - text.theta;
  EXPECT_NEAR(residual.squaredNorm(), 0.25 * off.dot(prior.information * off), 1e-12);
  EXPECT_LT((J.transpose() * J - 0.25 * prior.information).norm(), 1e-12);
  EXPECT_LT((J * off - residual).norm(), 1e-12);
}

}  // namespace
}  // namespace text_map_test
