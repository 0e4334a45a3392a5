// Two maps that grew from one: what both inherited is once, and what either added is there.
#include <gtest/gtest.h>

#include "io/evaluate.hpp"
#include "map_file/map_file_support.hpp"
#include "textslam/map_file/schema.hpp"
#include "textslam_map/join_branches.hpp"
#include "textslam_map/map_queries.hpp"

namespace textslam {
namespace join_branches_test {

using namespace map_file_support;

class JoinBranches : public MapFileTest {
 protected:
  // The map with a session, a key frame, a point and a reading more.
  LoadedMap grown(const std::string& started, double to, const std::string& word) const {
    LoadedMap branch = load();
    branch.record.sessions.push_back({2, started, "rooms/" + word, "textslam", "text", "0.1.0", 10, 9});
    const SE3d T_c_w = moved({to, 0, 0}, {0, 0, 0});
    branch.map.keyframes.push_back({frame_at(T_c_w), T_c_w.inverse(), {}});
    const int id = branch.map.newest_keyframe();
    branch.map.keyframe(id).frame.timestamp = 100 + to;
    branch.record.sources[id] = {2, "images/new.png"};
    branch.map.points.push_back({{to, 0.3, 3}});
    for (const int keyframe : {0, id})
      add_observation(branch.map, static_cast<int>(branch.map.points.size()) - 1, keyframe, {40 + 10 * to, 30});
    add_observation(branch.map, 1, id, {60, 60 + to});
    branch.map.texts[0].votes[word] = 1.25;
    branch.map.texts[0].views.push_back(id);
    return branch;
  }
  LoadedMap joined(const LoadedMap& a, const LoadedMap& b) {
    auto both = join_branches(a, b, "b", parameters);
    EXPECT_TRUE(both.has_value());
    both->record.revision = 0;
    const std::string out = folder.path("joined.db");
    save_map(out, both->map, both->record);
    EXPECT_EQ(problems_of(out), std::vector<std::string>());
    return load_map(out, parameters);
  }
};

TEST_F(JoinBranches, WhatEitherAddedIsThereAndTheRestIsOnce) {
  save();
  const LoadedMap a = grown("2026-02-01 09:00:00", 0.3, "north"), b = grown("2026-02-01 09:05:00", -0.3, "south");
  const LoadedMap found = joined(a, b);
  ASSERT_EQ(found.record.sessions.size(), 3u);
  EXPECT_EQ(found.record.sessions[2].sequence, "rooms/south");
  EXPECT_EQ(found.map.keyframe_ids(), (std::vector<int>{0, 2, 3, 4}));
  EXPECT_EQ(found.record.sources.at(4).session, 3);
  EXPECT_EQ(found.record.sources.at(2).session, 1);
  EXPECT_LT((found.map.keyframe(4).T_w_c.t - b.map.keyframe(3).T_w_c.t).norm(), 1e-9);
  const std::vector<PointObservation>& seen = found.map.point(1).observations;
  ASSERT_EQ(seen.size(), 4u);
  EXPECT_EQ(seen[3].keyframe, 4);
  EXPECT_EQ(seen[3].px, Vec2(60, 59.7));
  EXPECT_EQ(found.map.point(1).visible, map.point(1).visible);
  EXPECT_EQ(std::count_if(found.map.points.begin(), found.map.points.end(), [](const MapPoint& p) { return !p.bad; }),
            6);
  const TextObject& text = found.map.text(0);
  EXPECT_EQ(text.votes.at("EXIT"), map.texts[0].votes.at("EXIT"));
  EXPECT_EQ(text.votes.at("north"), 1.25);
  EXPECT_EQ(text.votes.at("south"), 1.25);
  EXPECT_EQ(text.views, (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(text.detections, map.texts[0].detections);
  EXPECT_EQ(std::count_if(found.map.texts.begin(), found.map.texts.end(),
                          [](const TextObject& t) { return t.state == TextState::mapped; }),
            3);
}

// One robot's adjustment has moved what both have, and has another scale.
TEST_F(JoinBranches, TheOtherWorldIsBroughtToThisOne) {
  save();
  const LoadedMap a = grown("2026-02-01 09:00:00", 0.3, "north");
  LoadedMap b = grown("2026-02-01 09:05:00", -0.3, "south");
  const Vec3 right = b.map.keyframe(3).T_w_c.t;
  const Similarity S{1.02, textplane::so3_exp<double>(Vec3(0.01, -0.02, 0.03)), {0.1, 0, -0.1}};
  for (KeyFrame& keyframe : b.map.keyframes) keyframe.T_w_c = S * keyframe.T_w_c;
  for (MapPoint& point : b.map.points) point.p_w = S * point.p_w;
  for (TextObject& text : b.map.texts) text.theta /= S.scale;
  EXPECT_LT((joined(a, b).map.keyframe(4).T_w_c.t - right).norm(), 1e-9);
}

TEST_F(JoinBranches, AMapWithItselfIsItself) {
  save();
  const LoadedMap a = grown("2026-02-01 09:00:00", 0.3, "north");
  const LoadedMap found = joined(joined(a, a), a);
  EXPECT_EQ(found.map.keyframe_ids(), a.map.keyframe_ids());
  EXPECT_EQ(found.map.points.size(), a.map.points.size());
  EXPECT_EQ(found.map.texts.size(), a.map.texts.size());
  EXPECT_EQ(found.map.text(0).votes, a.map.text(0).votes);
  EXPECT_EQ(found.record.sessions.size(), 2u);
}

TEST_F(JoinBranches, StrangersAreNotJoined) {
  save();
  const LoadedMap a = load();
  LoadedMap b = a;
  b.record.sessions[0].started = "2026-03-01 09:00:00";
  const char* const words[] = {"PRINTER", "LIBRARY", "CANTEEN"};
  for (std::size_t i = 0; i < 3; ++i) b.map.texts[i].votes = {{words[i], 2}};
  EXPECT_FALSE(join_branches(a, b, "b", parameters).has_value());
  b.record.camera.raw = RadialTangential<double>{{262, 262, 159.5, 119.5}, -0.1, 0, 0, 0, 0};
  EXPECT_THROW(join_branches(a, b, "b", parameters), InputError);
}

// A map that takes the place of a file's is none of what that was pushed as.
TEST_F(JoinBranches, AnotherMapForgetsWhereTheFileCameFrom) {
  save();
  const auto origins = [&] { return open_map(file).integer("select count(*) from origins"); };
  Database(file, Access::write).execute("insert into origins values ('somewhere', 3, 1)");
  LoadedMap loaded = load();
  save_map(file, loaded.map, loaded.record);
  EXPECT_EQ(origins(), 1);
  save();
  EXPECT_EQ(origins(), 0);
}

}  // namespace join_branches_test
}  // namespace textslam
