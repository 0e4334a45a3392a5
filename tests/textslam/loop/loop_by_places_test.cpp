// A loop that points alone close: far more drift than a search around the expected pose bridges.
#include <gtest/gtest.h>

#include "textslam/loop/loop_closure.hpp"
#include "textslam/relocalise/places_support.hpp"

namespace textslam {
namespace loop_by_places_test {

using namespace places_support;

// After a walk round something the camera is back. Key frames 5 and 6 show what 0 and 1 showed, and are mapped where
// the drift has carried them.
class LoopByPlacesTest : public PlacesTest {
 protected:
  LoopByPlacesTest() {
    for (const Vec3& t : {Vec3(0, 0, -way), Vec3(way, 0, -way), Vec3(way, 0, 0)}) {
      const Image<std::uint8_t> grey(map.width, map.height, 90);
      Frame frame;
      frame.image = std::make_shared<const Pyramid>(grey.view(), parameters.pyramid_levels);
      map.keyframes.push_back({frame, {Eigen::Matrix3d::Identity(), t}, {}});
    }
    std::vector<SE3d> truth;
    for (const double turn : {8.0, 11.0}) {
      truth.push_back(around(turn * kDegree, 1.1, 0));
      const SE3d T_w_c = truth.back().inverse();
      map.keyframes.push_back({frame_at(truth.back()), {drift.R * T_w_c.R, drift * T_w_c.t}, {}});
    }
    std::vector<Track> corners;
    add_corners(map.keyframe(5).frame, map.camera, 5, {}, parameters, corners);
    for (const Track& corner : corners) {
      const SE3d T_w_c = truth[0].inverse();
      const Vec3 ray = T_w_c.R * ray_of(map.camera, corner.px.cast<double>());
      const Vec3 p = hit(T_w_c.t, ray, nullptr);
      map.points.push_back({drift * p});
      for (int k = 0; k < 2; ++k)
        add_observation(map, static_cast<int>(map.points.size()) - 1, 5 + k,
                        map.camera.project(truth[static_cast<std::size_t>(k)] * p));
    }
    local = local_map(map, parameters, 6);
  }

  const double way = 6;
  const SE3d drift = moved({0.8, 0.3, -0.5}, {0.05, 0.3, -0.1});
  LocalMap local;
};

TEST_F(LoopByPlacesTest, PointsAloneCloseALoop) {
  ASSERT_TRUE(local.has_keyframe(5));
  ASSERT_FALSE(local.has_keyframe(0));
  const Loop loop = find_loop(map, local, parameters);
  ASSERT_TRUE(loop.ok);
  EXPECT_EQ(loop.keyframe, 6);
  EXPECT_LE(loop.met, 1);
  const SE3d back = drift.inverse();
  EXPECT_NEAR(loop.link.S_a_b.scale, 1, 0.01);
  EXPECT_LT((loop.link.S_a_b.R * back.R.transpose() - Eigen::Matrix3d::Identity()).norm(), 0.01);
  EXPECT_LT((loop.link.S_a_b.t - back.t).norm(), 0.03);
}

TEST_F(LoopByPlacesTest, NoDriftTakesACameraFarAway) {
  parameters.loop_most_drift = 0.01;
  EXPECT_FALSE(find_loop(map, local, parameters).ok);
}

}  // namespace loop_by_places_test
}  // namespace textslam
