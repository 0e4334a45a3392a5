// The pose of one quad: exact and noisy corners, both solutions, and what is no quad.
#include "sign_index/planar_pose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace textslam {
namespace planar_pose_test {

using textplane::Status;

constexpr double kDegree = M_PI / 180;

SE3d moved(const Vec3& t, const Vec3& w) { return {textplane::so3_exp<double>(w), t}; }
double turn_between(const SE3d& a, const SE3d& b) { return textplane::so3_log<double>(a.R * b.R.transpose()).norm(); }

// A sign of 0.6 by 0.2, in a frame of its own that has nothing to do with its plane.
class PlanarPoseTest : public testing::Test {
 protected:
  PlanarPoseTest() : T_q_sign(moved({3, -1, 2}, {0.7, -0.4, 1.1})) {
    corners = {T_q_sign * Vec3(-0.3, -0.1, 0), T_q_sign * Vec3(0.3, -0.1, 0), T_q_sign * Vec3(0.3, 0.1, 0),
               T_q_sign * Vec3(-0.3, 0.1, 0)};
  }
  Quad<double> seen_from(const SE3d& T_c_sign) const {
    Quad<double> image;
    for (std::size_t i = 0; i < 4; ++i) image.corner[i] = (T_c_sign * T_q_sign.inverse() * corners[i]).hnormalized();
    return image;
  }
  SE3d T_q_sign;
  std::array<Vec3, 4> corners;
};

TEST_F(PlanarPoseTest, ExactCornersGiveThePoseAmongTwoThatExplainThem) {
  for (const Vec3& w : {Vec3(0, 0, 0), Vec3(0.5, 0, 0), Vec3(0, -0.9, 0), Vec3(0.4, 0.7, -0.6), Vec3(-0.2, 1.1, 2.5)})
    for (const Vec3& t : {Vec3(0, 0, 2), Vec3(0.8, -0.5, 1.8), Vec3(-1.5, 1, 4)}) {
      const SE3d T_c_sign = moved(t, w);
      if (!((T_c_sign.R * Vec3::UnitZ()).dot(t) > 0.1)) continue;  // its back
      SCOPED_TRACE(testing::Message() << t.transpose() << " turned " << w.transpose());
      const PlanarPose pose = planar_pose(corners, seen_from(T_c_sign));
      ASSERT_EQ(pose.status, Status::ok);
      EXPECT_LT(pose.error[0], 1e-9);
      const SE3d found = pose.T_c_q[0] * T_q_sign;
      EXPECT_LT(turn_between(found, T_c_sign), 1e-6);
      EXPECT_LT((found.t - T_c_sign.t).norm(), 1e-6);
      ASSERT_EQ(pose.count, 2);
      // The other is tilted as much, to the other side of the ray to the sign.
      const Vec3 ray = t.normalized(), other = (pose.T_c_q[1] * T_q_sign).R * Vec3::UnitZ();
      EXPECT_NEAR(other.dot(ray), (T_c_sign.R * Vec3::UnitZ()).dot(ray), 0.02);
    }
}

TEST_F(PlanarPoseTest, FarAwayBothSolutionsFitAndOneIsRight) {
  const SE3d T_c_sign = moved({0.5, 0.2, 8}, {0.1, 0.6, 0.2});
  Quad<double> image = seen_from(T_c_sign);
  const double px = 1.0 / 525;
  image.corner[0] += Vec2(0.3, -0.2) * px;
  image.corner[2] += Vec2(-0.2, 0.3) * px;
  const PlanarPose pose = planar_pose(corners, image);
  ASSERT_EQ(pose.status, Status::ok);
  ASSERT_EQ(pose.count, 2);
  EXPECT_LT(pose.error[0], px);
  EXPECT_LT(pose.error[1], 2 * px) << "half a pixel decides which of them is better";
  EXPECT_GT(turn_between(pose.T_c_q[0], pose.T_c_q[1]), 20 * kDegree);
  const double nearest =
      std::min(turn_between(pose.T_c_q[0] * T_q_sign, T_c_sign), turn_between(pose.T_c_q[1] * T_q_sign, T_c_sign));
  EXPECT_LT(nearest, 15 * kDegree);
}

TEST_F(PlanarPoseTest, DegenerateQuadsGiveAStatus) {
  const Quad<double> image = seen_from(moved({0, 0, 2}, {0.2, 0.3, 0}));
  const auto status = [&](const Quad<double>& q) { return planar_pose(corners, q).status; };
  Quad<double> quad = image;
  quad.corner[2] = quad.corner[1];
  EXPECT_EQ(status(quad), Status::degenerate) << "a triangle";
  for (std::size_t i = 0; i < 4; ++i) quad.corner[i] = {0.1 * static_cast<double>(i), 0.2};
  EXPECT_EQ(status(quad), Status::degenerate) << "a line";
  quad = image;
  std::swap(quad.corner[0], quad.corner[1]);
  EXPECT_EQ(status(quad), Status::degenerate) << "a bow tie";
  quad = image;
  std::swap(quad.corner[0], quad.corner[1]);
  std::swap(quad.corner[2], quad.corner[3]);
  EXPECT_EQ(status(quad), Status::behind_camera) << "in a mirror";
  quad = image;
  quad.corner[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(status(quad), Status::non_finite);

  std::array<Vec3, 4> bad = corners;
  bad[2] = bad[0];
  EXPECT_EQ(planar_pose(bad, image).status, Status::degenerate);
  bad.fill(corners[0]);
  EXPECT_EQ(planar_pose(bad, image).status, Status::degenerate);
  bad[1].z() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(planar_pose(bad, image).status, Status::non_finite);
  EXPECT_EQ(planar_pose(bad, image).count, 0);
}

}  // namespace planar_pose_test
}  // namespace textslam
