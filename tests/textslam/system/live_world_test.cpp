// The world of live poses: it fits the poses given before as well as can be, whatever adjustments make of the map.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "textslam/system/short_room_support.hpp"

namespace textslam {
namespace live_world_test {

// Today's poses of all live frames but the newest, and those given for them.
struct Poses {
  std::vector<SE3d> now, given;
};
Poses poses_before(const System& system) {
  Poses poses;
  const auto& records = system.records();
  for (std::size_t i = 0; i + 1 < records.size(); ++i) {
    if (!records[i].live) continue;
    poses.now.push_back(system.final_pose(records[i]));
    poses.given.push_back(records[i].T_w_c_live);
  }
  return poses;
}

double squares(const Similarity& S, const Poses& poses) {
  double sum = 0;
  for (std::size_t i = 0; i < poses.now.size(); ++i) sum += (S * poses.now[i].t - poses.given[i].t).squaredNorm();
  return sum;
}

TEST(LiveWorld, FitsThePosesGivenBefore) {
  const ShortRoom room(80);
  const Sequence& sequence = room.sequence();
  const std::unique_ptr<System> made = room.system();
  System& system = *made;

  int keyframes = 0, better = 0;
  double most = 0;
  for (int i = 0; i < static_cast<int>(sequence.frames.size()); ++i) {
    Frame frame = room.load(i);
    frame.detections = read_detections(sequence, sequence.frames[static_cast<std::size_t>(i)]);
    const FrameRecord& record = system.process(frame);
    if (!record.live) continue;
    // The pose given is today's, in the live world.
    const SE3d expected = system.live_world() * system.final_pose(record);
    EXPECT_LT((record.T_w_c_live.t - expected.t).norm(), 1e-9) << "frame " << i;
    EXPECT_LT((record.T_w_c_live.R - expected.R).norm(), 1e-9) << "frame " << i;
    if (system.map().keyframe(record.keyframe).frame.index != i || record.keyframe < 3) continue;
    ++keyframes;
    const Poses poses = poses_before(system);
    Similarity best = system.live_world();
    ASSERT_EQ(align_poses(poses.now, poses.given, &best), Status::ok);
    EXPECT_NEAR(best.scale, system.live_world().scale, 1e-9);
    EXPECT_LT((best.t - system.live_world().t).norm(), 1e-9);
    EXPECT_LT((best.R - system.live_world().R).norm(), 1e-9);
    better += squares(system.live_world(), poses) < squares(Similarity(), poses);
    most = std::max(most, std::abs(system.live_world().scale - 1));
  }
  ASSERT_GE(keyframes, 5);
  EXPECT_EQ(better, keyframes);
  EXPECT_GT(most, 1e-5);  // the map's world did move
}

}  // namespace live_world_test
}  // namespace textslam
