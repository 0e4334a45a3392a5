// Frames without a pose get theirs from the whole map, also where no frame beside them leads to it.
#include <gtest/gtest.h>

#include "textslam/report/summary.hpp"
#include "textslam/system/short_room_support.hpp"

namespace textslam {
namespace fill_in_test {

constexpr int kFrames = 90, kFirstDark = 50, kLastDark = 69;

// The light went out while the camera passed, and the frames `shown` of that time turn up afterwards.
RunSummary run(const ShortRoom& room, int first_shown, int last_shown, System& system) {
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = room.load(i);
    system.process(i < kFirstDark || i > kLastDark ? frame : ShortRoom::dark(frame));
  }
  system.finish();
  system.fill_in([&](int i) {
    const bool shown = i < kFirstDark || i > kLastDark || (i >= first_shown && i <= last_shown);
    return shown ? room.load(i) : ShortRoom::dark(room.load(i));
  });
  return summarise(system, room.sequence(), kFrames);
}

bool has_pose(const System& system, int index) {
  return system.records()[static_cast<std::size_t>(index)].state == FrameState::tracked;
}

TEST(FillIn, FindsFramesThatNoNeighbourLeadsTo) {
  const ShortRoom room(kFrames);
  const auto none = room.system(), some = room.system();
  const RunSummary without = run(room, kFrames, 0, *none), with = run(room, 58, 62, *some);
  for (int i = kFirstDark; i <= kLastDark; ++i) {
    EXPECT_FALSE(has_pose(*none, i)) << "frame " << i << " shows nothing";
    EXPECT_EQ(has_pose(*some, i), i >= 58 && i <= 62) << "frame " << i;
    EXPECT_FALSE(some->records()[static_cast<std::size_t>(i)].live);
  }
  EXPECT_EQ(with.tracked_live, without.tracked_live);
  ASSERT_TRUE(textplane::is_ok(with.trajectory.status));
  // As good as those that were tracked: both are of one map.
  EXPECT_LT(with.trajectory.ate.rmse, 1.2 * without.trajectory.ate.rmse);
  for (int i = 58; i <= 62; ++i) {
    const FrameRecord& record = some->records()[static_cast<std::size_t>(i)];
    EXPECT_GT(record.points, 30);
    EXPECT_GT(record.information.diagonal().minCoeff(), 0);
  }
}

}  // namespace fill_in_test
}  // namespace textslam
