// Visits to one scene: the signs stay, path and light do not.
#include "renderer/walk.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/kinds.hpp"

namespace textslam {
namespace {

TEST(Walk, SignsStayAndThePathIsAnother) {
  const Shot first = make_shot("room", 3, 320, 240), second = make_shot("room", 3, 320, 240, 1);
  ASSERT_EQ(first.scene.signs().size(), second.scene.signs().size());
  for (std::size_t i = 0; i < first.scene.signs().size(); ++i) {
    EXPECT_EQ(first.scene.signs()[i].word, second.scene.signs()[i].word);
    EXPECT_EQ(first.scene.signs()[i].corner, second.scene.signs()[i].corner);
  }
  EXPECT_GT((first.motion(1).t - second.motion(1).t).norm(), 0.05);
  EXPECT_NE(first.sensor(1).gain, second.sensor(1).gain);
}

// A visit without its scene, which takes seconds to paint.
Shot visit(int walk) {
  Shot shot;
  shot.motion = loop_motion(seed_of_walk(1, walk));
  shot.sensor = steady_sensor();
  take_walk(seed_of_walk(1, walk), &shot);
  return shot;
}

TEST(Walk, EachIsAnother) {
  EXPECT_EQ(seed_of_walk(3, 0), 3U);
  EXPECT_NE(seed_of_walk(3, 1), seed_of_walk(3, 2));
  EXPECT_GT((visit(1).motion(1).t - visit(2).motion(1).t).norm(), 0.05);
  EXPECT_NE(visit(1).sensor(1).gain, visit(2).sensor(1).gain);
}

// The room is 4.8 by 4.2 m, with furniture along its walls.
TEST(Walk, TheCameraStaysWithinTheWalls) {
  for (int walk = 1; walk < 100; ++walk) {
    const Shot shot = visit(walk);
    for (double t = 0; t < 12; t += 0.1) {
      const Vector3<double> in_room = shot.motion(t).t;
      EXPECT_LT(std::abs(in_room.x()), 1.6);
      EXPECT_LT(std::abs(in_room.y()), 1.6);
      EXPECT_GT(in_room.z(), 1);
      EXPECT_LT(in_room.z(), 2);
    }
  }
}

}  // namespace
}  // namespace textslam
