// The local map: key frames that share points or texts, what they observe, and the map in two along its border.
#include <gtest/gtest.h>

#include <numeric>

#include "textslam/loop/loop_closure.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/track/tracker.hpp"

namespace textslam {
namespace local_map_test {

// Key frames in a row; each shares as many points as make neighbours with the next one.
class LocalMapTest : public testing::Test {
 protected:
  static constexpr int kKeyFrames = 10;

  LocalMapTest() {
    map.camera = {262, 262, 159.5, 119.5};
    map.width = 320;
    map.height = 240;
    map.keyframes.resize(kKeyFrames);
    for (int k = 0; k + 1 < kKeyFrames; ++k) share(parameters.local_min_shared, {k, k + 1});
  }
  // Points before the camera, seen by the given key frames.
  void share(int count, const std::vector<int>& keyframes) {
    for (int i = 0; i < count; ++i) {
      map.points.emplace_back();
      map.points.back().p_w = {0.05 * (static_cast<double>(map.points.size() % 20) - 10), 0, 2};
      for (const int k : keyframes) add_observation(map, static_cast<int>(map.points.size()) - 1, k, {160, 120});
    }
  }
  void add_text(TextState state, int host, const std::vector<int>& targets) {
    TextObject text;
    text.id = static_cast<int>(map.texts.size());
    text.state = state;
    text.host = host;
    text.views = targets;
    map.texts.push_back(text);
  }
  static std::vector<int> keyframes(const LocalMap& local) {
    std::vector<int> ids;
    for (int k = 0; k < kKeyFrames; ++k)
      if (local.has_keyframe(k)) ids.push_back(k);
    return ids;
  }

  Map map;
  Parameters parameters;
};

TEST_F(LocalMapTest, NeighboursAndTheirNeighboursWithAllTheirPoints) {
  EXPECT_EQ(keyframes(local_map(map, parameters, 9)), (std::vector<int>{7, 8, 9}));
  EXPECT_EQ(keyframes(local_map(map, parameters, 4)), (std::vector<int>{2, 3, 4, 5, 6}));
  const LocalMap local = local_map(map, parameters, 9);
  for (int id = 0; id < static_cast<int>(map.points.size()); ++id) {
    const auto& observations = map.point(id).observations;
    EXPECT_EQ(local.has_point(id), observations.back().keyframe >= 7) << id;
  }
  EXPECT_TRUE(local.has_point(static_cast<int>(map.points.size()))) << "born since";
  EXPECT_TRUE(LocalMap().has_point(0)) << "no limits";
}

TEST_F(LocalMapTest, AFewPointsMakeNoNeighbours) {
  share(parameters.local_min_shared - 1, {0, 9});
  EXPECT_EQ(keyframes(local_map(map, parameters, 9)), (std::vector<int>{7, 8, 9}));
  share(1, {0, 9});
  EXPECT_EQ(keyframes(local_map(map, parameters, 9)), (std::vector<int>{0, 1, 7, 8, 9}));
}

TEST_F(LocalMapTest, OneMappedTextMakesNeighbours) {
  add_text(TextState::tentative, 3, {9});
  EXPECT_EQ(keyframes(local_map(map, parameters, 9)), (std::vector<int>{7, 8, 9}));
  add_text(TextState::mapped, 4, {9});
  add_text(TextState::mapped, 0, {1, 2});
  add_text(TextState::mapped, 1, {5});
  const LocalMap local = local_map(map, parameters, 9);
  EXPECT_EQ(keyframes(local), (std::vector<int>{3, 4, 5, 7, 8, 9}));
  EXPECT_TRUE(local.has_text(0)) << "its host is in";
  EXPECT_TRUE(local.has_text(1));
  EXPECT_FALSE(local.has_text(2));
  EXPECT_TRUE(local.has_text(3)) << "a key frame that observes it is in";
}

TEST_F(LocalMapTest, AroundWhatAFrameSees) {
  std::vector<int> seen(static_cast<std::size_t>(parameters.local_min_shared));
  std::iota(seen.begin(), seen.end(), 0);  // of key frames 0 and 1
  EXPECT_EQ(keyframes(local_map(map, parameters, seen)), (std::vector<int>{0, 1, 2}));
  seen.pop_back();
  EXPECT_TRUE(keyframes(local_map(map, parameters, seen)).empty());
}

TEST_F(LocalMapTest, TheTrackerSeesNothingElse) {
  Frame frame;
  const Image<std::uint8_t> grey(map.width, map.height, 120);
  frame.image = std::make_shared<const Pyramid>(grey.view(), parameters.pyramid_levels);
  for (KeyFrame& keyframe : map.keyframes) keyframe.frame = frame;
  const LocalMap local = local_map(map, parameters, 9);
  Tracker tracker(map, parameters);
  tracker.start(frame, SE3d{}, {});
  const std::vector<int> all = tracker.track(frame).visible;
  tracker.look_for(&local);
  tracker.start(frame, SE3d{}, {});
  const std::vector<int> near = tracker.track(frame).visible;
  EXPECT_EQ(all.size(), map.points.size());
  EXPECT_EQ(near.size(), static_cast<std::size_t>(3 * parameters.local_min_shared));
  for (const int id : near) EXPECT_TRUE(local.has_point(id)) << id;
}

TEST_F(LocalMapTest, TheMapInTwoIsTheWholeMap) {
  add_text(TextState::mapped, 1, {2, 3});
  add_text(TextState::mapped, 8, {9});
  add_text(TextState::dropped, 0, {});
  map.points[0].bad = true;
  const LocalMap local = local_map(map, parameters, 9);
  const Map old = old_part(map, local), recent = recent_part(map, local);
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const MapPoint &whole = map.points[i], &was = old.points[i], &is = recent.points[i];
    EXPECT_EQ(is.bad, whole.bad || !local.has_point(static_cast<int>(i)));
    EXPECT_EQ(was.bad, whole.bad || local.has_point(static_cast<int>(i)));
    if (whole.bad) continue;
    EXPECT_EQ((was.bad ? is : was).observations.size(), whole.observations.size());
    EXPECT_TRUE((was.bad ? was : is).observations.empty());
  }
  for (const Map* part : {&old, &recent}) {
    ASSERT_EQ(part->keyframes.size(), map.keyframes.size());
    for (const KeyFrame& keyframe : part->keyframes)
      for (const int id : keyframe.points) EXPECT_FALSE(part->point(id).bad);
  }
  EXPECT_EQ(old.texts[0].state, TextState::mapped);
  EXPECT_EQ(recent.texts[0].state, TextState::dropped);
  EXPECT_EQ(old.texts[1].state, TextState::dropped);
  EXPECT_EQ(recent.texts[1].state, TextState::mapped);
  EXPECT_EQ(recent.texts[2].state, TextState::dropped);
}

}  // namespace local_map_test
}  // namespace textslam
