// Quads of a plane as other cameras and pyramid levels have them.
#include "textplane/geometry/quad_projection.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>

#include "geometry/quad_support.hpp"

namespace tp = textplane;
using textplane_test::Dual;

#define TEXTPLANE_INSTANTIATE(S)                                                                            \
  template tp::Status tp::transform<S>(const tp::Quad<S>&, const tp::Matrix3<S>&, tp::Quad<S>*);            \
  template tp::Status tp::project_quad<S>(const tp::Quad<S>&, const tp::Pinhole<S>&, const tp::Vector3<S>&, \
                                          const tp::SE3<S>&, const tp::Pinhole<S>&, tp::Quad<S>*);          \
  template tp::Status tp::quad_points<S>(const tp::Quad<S>&, const tp::Pinhole<S>&, const tp::Vector3<S>&,  \
                                         std::array<tp::Vector3<S>, 4>*);
TEXTPLANE_INSTANTIATE(float)
TEXTPLANE_INSTANTIATE(double)
TEXTPLANE_INSTANTIATE(Dual<2>)
#undef TEXTPLANE_INSTANTIATE

namespace quad_test {

TYPED_TEST(Quads, LevelsFollowThePixelConvention) {
  using S = TypeParam;
  for (int level = 0; level < 5; ++level) {
    // The corner of the image, (-0.5, -0.5), is the same on each level.
    EXPECT_EQ(values(tp::point_to_level(tp::Vector2<S>(S(-0.5), S(-0.5)), level)), Vector2d(-0.5, -0.5));
    const tp::Vector2<S> p(S(37.25), S(11.5));
    EXPECT_LT((values(tp::point_from_level(tp::point_to_level(p, level), level)) - values(p)).norm(),
              tolerance<S>(1e-5, 1e-13));
    const auto q = tp::quad_to_level(rectangle(3, 4, 35, 20).cast<S>(), level);
    EXPECT_NEAR(value(tp::area(q)) * (1 << level) * (1 << level), 512, tolerance<S>(1e-3, 1e-11));
  }
  EXPECT_EQ(values(tp::point_to_level(tp::Vector2<S>(S(0.5), S(2.5)), 1)), Vector2d(0, 1))
      << "the middle of a 2 x 2 block";
}

TYPED_TEST(Quads, ProjectedQuadsAndTheirPoints) {
  using S = TypeParam;
  Random random(5);
  const tp::Pinhole<double> host(525, 520, 319.5, 239.5), target(400, 410, 300, 200);
  for (int i = 0; i < 20; ++i) {
    const Quad q = random_convex(random, {320, 240}, 80);
    const Vector3d theta = Vector3d(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0.5);
    const tp::SE3d T = random.pose(0.2, 0.3);
    std::array<tp::Vector3<S>, 4> points;
    ASSERT_EQ(tp::quad_points<S>(q.cast<S>(), host.cast<S>(), theta.cast<S>(), &points), tp::Status::ok);
    tp::Quad<S> projected, by_matrix;
    ASSERT_EQ(
        tp::project_quad<S>(q.cast<S>(), host.cast<S>(), theta.cast<S>(), T.cast<S>(), target.cast<S>(), &projected),
        tp::Status::ok);
    const Eigen::Matrix3d H = tp::pixel_homography<double>(tp::plane_homography(theta, T), host, target);
    ASSERT_EQ(tp::transform<S>(q.cast<S>(), H.cast<S>(), &by_matrix), tp::Status::ok);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(theta.dot(values(points[k])), 1, tolerance<S>(2e-6, 1e-14));
      const Vector2d expected = target.project(T * Vector3d(values(points[k])));
      EXPECT_LT((values(projected.corner[k]) - expected).norm(), tolerance<S>(2e-3, 1e-11));
      EXPECT_LT((values(by_matrix.corner[k]) - expected).norm(), tolerance<S>(5e-3, 1e-11));
    }
    EXPECT_TRUE(tp::is_convex(projected)) << "a plane in front of both cameras keeps convexity";
  }
}

TEST(QuadTest, ProjectionBehindTheCameraLeavesTheOutput) {
  const Quad q = rectangle(100, 100, 200, 150), untouched = rectangle(1, 2, 3, 4);
  const tp::Pinhole<double> camera(525, 520, 319.5, 239.5);
  Quad out = untouched;
  tp::SE3d T;
  EXPECT_EQ(tp::project_quad(q, camera, Vector3d(0, 0, -1), T, camera, &out), tp::Status::behind_camera);
  T.t = Vector3d(0, 0, -2);
  EXPECT_EQ(tp::project_quad(q, camera, Vector3d(0, 0, 1), T, camera, &out), tp::Status::behind_camera);
  EXPECT_EQ(tp::project_quad(q, camera, Vector3d(0, 0, kNan), T, camera, &out), tp::Status::non_finite);
  const tp::Pinhole<double> infinite(1e308, 100, 1e308, 50);
  EXPECT_EQ(tp::project_quad(q, camera, Vector3d(0, 0, 1), tp::SE3d{T.R, Vector3d(5, 0, 0)}, infinite, &out),
            tp::Status::non_finite);
  EXPECT_EQ(tp::transform(q, Eigen::Matrix3d(-Eigen::Matrix3d::Identity()), &out), tp::Status::behind_camera);
  EXPECT_EQ(out.corner, untouched.corner);
  std::array<Vector3d, 4> points;
  points.fill(Vector3d(7, 8, 9));
  // The plane's horizon crosses the quad: some corners in front, some not.
  EXPECT_EQ(tp::quad_points(q, camera, Vector3d(1, 0, 0.3), &points), tp::Status::behind_camera);
  const tp::Pinhole<double> flat(0, 520, 319.5, 239.5);
  EXPECT_EQ(tp::quad_points(q, flat, Vector3d(0, 0, 1), &points), tp::Status::invalid_argument);
  EXPECT_EQ(tp::project_quad(q, flat, Vector3d(0, 0, 1), tp::SE3d(), camera, &out), tp::Status::invalid_argument);
  EXPECT_EQ(out.corner, untouched.corner);
  EXPECT_EQ(points[0], Vector3d(7, 8, 9));
}

}  // namespace quad_test
