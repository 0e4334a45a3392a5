// Poses from matches: three that are exact, and many of which most are wrong.
#include "textslam/relocalise/three_point_pose.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "textslam/scene_support.hpp"

namespace textslam {
namespace three_point_pose_test {

using namespace scene_support;
using textplane::Status;

TEST(ThreePointPoseTest, ThreePointsGiveThePose) {
  std::mt19937 random(3);
  int found = 0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::vector<Vec3> p = scene(3, false, random);
    const SE3d truth = moved({uniform(random, -0.8, 0.8), 0.1, uniform(random, -0.5, 0.5)},
                             {0.1, uniform(random, -0.4, 0.4), uniform(random, -3, 3)});
    std::array<Vec3, 3> p_w, rays;
    Vec3 depths;
    for (std::size_t i = 0; i < 3; ++i) {
      p_w[i] = p[i];
      rays[i] = (truth * p[i]) / (truth * p[i]).z();
      depths[static_cast<int>(i)] = p[i].z();
    }
    SE3d pose;
    if (three_point_pose(p_w, rays, depths, &pose) != Status::ok) continue;
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT(angle_between(pose * p_w[i], rays[i]), 1e-6) << "every solution explains the rays";
    EXPECT_NEAR(pose.R.determinant(), 1, 1e-9);
    found += rotation_error(pose, truth) < 1e-5 && (pose.t - truth.t).norm() < 1e-5 ? 1 : 0;
  }
  EXPECT_GT(found, kTrials * 6 / 10) << "of up to four solutions the one near the start is mostly the true one";
}

TEST(ThreePointPoseTest, WhatIsNoTriangleGivesAStatus) {
  const std::array<Vec3, 3> p = {Vec3(-1, 0, 3), Vec3(1, 0, 3), Vec3(0, 1, 4)};
  const std::array<Vec3, 3> rays = {p[0] / 3, p[1] / 3, p[2] / 4};
  const Vec3 depths(3, 3, 4);
  SE3d pose;
  EXPECT_EQ(three_point_pose(p, rays, depths, &pose), Status::ok);
  EXPECT_EQ(three_point_pose({p[0], p[1], p[0]}, rays, depths, &pose), Status::degenerate);
  EXPECT_EQ(three_point_pose({p[0], p[1], (p[0] + p[1]) / 2}, rays, depths, &pose), Status::degenerate);
  EXPECT_EQ(three_point_pose(p, {rays[0], rays[1], rays[1]}, depths, &pose), Status::degenerate);
  EXPECT_EQ(three_point_pose(p, rays, {-3, -3, -4}, &pose), Status::diverged) << "behind the camera";
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(three_point_pose(p, rays, {nan, 3, 4}, &pose), Status::non_finite);
  EXPECT_EQ(three_point_pose({p[0], p[1], Vec3(0, nan, 1)}, rays, depths, &pose), Status::non_finite);
}

TEST(ThreePointPoseTest, MostMatchesMayBeWrong) {
  std::mt19937 random(5);
  const Parameters parameters;
  const std::vector<Vec3> points = scene(150, false, random);
  const SE3d truth = moved({0.7, -0.1, 0.4}, {0.05, -0.35, 0.3});
  const std::vector<Vec3> rays = views(points, truth, 1, random);
  std::vector<PointMatch> matches;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 px =
        i % 10 < 3 ? Vec2(camera().project(rays[i])) : Vec2(uniform(random, 0, 640), uniform(random, 0, 480));
    matches.push_back({static_cast<int>(i), points[i], px, 1.5});
  }
  const MatchedPose found = pose_of_matches(matches, camera(), SE3d{}, parameters);
  EXPECT_GE(found.inliers, 40);
  EXPECT_LE(found.inliers, 55);
  EXPECT_LT(rotation_error(found.T_c_w, truth), 0.3 * kDegree);
  EXPECT_LT((found.T_c_w.t - truth.t).norm(), 0.02);
  const MatchedPose again = pose_of_matches(matches, camera(), SE3d{}, parameters);
  EXPECT_EQ(again.T_c_w.t, found.T_c_w.t) << "nothing is drawn at random between runs";

  matches.resize(2);
  EXPECT_EQ(pose_of_matches(matches, camera(), SE3d{}, parameters).inliers, 0);
  for (PointMatch& match : matches) match.p_w.x() = std::numeric_limits<double>::quiet_NaN();
  matches.push_back(matches[0]);
  EXPECT_EQ(pose_of_matches(matches, camera(), SE3d{}, parameters).inliers, 0);
}

TEST(ThreePointPoseTest, RowsThatMovedAreKnown) {
  std::mt19937 random(7);
  const Parameters parameters;
  const std::vector<Vec3> points = scene(120, false, random);
  const SE3d truth = moved({0.3, -0.1, 0.2}, {0.05, -0.2, 0.1});
  textplane::RowMotion rows;
  rows.shutter.readout = 0.03;
  rows.shutter.rows = 480;
  rows.shutter.row0 = 239.5;
  rows.velocity << 0.1, 0, -0.2, 0.4, -1.1, 0.3;
  const CameraView still = camera();
  const CameraView rolling{still.pinhole, still.lens, &rows};
  std::vector<PointMatch> matches;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vec2 px;
    if (show(rolling, truth * points[i], &px)) matches.push_back({static_cast<int>(i), points[i], px, 1});
  }
  ASSERT_GT(matches.size(), 60U);
  const MatchedPose found = pose_of_matches(matches, rolling, SE3d{}, parameters);
  EXPECT_EQ(found.inliers, static_cast<int>(matches.size()));
  EXPECT_LT(rotation_error(found.T_c_w, truth), 1e-5);
  EXPECT_LT((found.T_c_w.t - truth.t).norm(), 1e-4);
  // Rows near the middle hardly moved, so that without their motion a pose is found for those.
  EXPECT_LT(pose_of_matches(matches, still, SE3d{}, parameters).inliers, static_cast<int>(matches.size() * 3 / 4));
}

}  // namespace three_point_pose_test
}  // namespace textslam
