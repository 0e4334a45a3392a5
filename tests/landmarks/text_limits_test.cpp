// First planes with options at their limits: no round of solving, and no least number of points.
#include <gtest/gtest.h>

#include <vector>

#include "landmarks/frames_support.hpp"
#include "textplane/landmarks/text_plane.hpp"
#include "textplane/landmarks/text_proposal.hpp"

namespace landmarks_test {

class TextLimits : public testing::Test {
 protected:
  TextLimits() {
    patch.camera = {300, 300, 160, 120};
    patch.quad.corner = {Vec2(100, 100), Vec2(200, 100), Vec2(200, 140), Vec2(100, 140)};
    for (int i = 0; i < 12; ++i) {
      const Vec3 p = 2 * patch.camera.unproject(Vec2(105 + 8 * i, 105 + 7 * (i % 5)));
      inside.push_back(p);
      host.push_back(p.hnormalized().homogeneous());
      target.push_back((T_t_h * p).hnormalized().homogeneous());
    }
  }
  bool by_matches(Vec3* theta) const {
    return plane_from_text_matches(options, host, target, T_t_h, 300, host[5], theta);
  }

  TextOptions options;
  TextPatch patch;
  SE3d T_t_h{Eigen::Matrix3d::Identity(), Vec3(-0.3, 0, 0)};
  std::vector<Vec3> inside, host, target;
  const Vec3 other = Vec3(0.1, 0.2, 0.7);  // a plane that nobody measured
};

TEST_F(TextLimits, WithRoundsThePlaneIsFound) {
  Vec3 theta = other;
  ASSERT_TRUE(plane_from_inside_points(options, inside, patch, &theta));
  EXPECT_LT((theta - Vec3(0, 0, 0.5)).norm(), 1e-3);
  theta = other;
  ASSERT_TRUE(by_matches(&theta));
  EXPECT_LT((theta - Vec3(0, 0, 0.5)).norm(), 1e-6);
}

TEST_F(TextLimits, OneRoundIsEnoughForMatchesThatAgree) {
  options.plane_rounds = 1;
  Vec3 theta = other;
  ASSERT_TRUE(by_matches(&theta));
  EXPECT_LT((theta - Vec3(0, 0, 0.5)).norm(), 1e-6);
}

TEST_F(TextLimits, WithoutARoundNothingIsMadeUp) {
  options.plane_rounds = 0;
  Vec3 theta = other;
  EXPECT_TRUE(plane_from_inside_points(options, inside, patch, &theta));
  EXPECT_NEAR(1 / theta.dot(patch.camera.unproject(centroid(patch.quad))), 2, 1e-9) << "the guess at their depth";
  theta = other;
  EXPECT_FALSE(by_matches(&theta));
}

TEST_F(TextLimits, WithoutALeastNumberOfPointsThereStillMustBeSome) {
  options.min_corners = 0;
  options.min_parallax = -1;
  Vec3 theta = other;
  EXPECT_FALSE(plane_from_inside_points(options, {}, patch, &theta));
  host.clear();
  target.clear();
  EXPECT_FALSE(plane_from_text_matches(options, {}, {}, T_t_h, 300, Vec3(0, 0, 1), &theta));
}

}  // namespace landmarks_test
