// Visits to one scene: the signs stay, path and light do not.
#include "renderer/walk.hpp"

#include <gtest/gtest.h>

#include "renderer/kinds.hpp"

namespace textslam {
namespace {

TEST(Walk, SignsStayAndThePathIsAnother) {
  const Shot first = make_shot("room", 3, 320, 240), second = make_shot("room", 3, 320, 240, 1),
             third = make_shot("room", 3, 320, 240, 2);
  ASSERT_EQ(first.scene.signs().size(), second.scene.signs().size());
  for (std::size_t i = 0; i < first.scene.signs().size(); ++i) {
    EXPECT_EQ(first.scene.signs()[i].word, second.scene.signs()[i].word);
    EXPECT_EQ(first.scene.signs()[i].corner, second.scene.signs()[i].corner);
  }
  EXPECT_GT((first.motion(1).t - second.motion(1).t).norm(), 0.05);
  EXPECT_GT((third.motion(1).t - second.motion(1).t).norm(), 0.05);
  EXPECT_NE(first.sensor(1).gain, second.sensor(1).gain);
}

TEST(Walk, NoneIsTheKindAsItIs) {
  EXPECT_EQ(seed_of_walk(3, 0), 3u);
  EXPECT_NE(seed_of_walk(3, 1), seed_of_walk(3, 2));
  const Shot one = make_shot("corridor", 3, 320, 240), same = make_shot("corridor", 3, 320, 240, 0);
  EXPECT_EQ(one.motion(2).t, same.motion(2).t);
}

// The room is 4.8 by 4.2 m, with furniture along its walls.
TEST(Walk, TheCameraStaysWithinTheWalls) {
  for (int walk = 1; walk < 10; ++walk) {
    const Shot shot = make_shot("loop", 1, 320, 240, walk);
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
