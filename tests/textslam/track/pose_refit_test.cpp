// The last pose of a frame between key frames: by what it saw, and by what was known of it.
#include "textslam/track/pose_refit.hpp"

#include <gtest/gtest.h>

#include <random>

#include "textslam/scene_support.hpp"

namespace textslam {
namespace pose_refit_test {

using namespace scene_support;

class PoseRefitTest : public testing::Test {
 protected:
  PoseRefitTest() {
    map.camera = camera();
    map.width = 640;
    map.height = 480;
    std::mt19937 random(3);
    std::normal_distribution<float> noise(0, 1);
    truth = moved({-0.2, 0.1, 0}, {0.01, 0.02, 0});
    for (const Vec3& p : scene(200, false, random)) {
      const Vec2 px = map.camera.project(truth * p);
      seen.push_back({static_cast<int>(map.points.size()), px.cast<float>() + Vec2f(noise(random), noise(random))});
      map.points.push_back({p});
    }
  }
  double error(const SE3d& T_c_w) const { return (T_c_w.inverse().t - truth.inverse().t).norm(); }

  Map map;
  Parameters parameters;
  SE3d truth;
  std::vector<SeenPoint> seen;
};

TEST_F(PoseRefitTest, WithoutInformationIsByThePoints) {
  PoseEstimate pose{textplane::se3_exp<double>((Vector6() << 0.02, 0, 0.02, 0.01, 0, 0).finished()) * truth};
  ASSERT_TRUE(refit_pose(map, parameters, map.camera, seen, &pose));
  EXPECT_LT(error(pose.T_c_w), 4 * position_sigma(pose.information));
  EXPECT_LT(position_sigma(pose.information), 0.01);
}

// The position that two sources know equally well lies midway between theirs.
TEST_F(PoseRefitTest, WeighsWhatWasKnownByItsInformation) {
  PoseEstimate by_points{truth};
  ASSERT_TRUE(refit_pose(map, parameters, map.camera, seen, &by_points));
  const Vector6 apart = (Vector6() << 2e-3, -1e-3, 1e-3, 1e-3, 0, -1e-3).finished();
  PoseEstimate pose{textplane::se3_exp<double>(apart) * by_points.T_c_w, by_points.information};
  ASSERT_TRUE(refit_pose(map, parameters, map.camera, seen, &pose));
  const Vector6 moved = textplane::se3_log<double>(pose.T_c_w * by_points.T_c_w.inverse());
  EXPECT_LT((moved - 0.5 * apart).norm(), 0.02 * apart.norm());
  EXPECT_LT((pose.information - 2 * by_points.information).norm(), 0.01 * pose.information.norm());

  PoseEstimate exact{truth, 1e6 * by_points.information};
  ASSERT_TRUE(refit_pose(map, parameters, map.camera, seen, &exact));
  EXPECT_LT(error(exact.T_c_w), 0.01 * error(by_points.T_c_w));
}

TEST_F(PoseRefitTest, LeavesThePoseWhereFewPointsAreLeft) {
  seen.resize(static_cast<std::size_t>(parameters.refit_min_points) - 1);
  PoseEstimate pose{truth, Matrix6::Identity()};
  EXPECT_FALSE(refit_pose(map, parameters, map.camera, seen, &pose));
  EXPECT_EQ(pose.T_c_w.t, truth.t);
  EXPECT_EQ(pose.information, Matrix6::Identity());
}

TEST(PoseInformation, FollowsTheScaleOfTheMap) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Matrix6 A;
  for (int i = 0; i < 36; ++i) A(i / 6, i % 6) = normal(random);
  const Matrix6 information = A * A.transpose() + Matrix6::Identity();
  EXPECT_NEAR(position_sigma(rescaled(information, 3)), 3 * position_sigma(information), 1e-9);
  EXPECT_TRUE(std::isinf(position_sigma(Matrix6::Zero())));
}

}  // namespace pose_refit_test
}  // namespace textslam
