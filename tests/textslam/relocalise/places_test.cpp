// Relocalisation in a scene made by formula: a lost frame by the looks of points alone.
#include "textslam/relocalise/places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "textslam/lens_support.hpp"
#include "textslam/relocalise/places_support.hpp"

namespace textslam {
namespace places_test {

using namespace places_support;

TEST_F(PlacesTest, AnotherViewOfAPlaceIsFound) {
  ASSERT_GT(map.points.size(), 200u);
  expect_found(around(25 * kDegree, 1, 0));
  expect_found(around(-20 * kDegree, 1.5, 0));
  expect_found(around(20 * kDegree, 1 / 1.5, 0));
  expect_found(around(10 * kDegree, 1.2, 50 * kDegree));
}

class WidePlacesTest : public PlacesTest {
 protected:
  WidePlacesTest() : PlacesTest(&lens_support::wide_lens()) {}
};

TEST_F(WidePlacesTest, AnotherViewIsFoundBehindALens) {
  ASSERT_GT(map.points.size(), 200u);
  expect_found(around(20 * kDegree, 1, 0));
  expect_found(around(10 * kDegree, 1.2, 50 * kDegree));
}

TEST_F(PlacesTest, AnotherPlaceIsNotTakenForIt) {
  paper = 100;
  for (const SE3d& T_c_w : {SE3d{}, around(20 * kDegree, 1.2, 0)})
    EXPECT_FALSE(relocalise(map, parameters, frame_at(T_c_w)).ok);
  Frame black;
  const Image<std::uint8_t> none(map.width, map.height, 0);
  black.image = std::make_shared<const Pyramid>(none.view(), parameters.pyramid_levels);
  EXPECT_FALSE(relocalise(map, parameters, black).ok) << "a covered lens";
}

TEST_F(PlacesTest, LooksFollowThePointsOfAKeyFrame) {
  const Frame frame = frame_at(around(15 * kDegree, 1.2, 0));
  FrameLooks looks(frame, parameters);
  const MatchedPose before = pose_by_places(map, parameters, looks, {0});
  ASSERT_GT(before.inliers, 50);
  const auto kept = map.keyframe(0).looks;
  for (std::size_t i = 0; i < map.points.size(); i += 2) drop_point(map, static_cast<int>(i));
  const MatchedPose half = pose_by_places(map, parameters, looks, {0});
  EXPECT_GT(half.inliers, before.inliers / 4);
  EXPECT_LT(half.inliers, before.inliers * 3 / 4) << "what has left the map is not matched";
  EXPECT_EQ(map.keyframe(0).looks, kept) << "nothing is described again";
  const Vec3 p = hit(Vec3::Zero(), ray_of(map.camera, Vec2(300, 200)), nullptr);
  map.points.push_back({p});
  for (int k = 0; k < 2; ++k)
    add_observation(map, static_cast<int>(map.points.size()) - 1, k,
                    map.camera.project(map.keyframe(k).T_w_c.inverse() * p));
  pose_by_places(map, parameters, looks, {0});
  EXPECT_EQ(map.keyframe(0).looks->points.size(), map.keyframe(0).points.size()) << "a new point is described";
}

// The ranking compares strong corners, which stay what they are when a key frame gets points.
TEST_F(PlacesTest, TheRankingDescribesAKeyFrameOnce) {
  const Frame frame = frame_at(around(15 * kDegree, 1.2, 0));
  FrameLooks looks(frame, parameters);
  const auto rank = [&] { return rank_places(map, parameters, looks, {0, 1}, 2, 0); };
  const std::vector<PlaceRank> ranks = rank();
  ASSERT_FALSE(ranks.empty());
  const auto kept = map.keyframe(0).looks;
  EXPECT_TRUE(kept->looks.empty()) << "points are not described for it";
  map.points.emplace_back();
  add_observation(map, static_cast<int>(map.points.size()) - 1, 0, Vec2(300, 200));
  EXPECT_EQ(rank().size(), ranks.size());
  EXPECT_EQ(map.keyframe(0).looks, kept);
}

// As the frame of a key frame is described, to look for a loop, so is the key frame.
TEST_F(PlacesTest, AKeyFrameKeepsTheCornersOfItsFrame) {
  const Frame frame = frame_at(around(15 * kDegree, 1.2, 0));
  FrameLooks looks(frame, parameters);
  rank_places(map, parameters, looks, {0}, 1, 0);
  const std::vector<CornerLook> ranked = map.keyframe(0).looks->corners;
  map.keyframe(0).looks = nullptr;
  FrameLooks own(map.keyframe(0).frame, parameters);
  keep_corners(map, 0, own);
  const std::vector<CornerLook>& kept = map.keyframe(0).looks->corners;
  ASSERT_EQ(kept.size(), ranked.size());
  for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(kept[i].descriptor.bits, ranked[i].descriptor.bits) << i;
}

TEST_F(PlacesTest, DescriptorsTurnWithTheCamera) {
  const SE3d turned = moved({0, 0, 0}, {0, 0, 70 * kDegree});
  const SmoothedLevels levels(*map.keyframe(0).frame.image, 3), other(*frame_at(turned).image, 3);
  std::vector<double> same, different, turns;
  Descriptor before{};
  for (const MapPoint& point : map.points) {
    const Vec2 px = map.camera.project(point.p_w), then = map.camera.project(turned * point.p_w);
    Descriptor a, b;
    if (!levels.describe(px.cast<float>(), 2, &a) || !other.describe(then.cast<float>(), 2, &b)) continue;
    same.push_back(bits_apart(a, b));
    turns.push_back(std::abs(std::remainder(b.angle - a.angle - 70 * kDegree, 2 * M_PI)) / kDegree);
    different.push_back(bits_apart(before, b));
    before = a;
  }
  ASSERT_GT(same.size(), 100u);
  std::sort(same.begin(), same.end());
  std::sort(turns.begin(), turns.end());
  std::sort(different.begin(), different.end());
  EXPECT_LT(turns[turns.size() * 8 / 10], 10) << "degrees";
  EXPECT_LT(same[same.size() * 8 / 10], 50) << "of 256 bits";
  EXPECT_NEAR(different[different.size() / 2], 128, 20) << "as different as chance makes it";
}

TEST_F(PlacesTest, DescriptorsStayInTheImage) {
  const SmoothedLevels levels(*map.keyframe(0).frame.image, 3);
  Descriptor d;
  EXPECT_EQ(levels.levels(), 3);
  EXPECT_TRUE(levels.describe({320, 240}, 5.6, &d));
  EXPECT_FALSE(levels.describe({320, 240}, 8, &d)) << "there is no such level";
  EXPECT_FALSE(levels.describe({320, 240}, 0.5, &d));
  for (const float bad : {0.0F, 639.0F, -50.0F, 1e9F, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_FALSE(levels.describe({bad, 240}, 1, &d)) << bad;
  Descriptor a, all;
  a.bits[0] = 1;
  all.bits.fill(~std::uint64_t{0});
  EXPECT_EQ(bits_apart(a, {}), 1);
  EXPECT_EQ(bits_apart(all, {}), 256);
  EXPECT_EQ(bits_apart(all, a), 255);
}

}  // namespace places_test
}  // namespace textslam
