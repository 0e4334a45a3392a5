// First planes of texts, and planes that move to another frame.
#include "textplane/landmarks/text_plane.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "landmarks/frames_support.hpp"
#include "support/random.hpp"
#include "textplane/landmarks/text_proposal.hpp"

namespace landmarks_test {

// The covariance of a plane as another frame has it, against differences.
TEST(TransportPlane, MovesTheCovarianceByItsDerivative) {
  textplane_test::Random random(7);
  for (int i = 0; i < 10; ++i) {
    const SE3d T = random.pose(0.4, 0.5);
    const Vec3 theta(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0.5);
    Eigen::Matrix3d A, J;
    for (int k = 0; k < 9; ++k) A(k / 3, k % 3) = random.normal();
    const Eigen::Matrix3d C = A * A.transpose();
    for (int k = 0; k < 3; ++k) {
      const double h = 1e-6;
      const Vec3 step = h * Vec3::Unit(k);
      J.col(k) = (reanchor_plane<double>(theta + step, T) - reanchor_plane<double>(theta - step, T)) / (2 * h);
    }
    Vec3 moved = theta;
    Eigen::Matrix3d covariance = C;
    ASSERT_TRUE(transport_plane(T, &moved, &covariance));
    EXPECT_LT((moved - reanchor_plane<double>(theta, T)).norm(), 1e-12);
    EXPECT_LT((covariance - J * C * J.transpose()).norm(), 1e-6 * covariance.norm());
  }
}

TEST(PlaneFromTextMatches, LeavesOutliersOut) {
  const Pinhole<double> camera(300, 300, 160, 120);
  const SE3d T_t_h{Eigen::Matrix3d::Identity(), Vec3(-0.3, 0, 0)};
  std::vector<Vec3> host, target;
  for (int i = 0; i < 24; ++i) {
    const Vec3 p = 2 * camera.unproject(Vec2(100 + 4 * i, 100 + 9 * (i % 5)));
    host.push_back(p.hnormalized().homogeneous());
    target.push_back((T_t_h * p).hnormalized().homogeneous());
    if (i % 8 == 3) target.back().x() += 0.05;  // 15 px
  }
  Vec3 theta;
  ASSERT_TRUE(plane_from_text_matches(TextOptions(), host, target, T_t_h, 300, host[5], &theta));
  EXPECT_LT((theta - Vec3(0, 0, 0.5)).norm(), 1e-6);
}

// A world eight times as large has a plane eight times as far away, however far its points scatter about it.
TEST(PlaneFromInsidePoints, ScalesWithTheWorld) {
  TextPatch patch;
  patch.camera = {300, 300, 160, 120};
  patch.quad.corner = {Vec2(100, 100), Vec2(200, 100), Vec2(200, 140), Vec2(100, 140)};
  textplane_test::Random random(8);
  std::vector<Vec3> inside, far;
  for (int i = 0; i < 40; ++i) {
    const double x = random.uniform(100, 200), y = random.uniform(100, 140), depth = 2 + random.uniform(-0.3, 0.3);
    inside.push_back(depth * patch.camera.unproject(Vec2(x, y)));
    far.push_back(8 * inside.back());
  }
  Vec3 theta, theta_far;
  ASSERT_TRUE(plane_from_inside_points(TextOptions(), inside, patch, &theta));
  ASSERT_TRUE(plane_from_inside_points(TextOptions(), far, patch, &theta_far));
  EXPECT_LT((8 * theta_far - theta).norm(), 1e-12 * theta.norm());
}

TEST(FrontalPlane, LiesAcrossTheRayAtTheDepth) {
  const Vec3 ray(0.3, -0.4, 1);
  const Vec3 theta = frontal_plane(ray, 4);
  EXPECT_NEAR(inverse_depth<double>(theta, ray), 0.25, 1e-15);
  EXPECT_LT(theta.normalized().cross(ray.normalized()).norm(), 1e-15);
}

TEST(DepthAbout, IsThatOfThePointsNearTheQuad) {
  Quad<double> quad;
  quad.corner = {Vec2(100, 100), Vec2(140, 100), Vec2(140, 120), Vec2(100, 120)};
  std::vector<TextPoint> points;
  for (int i = 0; i < 5; ++i) points.push_back(TextPoint::with_depth(Vec2(110 + i, 110), 2 + 0.1 * i));
  for (int i = 0; i < 9; ++i) points.push_back(TextPoint::with_depth(Vec2(300 + i, 200), 7));
  points.push_back(TextPoint::with_depth(Vec2(110, 110), -1));
  points.push_back(TextPoint::track(Vec2(110, 110), 1));
  EXPECT_EQ(depth_about(points, SE3d(), quad, 5), 2.2);
  EXPECT_EQ(depth_about(points, SE3d(), quad, 6), 7) << "of all, where those near it are too few";
  EXPECT_EQ(depth_about(points, SE3d(), quad, 15), 0);
}

}  // namespace landmarks_test
