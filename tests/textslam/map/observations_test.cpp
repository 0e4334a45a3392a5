// How well a map explains where its points were seen.
#include "textslam/map/observations.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace textslam {
namespace observations_test {

// Two key frames side by side, two points; seen where they project, but for the given errors.
TEST(Observations, ReprojectionErrorByHand) {
  Map map;
  map.camera = {500, 500, 319.5, 239.5};
  map.keyframes.resize(3);
  map.keyframe(1).T_w_c.t = Vec3(0.5, 0, 0);
  map.keyframe(2).culled = true;
  EXPECT_EQ(reprojection_error(map), 0) << "no points";
  for (const Vec3& p : {Vec3(0, 0, 2), Vec3(0.5, 0.2, 4)}) {
    map.points.emplace_back();
    map.points.back().p_w = p;
    for (const int id : {0, 1}) {
      const Vec3 in_camera = map.keyframe(id).T_w_c.inverse() * p;
      add_observation(map, static_cast<int>(map.points.size()) - 1, id, map.camera.project(in_camera));
    }
  }
  EXPECT_NEAR(reprojection_error(map), 0, 1e-9);
  map.point(0).observations[0].px += Vec2(3, 4);   // 5 px
  map.point(1).observations[1].px += Vec2(0, -1);  // 1 px
  EXPECT_NEAR(reprojection_error(map), std::sqrt((25.0 + 1.0) / 4), 1e-9);
  drop_point(map, 0);
  EXPECT_NEAR(reprojection_error(map), std::sqrt(0.5), 1e-9);
}

}  // namespace observations_test
}  // namespace textslam
