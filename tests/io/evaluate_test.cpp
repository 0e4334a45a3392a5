#include "io/evaluate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/random_similarity.hpp"

namespace textslam {
namespace io_evaluate_test {

using random_similarity::Random;
using random_similarity::Vector;
using textplane::so3_exp;

StampedPose at(double time, const Vector& t, const Matrix3<double>& R = Matrix3<double>::Identity()) {
  StampedPose pose;
  pose.timestamp = time;
  pose.T_w_c = {R, t};
  return pose;
}

std::vector<StampedPose> wandering(Random& random, int n) {
  std::vector<StampedPose> poses;
  SE3d pose;
  for (int i = 0; i < n; ++i) {
    poses.push_back({i / 30.0, pose});
    textplane::Vector6<double> xi;
    xi << random.vector(0.05) + Vector(0.02, 0, 0.03), random.vector(0.1);
    pose = pose * textplane::se3_exp(xi);
  }
  return poses;
}

TEST(Associate, ClosestFirstOneToOne) {
  const Vector zero = Vector::Zero();
  const auto pairs = associate({at(0.000, zero), at(0.013, zero), at(0.100, zero), at(0.300, zero)},
                               {at(0.010, zero), at(0.105, zero), at(0.200, zero), at(0.301, zero)}, 0.02);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[0].estimate, 1u);  // 3 ms beats the 10 ms of the first
  EXPECT_EQ(pairs[0].truth, 0u);
  EXPECT_EQ(pairs[1].estimate, 2u);
  EXPECT_EQ(pairs[1].truth, 1u);
  EXPECT_EQ(pairs[2].estimate, 3u);
  EXPECT_EQ(pairs[2].truth, 3u);
}

TEST(Associate, TimeRunsForwardsOnBothSides) {
  const Vector zero = Vector::Zero();
  // 0.000 with 0.001 is the closest pair; the leftovers 0.010 and -0.010 would cross it.
  const auto pairs = associate({at(0.000, zero), at(0.010, zero)}, {at(-0.010, zero), at(0.001, zero)}, 0.05);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].estimate, 0u);
  EXPECT_EQ(pairs[0].truth, 1u);
  EXPECT_TRUE(associate({}, {at(0, zero)}, 1).empty());
  EXPECT_TRUE(associate({at(0, zero)}, {}, 1).empty());
}

TEST(ErrorStatistics, ByHand) {
  const ErrorStatistics s = error_statistics({3, 1, 2, 4});
  EXPECT_EQ(s.n, 4u);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(30.0 / 4));
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.max, 4);
  EXPECT_DOUBLE_EQ(error_statistics({5, 1, 2}).median, 2);
  EXPECT_EQ(error_statistics({}).n, 0u);
  EXPECT_EQ(error_statistics({}).rmse, 0);
}

TEST(Evaluate, AnySimilarityOfTheTruthIsPerfect) {
  Random random(17);
  for (int trial = 0; trial < 20; ++trial) {
    const auto truth = wandering(random, 60);
    const Similarity world = random.similarity();  // true world -> the estimate's
    std::vector<StampedPose> estimate;
    for (const StampedPose& pose : truth) estimate.push_back({pose.timestamp, world * pose.T_w_c});
    const TrajectoryEvaluation e = evaluate_trajectory(estimate, truth, 60);
    ASSERT_EQ(e.status, Status::ok);
    EXPECT_EQ(e.pairs, 60u);
    EXPECT_EQ(e.coverage, 1);
    EXPECT_NEAR(e.alignment.scale * world.scale, 1, 1e-12);
    EXPECT_LT((e.alignment.t - inverse(world).t).norm(), 1e-9);
    EXPECT_LT(e.ate.max, 1e-11);
    EXPECT_EQ(e.rpe_frame.translation.n, 59u);
    EXPECT_LT(e.rpe_frame.translation.max, 1e-11);
    EXPECT_LT(e.rpe_frame.rotation.max, 1e-5);
    EXPECT_GT(e.rpe_distance.translation.n, 20u);
    EXPECT_LT(e.rpe_distance.translation.max, 1e-11);
  }
}

// Corners of a square of side 2; the estimate lifts two opposite corners by 0.3 and lowers the others, which no
// similarity can undo.
TEST(Evaluate, AbsoluteErrorByHand) {
  const std::vector<StampedPose> truth = {at(0, {-1, -1, 0}), at(1, {1, -1, 0}), at(2, {1, 1, 0}), at(3, {-1, 1, 0})};
  std::vector<StampedPose> estimate = truth;
  for (std::size_t i = 0; i < 4; ++i) estimate[i].T_w_c.t[2] = i % 2 == 0 ? 0.3 : -0.3;
  EvaluationOptions options;
  options.with_scale = false;
  const TrajectoryEvaluation rigid = evaluate_trajectory(estimate, truth, 8, options);
  ASSERT_EQ(rigid.status, Status::ok);
  EXPECT_NEAR(rigid.ate.rmse, 0.3, 1e-12);
  EXPECT_NEAR(rigid.ate.median, 0.3, 1e-12);
  EXPECT_NEAR(rigid.ate.max, 0.3, 1e-12);
  EXPECT_EQ(rigid.coverage, 0.5);
  EXPECT_DOUBLE_EQ(rigid.path_length, 6);
  EXPECT_NEAR(rigid.rpe_frame.translation.rmse, 0.6, 1e-12);

  // Umeyama: scale = sum to.from / sum from^2 = 8 / (8 + 4 * 0.09); what is left a corner is 2 (1 - scale).
  const TrajectoryEvaluation scaled = evaluate_trajectory(estimate, truth, 4);
  const double scale = 8 / 8.36;
  EXPECT_NEAR(scaled.alignment.scale, scale, 1e-12);
  EXPECT_NEAR(scaled.ate.rmse, std::sqrt(2 * (1 - scale)), 1e-12);
}

// An excerpt is measured by its own path, not by that of a truth that goes on.
TEST(Evaluate, PathIsThatOfTheExcerpt) {
  Random random(5);
  const auto truth = wandering(random, 40);
  const std::vector<StampedPose> excerpt(truth.begin() + 10, truth.begin() + 20);
  double walked = 0;
  for (std::size_t i = 11; i < 20; ++i) walked += (truth[i].T_w_c.t - truth[i - 1].T_w_c.t).norm();
  EXPECT_NEAR(evaluate_trajectory(excerpt, truth, 10).path_length, walked, 1e-12);
}

TEST(Evaluate, RelativeErrorsByHand) {
  // Along x in steps of 0.04 m. From pose 5 on, the estimate is turned by 2 degrees about the direction of travel: all
  // motions keep their translation, and each that spans the turn has a rotation that is off by 2 degrees.
  std::vector<StampedPose> truth, estimate;
  const Matrix3<double> turn = so3_exp<double>({2 / 57.295779513082320877, 0, 0});
  for (int i = 0; i < 10; ++i) {
    truth.push_back(at(0.1 * i, {0.04 * i, 0, 0}));
    estimate.push_back(at(0.1 * i, {0.04 * i, 0, 0}, i < 5 ? Matrix3<double>::Identity() : turn));
  }
  EvaluationOptions options;
  options.with_scale = false;
  const TrajectoryEvaluation e = evaluate_trajectory(estimate, truth, 10, options);
  ASSERT_EQ(e.status, Status::ok);
  EXPECT_NEAR(e.path_length, 0.36, 1e-12);
  EXPECT_NEAR(e.frame_interval, 0.1, 1e-12);
  ASSERT_EQ(e.rpe_frame.rotation.n, 9u);
  EXPECT_NEAR(e.rpe_frame.rotation.max, 2, 1e-9);
  EXPECT_NEAR(e.rpe_frame.rotation.rmse, 2 / 3.0, 1e-9);  // sqrt(4 / 9)
  EXPECT_NEAR(e.rpe_frame.rotation.median, 0, 1e-5);
  EXPECT_LT(e.rpe_frame.translation.max, 1e-12);
  // 0.1 m is reached three steps on: pairs (0,3) ... (6,9), of which (2,5), (3,6), (4,7) span the turn.
  ASSERT_EQ(e.rpe_distance.rotation.n, 7u);
  EXPECT_NEAR(e.rpe_distance.rotation.rmse, std::sqrt(3 * 4 / 7.0), 1e-9);
}

TEST(Evaluate, RelativeTranslationUsesTheAlignedScale) {
  // The estimate lives at half scale, and one of its steps is short by 0.01 m of truth.
  std::vector<StampedPose> truth, estimate;
  for (int i = 0; i < 21; ++i) {
    const double angle = 0.3 * i;
    const Vector place(std::cos(angle), std::sin(angle), 0.1 * i);
    truth.push_back(at(i, place));
    estimate.push_back(at(i, 0.5 * (i < 20 ? place : Vector(place - Vector(0, 0, 0.01)))));
  }
  const TrajectoryEvaluation e = evaluate_trajectory(estimate, truth, 21);
  ASSERT_EQ(e.status, Status::ok);
  EXPECT_NEAR(e.alignment.scale, 2, 0.01);
  EXPECT_NEAR(e.rpe_frame.translation.max, 0.01, 1e-3);
}

TEST(Evaluate, FramesBesideGapsAreNotNeighbours) {
  Random random(4);
  const auto truth = wandering(random, 40);
  std::vector<StampedPose> estimate(truth.begin(), truth.begin() + 10);
  estimate.insert(estimate.end(), truth.begin() + 25, truth.end());
  const TrajectoryEvaluation e = evaluate_trajectory(estimate, truth, 40);
  EXPECT_EQ(e.pairs, 25u);
  EXPECT_EQ(e.rpe_frame.translation.n, 23u);
  EXPECT_DOUBLE_EQ(e.coverage, 25 / 40.0);
  EXPECT_NEAR(e.frame_interval, 1 / 30.0, 1e-12);
}

TEST(Evaluate, TruthAtEveryFourthFrame) {
  Random random(9);
  const auto estimate = wandering(random, 41);
  std::vector<StampedPose> truth;
  for (std::size_t i = 0; i < estimate.size(); i += 4) truth.push_back(estimate[i]);
  const TrajectoryEvaluation e = evaluate_trajectory(estimate, truth, 41);
  EXPECT_EQ(e.pairs, 11u);
  EXPECT_EQ(e.rpe_frame.translation.n, 10u);
  EXPECT_NEAR(e.frame_interval, 4 / 30.0, 1e-12);
  EXPECT_LT(e.ate.max, 1e-12);
}

TEST(Evaluate, NothingToCompare) {
  Random random(6);
  const auto truth = wandering(random, 10);
  TrajectoryEvaluation e = evaluate_trajectory({}, truth, 10);
  EXPECT_EQ(e.status, Status::too_few);
  EXPECT_EQ(e.coverage, 0);
  EXPECT_EQ(e.path_length, 0);
  e = evaluate_trajectory(truth, {}, 10);
  EXPECT_EQ(e.status, Status::too_few);
  EXPECT_EQ(e.coverage, 1);
  EXPECT_EQ(e.path_length, 0);
  EXPECT_EQ(evaluate_trajectory({}, {}, 0).status, Status::too_few);
  auto standing = truth;
  for (StampedPose& pose : standing) pose.T_w_c.t = {1.0 / 3, 2, 3};
  e = evaluate_trajectory(standing, truth, 10);
  EXPECT_EQ(e.status, Status::degenerate);
  EXPECT_EQ(e.ate.n, 0u);
}

}  // namespace io_evaluate_test
}  // namespace textslam
