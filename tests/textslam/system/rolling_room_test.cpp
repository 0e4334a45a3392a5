// The rendered room through a rolling shutter: with its readout, known or estimated, poses and planes are as without.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "textslam/calibrate/frame_pairs.hpp"
#include "textslam/run_camera.hpp"
#include "textslam/system/room_run_support.hpp"

namespace textslam {
namespace rolling_room_test {

constexpr int kFrames = 80;

// Rendered once for all.
const ShortRoom& rolling_room() {
  static const ShortRoom room(kFrames, "shutter");
  return room;
}

TEST(RollingRoom, PosesAndPlanesKnowTheRows) {
  const ShortRoom& room = rolling_room();
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
    EXPECT_EQ(summary.readout_estimated, system == &estimated);
  }
  // What is asked above is no matter of course.
  const RunSummary without = run_on(room, ignored);
  EXPECT_TRUE(!is_aligned(without) || without.trajectory.ate.rmse > 5e-3);
}

// By the images alone, before there is a map.
TEST(RollingRoom, TurnsTellTheReadout) {
  const ShortRoom& room = rolling_room();
  std::vector<std::size_t> frames(kFrames);
  std::iota(frames.begin(), frames.end(), 0);
  const auto follow = [&](const Sequence& sequence, std::size_t most) {
    return follow_frames(sequence, frames, most, Parameters(), [](const auto&, std::size_t) { return true; });
  };
  const std::vector<FramePair> pairs = follow(room.sequence(), 1000);
  ASSERT_EQ(pairs.size(), frames.size() - 1);
  for (const FramePair& pair : pairs) {
    EXPECT_NEAR(pair.seconds, 1 / room.sequence().camera.fps, 1e-6);
    EXPECT_GT(pair.rays.size(), 100U);
    for (const RayPair& rays : pair.rays) {
      EXPECT_NEAR(rays.ray_a.norm() * rays.ray_b.norm(), 1, 1e-12);
      EXPECT_LE(std::max(std::abs(rays.row_a), std::abs(rays.row_b)), 0.5);
      // What moved by more than a tenth of the image in 33 ms was followed to somewhere else.
      EXPECT_LT(std::abs(rays.row_b - rays.row_a), 0.2);
    }
  }
  const TurnReadout told = readout_of_turns(pairs);
  EXPECT_TRUE(told.determined) << told.readout << " +- " << told.sigma;
  EXPECT_GT(told.readout, 0.012);
  EXPECT_LT(told.readout, 0.035);

  EXPECT_EQ(follow(room.sequence(), 10).size(), 9U);
  const auto until_seven = [](const std::vector<FramePair>& some, std::size_t) { return some.size() < 7; };
  EXPECT_EQ(follow_frames(room.sequence(), frames, 1000, Parameters(), until_seven).size(), 7U);
  Sequence broken = room.sequence();
  broken.frames[5].path += ".gone";
  EXPECT_EQ(follow(broken, 1000).size(), 4U) << "the frames before it are there all the same";
}

// A readout that nobody speaks of is looked for, and taken where it counts.
TEST(RollingRoom, TheRunKnowsTheReadout) {
  const ShortRoom& room = rolling_room();
  std::vector<std::size_t> frames(kFrames);
  std::iota(frames.begin(), frames.end(), 0);
  CalibrationOptions slight, usual;
  slight.least_shear = 1e-4;
  const auto run = [&](const RunOptions& options, bool is_said, const CalibrationOptions& calibration) {
    Sequence sequence = room.sequence();
    sequence.camera.knows_readout = is_said;
    sequence.camera.shutter.readout = is_said ? 0.07 : 0;
    const bool estimates = know_turns(options, frames, &sequence, calibration);
    return std::make_pair(estimates, sequence.camera.shutter.readout);
  };
  EXPECT_EQ(run({}, true, slight), std::make_pair(false, 0.07)) << "the camera file says it";
  EXPECT_EQ(run({}, false, usual), std::make_pair(false, 0.0)) << "this camera turns slowly";
  const auto [estimates, readout] = run({}, false, slight);
  EXPECT_TRUE(estimates);
  EXPECT_GT(readout, 0.012);
  EXPECT_LT(readout, 0.035);
  RunOptions given;
  given.readout = 0;
  EXPECT_EQ(run(given, false, slight), std::make_pair(false, 0.0));
  RunOptions asked;
  asked.parameters.estimate_readout = true;
  EXPECT_EQ(run(asked, false, usual), std::make_pair(true, readout)) << "whether it counts or not";
  EXPECT_EQ(run(asked, true, usual), std::make_pair(true, readout)) << "whatever the camera file says";
}

// What is known before the map bounds what a map may take it for.
TEST(RollingRoom, TheMapStaysByWhatWasKnown) {
  const ShortRoom& room = rolling_room();
  const CameraModel& camera = room.sequence().camera;
  Parameters parameters;
  parameters.estimate_readout = true;
  textplane::RollingShutter shutter = camera.shutter;
  shutter.readout = 0.06;
  System system(camera.pinhole(), camera.width, camera.height, parameters, shutter);
  EXPECT_NEAR(run_on(room, system).readout, 0.9 * 0.06, 1e-12) << "it is .03";
}

double rmse(const Similarity& alignment, const std::vector<StampedPose>& poses, const std::vector<Vec3>& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) sum += (alignment * poses[i].T_w_c.t - truth[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(poses.size()));
}

// Time stamps may belong to any row. The truth is that of the middle row, at the frames' times; between two frames it
// is nearly straight. The alignment is that of poses of the middle row: one of other rows would hide most of the time
// between.
TEST(RollingRoom, TimeStampsBelongToAnyRow) {
  const ShortRoom& room = rolling_room();
  const Sequence& sequence = room.sequence();
  const CameraModel& camera = sequence.camera;
  System middle(camera.pinhole(), camera.width, camera.height, {}, camera.shutter);
  const RunSummary aligned = run_on(room, middle);
  ASSERT_TRUE(is_aligned(aligned));
  for (const double row : {0., camera.height - 1.}) {
    textplane::RollingShutter shutter = camera.shutter;
    shutter.row0 = row;
    System system(camera.pinhole(), camera.width, camera.height, {}, shutter);
    const RunSummary summary = run_on(room, system);
    EXPECT_EQ(summary.tracked, static_cast<std::size_t>(kFrames));
    const double frames_from_middle = camera.shutter.time(row) * camera.fps;
    ASSERT_NEAR(std::abs(frames_from_middle), 0.45, 1e-9);
    for (const bool live : {false, true}) {
      std::vector<StampedPose> poses = live ? live_trajectory(system) : final_trajectory(system);
      std::vector<Vec3> at_row, at_middle;
      // The first poses have no motion yet: a map begins with two frames that are far apart.
      poses.erase(poses.begin(), poses.begin() + 20);
      poses.pop_back();
      for (const StampedPose& pose : poses) {
        const auto here =
            std::lower_bound(sequence.groundtruth.begin(), sequence.groundtruth.end(), pose,
                             [](const auto& a, const auto& b) { return a.timestamp < b.timestamp - 1e-6; });
        const auto beside = row == 0 ? here - 1 : here + 1;
        at_middle.push_back(here->T_w_c.t);
        at_row.push_back(here->T_w_c.t + std::abs(frames_from_middle) * (beside->T_w_c.t - here->T_w_c.t));
      }
      const Similarity& alignment = (live ? aligned.live : aligned.trajectory).alignment;
      EXPECT_LT(rmse(alignment, poses, at_row), 2.5e-3) << "m, row " << row << ", live " << live;
      EXPECT_GT(rmse(alignment, poses, at_middle), 5e-3) << "a wrong row would pass";
    }
  }
}

}  // namespace rolling_room_test
}  // namespace textslam
