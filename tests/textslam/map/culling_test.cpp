// Key frames that add nothing go, those that anything rests on stay.
#include "textslam/map/culling.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "textslam/map/observations.hpp"
#include "textslam/track/pose_refit.hpp"

namespace textslam {
namespace culling_test {

constexpr int kKeyFrames = 60;
constexpr int kPoints = 20;

// Every key frame sees every point.
class KeyframeCullingTest : public testing::Test {
 protected:
  KeyframeCullingTest() {
    map.keyframes.resize(kKeyFrames);
    for (int k = 0; k < kKeyFrames; ++k) {
      map.keyframe(k).frame.index = 5 * k;
      map.keyframe(k).frame.image = std::make_shared<const Pyramid>();
    }
    map.points.resize(kPoints);
    for (int p = 0; p < kPoints; ++p)
      for (int k = 0; k < kKeyFrames; ++k) add_observation(map, p, k, {p, k});
  }
  // Leaves a point with key frame `k` and so many others.
  void keep_others(int point, int k, int others) {
    const auto all = map.point(point).observations;
    int kept = 0;
    for (const PointObservation& o : all)
      if (o.keyframe != k && ++kept > others) remove_observation(map, point, o.keyframe);
  }
  void add_text(TextState state, int host, int targets) {
    TextObject text;
    text.id = static_cast<int>(map.texts.size());
    text.state = state;
    text.host = host;
    for (int k = 0; k < kKeyFrames && targets > 0; ++k)
      if (k != host && k != 1) {
        text.views.push_back(k);
        --targets;
      }
    map.texts.push_back(text);
  }
  int next(int from) const { return find_redundant_keyframe(map, parameters, {}, from); }

  Map map;
  Parameters parameters;
};

TEST_F(KeyframeCullingTest, TheFirstAndTheNewestStay) {
  const int last = kKeyFrames - 1 - parameters.window_frames;
  EXPECT_EQ(next(0), 1);
  EXPECT_EQ(next(last), last);
  EXPECT_EQ(next(last + 1), -1);
}

TEST_F(KeyframeCullingTest, OnlyWhereNearlyAllPointsAreSeenByManyOthers) {
  const int few = static_cast<int>((1 - parameters.redundant_share) * kPoints + 1e-9);
  for (int p = 0; p < few; ++p) keep_others(p, 1, parameters.redundant_views - 1);
  EXPECT_EQ(next(1), 1);
  keep_others(few, 1, parameters.redundant_views);
  EXPECT_EQ(next(1), 1) << "as many as are asked for";
  keep_others(few, 1, parameters.redundant_views - 1);
  EXPECT_GT(next(1), 1) << "one too few";
}

TEST_F(KeyframeCullingTest, TheHostOfATextStaysUntilTheTextIsDropped) {
  add_text(TextState::candidate, 1, 0);
  EXPECT_EQ(next(1), 2);
  map.texts[0].state = TextState::dropped;
  EXPECT_EQ(next(1), 1);
}

TEST_F(KeyframeCullingTest, AKeyFrameThatATextNeedsStays) {
  add_text(TextState::mapped, kKeyFrames - 1, parameters.redundant_views);
  EXPECT_EQ(next(2), 2) << "it has the host and the other targets";
  map.texts[0].views.pop_back();
  EXPECT_EQ(next(2), parameters.redundant_views) << "the first that does not show it";
}

TEST_F(KeyframeCullingTest, NothingOutsideTheLocalMapIsTouched) {
  LocalMap local;
  local.keyframe_in.assign(kKeyFrames, 0);
  local.keyframe_in[7] = 1;
  EXPECT_EQ(find_redundant_keyframe(map, parameters, local, 1), 7);
  EXPECT_EQ(find_redundant_keyframe(map, parameters, local, 8), -1);
}

TEST_F(KeyframeCullingTest, WhatGoesLeavesNoTrace) {
  add_text(TextState::mapped, 20, 30);
  keep_others(0, 2, 1);  // is left with one observation
  Track track;
  track.px = {5, 4};
  track.observations = {{1, {3, 4}}, {2, {4, 4}}, {3, {5, 4}}};
  std::vector<Track> tracks = {track};
  cull_keyframe(map, 2);
  forget_keyframe(2, tracks);

  const KeyFrame& gone = map.keyframe(2);
  EXPECT_TRUE(gone.culled);
  EXPECT_EQ(gone.frame.image, nullptr);
  EXPECT_TRUE(gone.points.empty());
  EXPECT_TRUE(map.point(0).bad);
  for (const MapPoint& point : map.points)
    for (const PointObservation& o : point.observations) EXPECT_NE(o.keyframe, 2);
  for (const int target : map.texts[0].views) EXPECT_NE(target, 2);
  ASSERT_EQ(tracks[0].observations.size(), 2U);
  EXPECT_EQ(tracks[0].observations[1].keyframe, 3);

  const std::vector<int> ids = map.keyframe_ids();
  EXPECT_EQ(ids.size(), static_cast<std::size_t>(kKeyFrames - 1));
  for (const int id : ids) EXPECT_NE(id, 2);
  EXPECT_EQ(keyframe_before(map, 3), 1);
  EXPECT_EQ(next(2), 3);
}

TEST_F(KeyframeCullingTest, CullingEndsWithWhatIsAskedFor) {
  std::vector<Track> tracks;
  for (int id = 0; (id = next(id)) >= 0;) cull_keyframe(map, id);
  for (const MapPoint& point : map.points)
    EXPECT_GE(static_cast<int>(point.observations.size()), parameters.redundant_views);
  EXPECT_EQ(next(0), -1);
  EXPECT_EQ(static_cast<int>(map.keyframe_ids().size()),
            std::max(parameters.window_frames + 1, parameters.redundant_views));
}

TEST_F(KeyframeCullingTest, SeenByAKeyFrameIsThinnedEvenly) {
  EXPECT_EQ(seen_points(tracks_of_keyframe(map, 5), 1000).size(), static_cast<std::size_t>(kPoints));
  const std::vector<SeenPoint> seen = seen_points(tracks_of_keyframe(map, 5), kPoints / 2);
  ASSERT_EQ(seen.size(), static_cast<std::size_t>(kPoints / 2));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i].point, static_cast<int>(2 * i));
    EXPECT_EQ(seen[i].px, Vec2f(static_cast<float>(2 * i), 5));
  }
}

}  // namespace culling_test
}  // namespace textslam
