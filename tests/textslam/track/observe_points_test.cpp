// The points of a map, found once more in key frames that do not observe them.
#include "textslam/track/observe_points.hpp"

#include <gtest/gtest.h>

#include "textslam/relocalise/places_support.hpp"

namespace textslam {
namespace observe_points_test {

using namespace places_support;

class ObservePoints : public PlacesTest {
 protected:
  int add_keyframe(const SE3d& T_w_c, const Frame& frame) {
    map.keyframes.push_back({frame, T_w_c, {}});
    return map.newest_keyframe();
  }
};

TEST_F(ObservePoints, AKeyFrameThatShowsPointsObservesThem) {
  const std::size_t before = map.keyframe(0).points.size();
  // The pose is known to a pixel: 5 mm at 2.6 m.
  const SE3d truth = moved({0.3, 0.05, 0.1}, {0, 0.05, 0}), known = moved({0.305, 0.05, 0.1}, {0, 0.05, 0});
  const int added = add_keyframe(known, frame_at(truth.inverse()));
  const int found = observe_points_again(map, parameters);
  EXPECT_GT(found, static_cast<int>(map.points.size()) * 7 / 10);
  EXPECT_EQ(map.keyframe(added).points.size(), static_cast<std::size_t>(found));
  EXPECT_EQ(map.keyframe(0).points.size(), before) << "what was observed is not observed twice";
  int exact = 0;
  for (const int point : map.keyframe(added).points) {
    const Vec2* const px = observed_in(map.point(point).observations, added);
    ASSERT_TRUE(px);
    exact += (*px - map.camera.project(truth.inverse() * map.point(point).p_w)).norm() < 0.3 ? 1 : 0;
  }
  EXPECT_GT(exact, found * 9 / 10) << "measured in the image, not expected by the pose";
  EXPECT_EQ(observe_points_again(map, parameters), 0);
}

TEST_F(ObservePoints, WhatIsNotThereIsNotObserved) {
  const SE3d T_w_c = moved({0.3, 0.05, 0.1}, {0, 0.05, 0});
  paper = 100;
  const int other = add_keyframe(T_w_c, frame_at(T_w_c.inverse()));
  paper = 1;
  // A pose that is ten pixels off explains none of them.
  const int wrong = add_keyframe(moved({0.35, 0.05, 0.1}, {0, 0.05, 0}), frame_at(T_w_c.inverse()));
  observe_points_again(map, parameters);
  // A patch shows one or two spots of the paper, so that one in twenty looks like another by chance.
  EXPECT_LT(map.keyframe(other).points.size(), map.points.size() / 14) << "the walls have another paper";
  EXPECT_LT(map.keyframe(wrong).points.size(), map.points.size() / 50);
}

TEST_F(ObservePoints, CulledKeyFramesAndBadPointsStayOut) {
  const SE3d T_w_c = moved({0.3, 0.05, 0.1}, {0, 0.05, 0});
  const int added = add_keyframe(T_w_c, {});
  map.keyframe(added).culled = true;
  drop_point(map, 0);
  EXPECT_EQ(observe_points_again(map, parameters), 0);
  EXPECT_TRUE(map.point(0).observations.empty());
}

}  // namespace observe_points_test
}  // namespace textslam
