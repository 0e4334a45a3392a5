// What is stated of poses against their errors.
#include "textslam/report/evaluate_poses.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "textslam/scene_support.hpp"

namespace textslam {
namespace evaluate_poses_test {

using namespace scene_support;

// A walk whose map is the truth moved, turned and scaled, with key frames every ten frames.
class EvaluatePosesTest : public testing::Test {
 protected:
  EvaluatePosesTest() {
    to_truth.scale = 2;
    to_truth.R = textplane::so3_exp<double>(Vec3(0.4, -1.1, 0.7));
    to_truth.t = {5, -3, 2};
    for (int i = 0; i < 41; ++i) {
      const SE3d pose = moved({0.1 * i, std::sin(0.1 * i), 0}, {0, 0.02 * i, 0});
      truth.push_back({0.1 * i, to_truth * pose});
      StatedPose stated;
      stated.pose = {0.1 * i, pose};
      if (i % 10 == 0)
        keyframes.push_back(stated.pose);
      else
        stated.covariance = kSigma * kSigma / 3 * Matrix3<double>::Identity();
      poses.push_back(stated);
    }
  }
  PoseErrors compare() const { return compare_poses(poses, keyframes, truth, to_truth); }

  static constexpr double kSigma = 0.01;  // of positions in the map: the square root of the trace
  Similarity to_truth;
  std::vector<StampedPose> truth, keyframes;
  std::vector<StatedPose> poses;
};

TEST_F(EvaluatePosesTest, ErrorsAreInUnitsOfTheTruthAndOfSigma) {
  for (StatedPose& stated : poses)
    if (stated.covariance.trace() > 0) stated.pose.T_w_c.t += Vec3(0, 0.02, 0);
  const PoseErrors errors = compare();
  EXPECT_EQ(errors.poses, 41U);
  EXPECT_NEAR(errors.ate_rmse, 0.04 * std::sqrt(36.0 / 41), 1e-9) << "key frames have no error";
  EXPECT_NEAR(errors.relative_rmse, 0.04, 1e-9);
  EXPECT_EQ(errors.over_sigma.n, 36U);
  EXPECT_NEAR(errors.over_sigma.median, 2, 1e-9);
  EXPECT_NEAR(errors.relative_over_sigma.p90, 2, 1e-9);
}

// The map drifts and turns: what is stated of poses in it does not know.
TEST_F(EvaluatePosesTest, DriftIsNoErrorOfTheMotionFromAKeyFrame) {
  const SE3d drift = moved({0.3, 0, 0.1}, {0, 0.1, 0});
  for (StatedPose& stated : poses) stated.pose.T_w_c = drift * stated.pose.T_w_c;
  for (StampedPose& keyframe : keyframes) keyframe.T_w_c = drift * keyframe.T_w_c;
  const PoseErrors errors = compare();
  EXPECT_GT(errors.ate_rmse, 0.5);
  EXPECT_GT(errors.over_sigma.median, 20);
  EXPECT_LT(errors.relative_rmse, 1e-9);
  EXPECT_LT(errors.relative_over_sigma.max, 1e-6);
}

TEST_F(EvaluatePosesTest, WithoutTruthOrKeyFramesThereIsNoError) {
  truth.clear();
  EXPECT_TRUE(std::isnan(compare().ate_rmse));
  EXPECT_EQ(compare().over_sigma.n, 0U);
  EXPECT_EQ(compare().poses, 41U);
  EXPECT_TRUE(std::isnan(compare_poses({}, {}, {}, to_truth).relative_rmse));
}

}  // namespace evaluate_poses_test
}  // namespace textslam
