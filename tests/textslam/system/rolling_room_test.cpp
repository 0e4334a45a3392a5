// The rendered room through a rolling shutter: with its readout, known or estimated, poses and planes are as without.
#include <gtest/gtest.h>

#include "textslam/system/room_run_support.hpp"

namespace textslam {
namespace rolling_room_test {

TEST(RollingRoom, PosesAndPlanesKnowTheRows) {
  constexpr int kFrames = 80;
  const ShortRoom room(kFrames, "shutter");
  const CameraModel& camera = room.sequence().camera;
  ASSERT_EQ(camera.shutter.readout, 0.03);
  Parameters unknown;
  unknown.estimate_readout = true;
  textplane::RollingShutter none = camera.shutter;
  none.readout = 0;
  System known(camera.pinhole(), camera.width, camera.height, {}, camera.shutter),
      estimated(camera.pinhole(), camera.width, camera.height, unknown, none),
      ignored(camera.pinhole(), camera.width, camera.height, {}, none);
  for (System* system : {&known, &estimated}) {
    const RunSummary summary = run_on(room, *system);
    ASSERT_TRUE(is_aligned(summary));
    EXPECT_EQ(summary.tracked, static_cast<std::size_t>(kFrames));
    EXPECT_LT(summary.trajectory.ate.rmse, 2.5e-3) << "m";
    EXPECT_GE(summary.text.mapped, 3);
    EXPECT_EQ(summary.text.false_texts, 0);
    EXPECT_LT(summary.text.angle.median, 0.6) << "degrees";
    // So few and small images tell the readout to 1.5 ms (one standard deviation, by the curvature of the cost).
    EXPECT_NEAR(summary.readout, 0.03, system == &known ? 0 : 0.0045);
    EXPECT_EQ(summary.readout, system->map().shutter.readout);
  }
  // What is asked above is no matter of course.
  const RunSummary without = run_on(room, ignored);
  EXPECT_TRUE(!is_aligned(without) || without.trajectory.ate.rmse > 5e-3);
}

}  // namespace rolling_room_test
}  // namespace textslam
