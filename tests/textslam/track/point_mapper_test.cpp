// Points of key frames: triangulated from tracks, culled, and linked to what sees them.
#include "textslam/track/point_mapper.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "textslam/map/culling.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/scene_support.hpp"

namespace textslam {
namespace point_mapper_test {

using namespace scene_support;

// Three key frames and tracks of known points in them.
class PointMapperTest : public testing::Test {
 protected:
  PointMapperTest() {
    map.camera = camera();
    map.width = 640;
    map.height = 480;
    std::mt19937 random(5);
    points = scene(60, false, random);
    tracks.resize(points.size());
    poses = {SE3d{}, moved({-0.2, 0, 0}, {0, 0.02, 0}), moved({-0.4, 0.1, 0}, {0, 0.05, 0.01})};
  }
  Vec2 px(std::size_t point, std::size_t pose) const { return map.camera.project(poses[pose] * points[point]); }
  void insert(std::size_t pose) {
    for (std::size_t i = 0; i < tracks.size(); ++i) tracks[i].px = px(i, pose).cast<float>();
    EXPECT_EQ(insert_keyframe(map, {}, poses[pose].inverse(), tracks), static_cast<int>(pose));
  }
  // Each observation is known to its point and to its key frame.
  void expect_linked() const {
    std::size_t of_points = 0, of_keyframes = 0;
    for (std::size_t id = 0; id < map.points.size(); ++id)
      for (const PointObservation& o : map.points[id].observations) {
        const auto& seen = map.keyframe(o.keyframe).points;
        EXPECT_EQ(std::count(seen.begin(), seen.end(), static_cast<int>(id)), 1);
        ++of_points;
      }
    for (const KeyFrame& keyframe : map.keyframes) of_keyframes += keyframe.points.size();
    EXPECT_EQ(of_points, of_keyframes);
  }

  Map map;
  Parameters parameters;
  std::vector<Vec3> points;
  std::vector<SE3d> poses;
  std::vector<Track> tracks;
};

TEST_F(PointMapperTest, TriangulatesWhereThereIsParallax) {
  insert(0);
  EXPECT_EQ(triangulate_tracks(map, parameters, parameters.min_parallax, tracks), 0) << "one view";
  insert(1);
  EXPECT_EQ(triangulate_tracks(map, parameters, parameters.min_parallax, tracks), 60);
  insert(2);
  ASSERT_EQ(map.points.size(), 60u);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    ASSERT_GE(tracks[i].point, 0);
    EXPECT_TRUE(tracks[i].observations.empty()) << "the point has them now";
    const MapPoint& point = map.point(tracks[i].point);
    EXPECT_EQ(point.observations.size(), 3u);
    EXPECT_LT((point.p_w - points[i]).norm(), 1e-3 * points[i].norm());
  }
  expect_linked();
  std::vector<double> depths;
  for (const Vec3& p : points) depths.push_back((poses[2] * p).z());
  std::nth_element(depths.begin(), depths.begin() + 30, depths.end());
  EXPECT_NEAR(median_depth(map, 2), depths[30], 1e-3 * depths[30]);
}

TEST_F(PointMapperTest, NoPointsWithoutParallaxOrAgreement) {
  poses[1] = moved({-0.002, 0, 0}, {0, 0.02, 0});
  insert(0);
  insert(1);
  EXPECT_EQ(triangulate_tracks(map, parameters, parameters.min_parallax, tracks), 0) << "rays almost parallel";
  insert(2);
  for (std::size_t i = 0; i < 10; ++i) tracks[i].observations[1].px += Vec2(0, 12);  // slid across the epipolar line
  EXPECT_EQ(triangulate_tracks(map, parameters, parameters.min_parallax, tracks), 50);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(tracks[i].point, -1);
  expect_linked();
}

TEST_F(PointMapperTest, RemovalAndCullingKeepTheLinks) {
  insert(0);
  insert(1);
  triangulate_tracks(map, parameters, parameters.min_parallax, tracks);
  insert(2);
  const int twice = tracks[0].point;
  remove_observation(map, twice, 1);
  EXPECT_FALSE(map.point(twice).bad);
  expect_linked();
  remove_observation(map, twice, 0);
  EXPECT_TRUE(map.point(twice).bad) << "one view alone is no point";
  EXPECT_TRUE(map.point(twice).observations.empty());
  expect_linked();

  MapPoint& rare = map.point(tracks[1].point);
  rare.visible = 40;
  rare.found = 5;
  MapPoint& young = map.point(tracks[2].point);
  young.visible = 10;
  young.found = 0;
  MapPoint& steady = map.point(tracks[3].point);
  steady.visible = 40;
  steady.found = 30;
  cull_points(map, parameters);
  erase_bad_tracks(map, tracks);
  EXPECT_TRUE(rare.bad);
  EXPECT_FALSE(young.bad) << "too soon to tell";
  EXPECT_FALSE(steady.bad);
  EXPECT_EQ(tracks.size(), 58u) << "tracks of bad points are gone";
  expect_linked();
}

}  // namespace point_mapper_test
}  // namespace textslam
