// The fit of a plane to the points of its surface, alone.
#include <gtest/gtest.h>

#include <vector>

#include "landmarks/frames_support.hpp"
#include "textplane/landmarks/text_surface.hpp"

namespace landmarks_test {

// A plane that turns about a point goes through it all the same.
TEST(SurfaceFit, APlaneTurnedAboutAPointKeepsIt) {
  const Vec3 theta(0.1, -0.2, 0.5), ray(0.4, 0.3, 1);
  const Vec3 point = ray / theta.dot(ray);
  const Eigen::Matrix3d C = detail::turned_about(theta, point, 0.05);
  EXPECT_LT((C * point).norm(), 1e-15);
  EXPECT_NEAR(normal_sigma(theta, C), 0.05, 1e-12);
}

// Points that are off by more than their sigmas count less the farther they are, not only those beyond the limit.
TEST(SurfaceFit, PointsFartherOffCountLess) {
  const TextOptions options;
  const double sigma = 0.002, off = 2.7 * sigma;
  std::vector<SurfacePoint> points;
  for (int i = 0; i < 80; ++i)
    points.push_back({Vec3(-0.5 + 0.1 * (i % 10), -0.4 + 0.1 * (i / 10), i % 4 == 1 ? 2 + off : 2), sigma, 0});
  Vec3 theta(0, 0, 0.5);
  const Vec3 centre(0, 0, 2);
  Eigen::Matrix3d covariance = detail::guessed(theta, centre, 0.1, 0.05);
  ASSERT_TRUE(fit_to_surface(points, centre, options, &theta, &covariance));
  const double depth = 1 / theta.z();
  EXPECT_GT(depth, 2);
  EXPECT_LT(depth - 2, 0.5 * 0.25 * off) << "their mean is a fourth of the way";
}

// Points that are all known to so much in every direction, for PointLookup.
struct EvenPoints {
  std::vector<Vec3> all;
  double sigma = 0;

  int text_point_count() const { return static_cast<int>(all.size()); }
  bool text_point(int i, Vec3* p_w) const {
    *p_w = all[static_cast<std::size_t>(i)];
    return true;
  }
  double text_point_variance(int, const Vec3&) const { return sigma * sigma; }
};

// A world eight times as large has a plane eight times as far away.
TEST(PlaneFromSurface, ScalesWithTheWorld) {
  const Vec3 theta(0.1, -0.05, 0.5);
  TextObject text;
  text.patch.camera = {300, 300, 160, 120};
  text.patch.quad.corner = {Vec2(120, 100), Vec2(200, 100), Vec2(200, 140), Vec2(120, 140)};
  for (const double scale : {1.0, 8.0}) {
    EvenPoints points;
    points.sigma = 0.004 * scale;
    for (int i = 0; i < 60; ++i) {
      const Vec3 ray = text.patch.camera.unproject(Vec2(110 + 10 * (i % 10), 95 + 10 * (i / 10)));
      points.all.push_back(scale / theta.dot(ray) * ray);
    }
    ASSERT_TRUE(plane_from_surface(TextOptions(), PointLookup(points), SE3d(), points.all, text)) << scale;
    EXPECT_LT((scale * text.theta - theta).norm(), 0.01 * theta.norm()) << scale;
  }
}

}  // namespace landmarks_test
