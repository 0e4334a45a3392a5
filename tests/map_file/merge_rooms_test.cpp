// Two walks through a rendered room, each mapped on its own, in one map.
#include <gtest/gtest.h>

#include "io/evaluate.hpp"
#include "io/io_support.hpp"
#include "renderer/render_sequence.hpp"
#include "support/long_test.hpp"
#include "textslam/run.hpp"
#include "textslam_map/map_queries.hpp"
#include "textslam_map/merge_maps.hpp"

namespace textslam {
namespace {

class MergeRooms : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }
  // A map of a walk, saved as `name`.db.
  void map_walk(const std::string& name, std::uint64_t seed, int walk, int frames) const {
    RenderOptions room;
    room.output = path(name);
    room.seed = seed;
    room.walk = walk;
    room.frames = frames;
    room.width = 320;
    room.height = 240;
    render_sequence(room);
    RunOptions options;
    options.sequence = path(name);
    options.output = path("out_" + name);
    options.report = false;
    options.save_map = path(name + ".db");
    ASSERT_EQ(run(options).error, "");
  }
  // Of the key frames of a session of the map, aligned as those of the first are.
  std::vector<double> errors_of(const LoadedMap& map, int session, const std::string& name) const {
    const auto estimate = poses_of(map, 1), truth = read_tum(path("first/groundtruth.txt"));
    const Similarity alignment = evaluate_trajectory(estimate, truth, estimate.size()).alignment;
    const auto poses = poses_of(map, session), right = read_tum(path(name + "/groundtruth.txt"));
    std::vector<double> errors;
    for (const PosePair& pair : associate(poses, right, 0.01))
      errors.push_back((alignment * poses[pair.estimate].T_w_c.t - right[pair.truth].T_w_c.t).norm());
    return errors;
  }

 private:
  static std::vector<StampedPose> poses_of(const LoadedMap& map, int session) {
    std::vector<StampedPose> poses;
    for (const auto& [id, source] : map.record.sources)
      if (source.session == session)
        poses.push_back({map.map.keyframe(id).frame.timestamp, map.map.keyframe(id).T_w_c});
    return poses;
  }
  TemporaryFolder folder_;
};

TEST_F(MergeRooms, TwoWalksAreOneMap) {
  TEXTPLANE_LONG_TEST();
  map_walk("first", 1, 0, 80);
  map_walk("second", 1, 1, 80);
  const std::string out = path("merged.db"), said = merge_map_files(path("first.db"), path("second.db"), out);
  ASSERT_NE(said, "");
  EXPECT_EQ(problems_of(out), std::vector<std::string>());
  const LoadedMap a = load_map(path("first.db"), {}), b = load_map(path("second.db"), {}), merged = load_map(out, {});
  EXPECT_EQ(merged.map.keyframe_ids().size(), a.map.keyframe_ids().size() + b.map.keyframe_ids().size());
  const std::vector<double> first = errors_of(merged, 1, "first"), second = errors_of(merged, 2, "second");
  ASSERT_GE(second.size(), 3u);
  EXPECT_LT(error_statistics(first).max, 0.05);
  EXPECT_LT(error_statistics(second).median, 0.05) << said;
  EXPECT_LT(error_statistics(second).max, 0.06) << said;

  map_walk("elsewhere", 7, 0, 60);
  EXPECT_EQ(merge_map_files(path("first.db"), path("elsewhere.db"), path("none.db")), "");
  EXPECT_FALSE(std::filesystem::exists(path("none.db")));
}

}  // namespace
}  // namespace textslam
