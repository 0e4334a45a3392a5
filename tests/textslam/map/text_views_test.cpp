// The map's points, as a text's surface asks for them.
#include "textslam/map/text_views.hpp"

#include <gtest/gtest.h>

namespace textslam {
namespace text_views_test {

class SurfacePointsTest : public testing::Test {
 protected:
  SurfacePointsTest() {
    map.camera = {525, 525, 319.5, 239.5};
    map.keyframes.resize(3);
    map.keyframes[1].T_w_c.t = Vec3(0.4, 0, 0);
    map.keyframes[2].T_w_c.t = Vec3(-0.4, 0, 0);
    map.points.resize(1);
    map.points[0].p_w = Vec3(0, 0, 2);
    for (int k = 0; k < 3; ++k) map.points[0].observations.push_back({k, Vec2::Zero()});
  }
  double variance(const Vec3& direction, double sigma = 1) const {
    return SurfacePoints{map, sigma}.text_point_variance(0, direction);
  }
  Map map;
};

TEST_F(SurfacePointsTest, ArePassedOnButForTheBadOnes) {
  const SurfacePoints points{map, 1};
  Vec3 p;
  EXPECT_EQ(points.text_point_count(), 1);
  EXPECT_TRUE(points.text_point(0, &p));
  EXPECT_EQ(p, map.points[0].p_w);
  map.points[0].bad = true;
  EXPECT_FALSE(points.text_point(0, &p));
}

// Across the view three pixels agree; in depth, two of them see it 0.4 aside: z^2 / (f b) each.
TEST_F(SurfacePointsTest, AreAsSureAsTheirObservations) {
  EXPECT_NEAR(std::sqrt(variance(Vec3::UnitY())), 2 / 525.0 / std::sqrt(3.0), 1e-5);
  EXPECT_NEAR(std::sqrt(variance(Vec3::UnitZ())), 4 / (525 * 0.4) / std::sqrt(2.0), 1e-3);
  EXPECT_NEAR(variance(Vec3::UnitZ(), 3), 9 * variance(Vec3::UnitZ()), 1e-9);
}

TEST_F(SurfacePointsTest, AreNotKnownByOneKeyFrameOrByCulledOnes) {
  const double three = variance(Vec3::UnitZ());
  map.keyframes[1].culled = true;
  EXPECT_GT(variance(Vec3::UnitZ()), three);
  map.keyframes[2].culled = true;
  EXPECT_FALSE(variance(Vec3::UnitZ()) > 0);
}

TEST_F(SurfacePointsTest, AKeyFrameWithoutAnImageShowsNothing) {
  map.keyframes[1].frame.noise = 3;
  const textplane::TextKeyframe keyframe = map.text_keyframe(1);
  EXPECT_EQ(keyframe.width(), 0);
  EXPECT_EQ(keyframe.noise, 3);
  EXPECT_EQ(keyframe.T_w_c.t, Vec3(0.4, 0, 0));
}

}  // namespace text_views_test
}  // namespace textslam
