// Relative pose of two views of a known scene.
#include "textslam/init/two_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "textslam/common/parameters.hpp"
#include "textslam/scene_support.hpp"

namespace textslam {
namespace two_view_test {

using namespace scene_support;

TEST(TwoViewTest, ExactMatchesGiveTheMotionWhateverItsDirection) {
  std::mt19937 random(1);
  const std::vector<Vec3> points = scene(150, false, random);
  for (const Vec3& t : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1),
                        Vec3(0.6, -0.5, 0.62), Vec3(-0.4, -0.7, -0.59)}) {
    const SE3d T_b_a = moved(0.25 * t.normalized(), Vec3(0.03, -0.05, 0.02));
    const TwoView view = estimate_two_view(views(points, SE3d{}, 0, random), views(points, T_b_a, 0, random), kFocal);
    SCOPED_TRACE(t.transpose());
    ASSERT_TRUE(view.ok);
    EXPECT_NEAR(view.T_b_a.t.norm(), 1, 1e-12);
    EXPECT_LT(angle_between(view.T_b_a.t, T_b_a.t), 1e-3) << "the sign, too";
    EXPECT_LT(rotation_error(view.T_b_a, T_b_a), 1e-4);
    EXPECT_EQ(view.inliers, 150);
    EXPECT_LT(view.rms, 0.01);
    ASSERT_FALSE(view.motions.empty());
    EXPECT_EQ(view.motions[0].T_b_a.t, view.T_b_a.t);
    for (std::size_t i = 1; i < view.motions.size(); ++i) EXPECT_GT(view.motions[i].cost, 2 * view.motions[0].cost);
  }
}

TEST(TwoViewTest, NoiseAndWrongMatches) {
  std::mt19937 random(2);
  const std::vector<Vec3> points = scene(200, false, random);
  const SE3d T_b_a = moved({0.3, 0.05, 0.1}, {0.02, 0.06, -0.03});
  const std::vector<Vec3> a = views(points, SE3d{}, 0.5, random);
  std::vector<Vec3> b = views(points, T_b_a, 0.5, random);
  // Every tenth match has slid 6 to 40 px away.
  for (std::size_t i = 0; i < b.size(); i += 10) {
    const double angle = uniform(random, 0, 2 * M_PI), length = uniform(random, 6, 40) / kFocal;
    b[i] += length * Vec3(std::cos(angle), std::sin(angle), 0);
  }
  const TwoView view = estimate_two_view(a, b, kFocal);
  ASSERT_TRUE(view.ok);
  EXPECT_LT(angle_between(view.T_b_a.t, T_b_a.t), 3 * kDegree);
  EXPECT_LT(rotation_error(view.T_b_a, T_b_a), 0.5 * kDegree);
  EXPECT_LT(angle_between(view.T_b_a.t, T_b_a.t), 5 * view.direction_sigma) << "the uncertainty reported is honest";
  EXPECT_GE(view.inliers, 175);
  int wrong = 0;
  for (std::size_t i = 0; i < b.size(); i += 10) wrong += view.inlier[i];
  EXPECT_LE(wrong, 6) << "those that slid along their epipolar line";
  std::vector<double> parallaxes;
  for (const Vec3& p : points) parallaxes.push_back(angle_between(p, p + T_b_a.R.transpose() * T_b_a.t));
  std::nth_element(parallaxes.begin(), parallaxes.begin() + 100, parallaxes.end());
  EXPECT_NEAR(view.parallax, parallaxes[100] / kDegree, 0.15 * parallaxes[100] / kDegree) << "the rotation taken out";
}

// A plane has two motions that explain it. The right one is among those found, and another only where it costs about as
// much.
TEST(TwoViewTest, PlanarSceneHasTheRightMotionAmongThoseFound) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937 random(100 + seed);
    const std::vector<Vec3> points = scene(150, true, random);
    const Vec3 t(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -0.5, 0.5));
    const SE3d T_b_a = moved(0.4 * t.normalized(), {0.02, uniform(random, -0.08, 0.08), 0.03});
    const TwoView view =
        estimate_two_view(views(points, SE3d{}, 0.3, random), views(points, T_b_a, 0.3, random), kFocal);
    SCOPED_TRACE(seed);
    ASSERT_TRUE(view.ok);
    EXPECT_GE(view.inliers, 140) << "the plane is explained either way";
    const bool found = std::any_of(view.motions.begin(), view.motions.end(), [&](const TwoViewMotion& motion) {
      return angle_between(motion.T_b_a.t, T_b_a.t) < 10 * kDegree && rotation_error(motion.T_b_a, T_b_a) < 2 * kDegree;
    });
    EXPECT_TRUE(found);
    for (std::size_t i = 1; i < view.motions.size(); ++i) EXPECT_GE(view.motions[i].cost, view.motions[i - 1].cost);
  }
}

TEST(TwoViewTest, PureRotationHasNoParallax) {
  std::mt19937 random(3);
  const std::vector<Vec3> points = scene(150, false, random);
  const SE3d turn = moved({0, 0, 0}, {0.05, 0.08, -0.02});
  const TwoView view = estimate_two_view(views(points, SE3d{}, 0.3, random), views(points, turn, 0.3, random), kFocal);
  const Parameters parameters;
  EXPECT_TRUE(!view.ok || view.parallax < 0.3 * parameters.init_min_parallax) << view.parallax;
}

TEST(TwoViewTest, TooFewOrUnequalMatchesAreRefused) {
  std::mt19937 random(4);
  const std::vector<Vec3> rays = views(scene(20, false, random), SE3d{}, 0, random);
  const std::vector<Vec3> few(rays.begin(), rays.begin() + 11);
  EXPECT_FALSE(estimate_two_view(few, few, kFocal).ok);
  EXPECT_FALSE(estimate_two_view(rays, few, kFocal).ok);
  EXPECT_FALSE(estimate_two_view({}, {}, kFocal).ok);
  EXPECT_TRUE(estimate_two_view(rays, rays, kFocal).parallax < 0.01) << "no motion at all";
}

}  // namespace two_view_test
}  // namespace textslam
