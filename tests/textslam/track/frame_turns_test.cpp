// The motion of rows by the turns between frames, and rays behind rows that moved.
#include "textslam/track/frame_turns.hpp"

#include <gtest/gtest.h>

#include "textslam/common/rays.hpp"
#include "textslam/scene_support.hpp"

namespace textslam {
namespace frame_turns_test {

using namespace scene_support;

// A turn about one axis at an angular velocity that changes evenly, between the times a and b.
Eigen::Matrix3d turn_between(double a, double b, const Vec3& omega, const Vec3& change) {
  return textplane::so3_exp<double>(Vec3((b - a) * (omega + 0.5 * (a + b) * change)));
}

TEST(FrameTurnsTest, AnEvenlyChangingTurnIsKnownAtBothFrames) {
  const Vec3 axis = Vec3(0.3, 0.8, -0.2).normalized(), omega = 0.9 * axis, change = -2 * axis;
  FrameTurns turns;
  const std::vector<double> times = {0, 0.03, 0.07, 0.1};  // unevenly spaced
  turns.add(turn_between(times[0], times[1], omega, change), times[1] - times[0]);
  EXPECT_LT((turns.newest() - turns.before()).norm(), 1e-12) << "of one turn no change is known";
  EXPECT_NEAR(turns.unsure(), 0.5 * (omega + 0.015 * change).norm(), 1e-9);
  for (std::size_t i = 2; i < times.size(); ++i) {
    turns.add(turn_between(times[i - 1], times[i], omega, change), times[i] - times[i - 1]);
    EXPECT_LT((turns.newest() - (omega + times[i] * change)).norm(), 1e-9);
    EXPECT_LT((turns.before() - (omega + times[i - 1] * change)).norm(), 1e-9);
    if (i > 2) continue;
    EXPECT_NEAR(turns.unsure(), 0.25 * (times[i] - times[i - 2]) * change.norm(), 1e-9);
    EXPECT_EQ(turns.unsure(), turns.unsure_before());
  }
  EXPECT_LT(turns.unsure(), 1e-9) << "three turns change evenly";
  turns.clear();
  turns.add(turn_between(0, 0.03, omega, change), 0.03);
  EXPECT_EQ(turns.newest(), turns.before()) << "nothing of the frames before";
}

// A hand that shakes: what may be wrong is, in the mean of the squares, what is. Now and then that is twice as much, as
// the changes of three turns happen to be even.
TEST(FrameTurnsTest, AnUnevenTurnSaysItsError) {
  const Vec3 axis = Vec3(0.3, 0.8, -0.2).normalized();
  constexpr double kPeriod = 1.0 / 30, kLargest = 1.2;  // s; radians a s
  for (const double shake : {3.0, 6.0, 12.0}) {         // radians a s, of the phase
    SCOPED_TRACE(shake);
    const auto angle = [&](double t) { return kLargest / shake * std::sin(shake * t); };
    const auto speed = [&](double t) { return Vec3(kLargest * std::cos(shake * t) * axis); };
    FrameTurns turns;
    double newest = 0, before = 0, unsure = 0, unsure_before = 0;
    for (int i = 1; i < 200; ++i) {
      const double t = i * kPeriod;
      turns.add(textplane::so3_exp<double>(Vec3((angle(t) - angle(t - kPeriod)) * axis)), kPeriod);
      if (i < 4) continue;
      const double off = (turns.newest() - speed(t)).norm(), off_before = (turns.before() - speed(t - kPeriod)).norm();
      EXPECT_LT(off, 2.5 * turns.unsure()) << i;
      EXPECT_LT(off_before, 2.5 * turns.unsure_before()) << i;
      newest += off * off;
      before += off_before * off_before;
      unsure += turns.unsure() * turns.unsure();
      unsure_before += turns.unsure_before() * turns.unsure_before();
    }
    EXPECT_NEAR(std::sqrt(newest / unsure), 0.9, 0.1);
    EXPECT_NEAR(std::sqrt(before / unsure_before), 0.9, 0.1);
    EXPECT_LT(std::sqrt(unsure / 196), 0.1 * kLargest);
  }
}

TEST(FrameTurnsTest, RaysAtThePoseAreThoseOfWhatTheRowsShow) {
  textplane::RollingShutter shutter;
  shutter.readout = 0.03;
  shutter.rows = 480;
  shutter.row0 = 239.5;
  const auto rows = turning_rows({0.7, -1.2, 0.4}, shutter);
  EXPECT_EQ(rows->velocity.head<3>(), Vec3(Vec3::Zero()));
  const CameraView still = camera();
  const CameraView rolling{still.pinhole, still.lens, rows.get()};
  for (const Vec2& px : {Vec2(20, 10), Vec2(620, 470), Vec2(300, 239.5)}) {
    const Vec3 ray = ray_at_pose(rolling, px);
    EXPECT_NEAR(ray.z(), 1, 1e-12);
    Vec2 seen = Vec2::Zero();
    ASSERT_TRUE(show(rolling, 5 * ray, &seen));
    EXPECT_LT((seen - px).norm(), 1e-6);
    EXPECT_EQ(ray_at_pose(still, px), ray_of(still, px));
  }
  // As if there were no rows a corner would be off by ten pixels.
  EXPECT_GT((still.project(ray_at_pose(rolling, {20, 10})) - Vec2(20, 10)).norm(), 8);
}

}  // namespace frame_turns_test
}  // namespace textslam
