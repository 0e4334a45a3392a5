// Relocalisation in a scene made by formula: a lost frame by the looks of points alone.
#include "textslam/relocalise/places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "textslam/map/observations.hpp"
#include "textslam/relocalise/boards_support.hpp"
#include "textslam/relocalise/relocalisation.hpp"
#include "textslam/track/feature_tracks.hpp"

namespace textslam {
namespace places_test {

using boards_support::kDegree;
using boards_support::moved;
using boards_support::turn_between;

// The corner of a room, papered with spots of several sizes; two key frames, and points on what they see.
class PlacesTest : public testing::Test {
 protected:
  PlacesTest() {
    parameters.mode = Mode::points;
    parameters = at_size(parameters, 640, 480);
    map.camera = {525, 525, 319.5, 239.5};
    map.width = 640;
    map.height = 480;
    map.number = 0;
    for (const double x : {0.0, 0.15}) {
      const SE3d T_w_c = moved({x, 0, 0}, {0, 0, 0});
      map.keyframes.push_back({frame_at(T_w_c.inverse()), T_w_c, {}});
    }
    std::vector<Track> corners;
    add_corners(map.keyframe(0).frame, 0, {}, parameters, corners);
    for (const Track& corner : corners) {
      const Vec3 p = hit(Vec3::Zero(), map.camera.unproject(corner.px.cast<double>()), nullptr);
      const Vec2 other = map.camera.project(map.keyframe(1).T_w_c.inverse() * p);
      if (!(other.x() > 20 && other.x() < 620)) continue;
      map.points.push_back({p});
      const int id = static_cast<int>(map.points.size()) - 1;
      add_observation(map, id, 0, corner.px.cast<double>());
      add_observation(map, id, 1, other);
    }
  }

  static double spot(int i, int j, unsigned print) {
    std::uint32_t h =
        static_cast<std::uint32_t>(i) * 2654435761U ^ static_cast<std::uint32_t>(j) * 2246822519U ^ print * 3266489917U;
    h = (h ^ (h >> 15)) * 739982445U;
    h = (h ^ (h >> 12)) * 695872825U;
    return (h ^ (h >> 15)) % 256;
  }
  static double smooth(double u, double v, unsigned print) {
    const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
    const double a = u - i, b = v - j;
    return (1 - b) * ((1 - a) * spot(i, j, print) + a * spot(i + 1, j, print)) +
           b * ((1 - a) * spot(i, j + 1, print) + a * spot(i + 1, j + 1, print));
  }

  // Two walls and the floor: the first that the ray meets.
  Vec3 hit(const Vec3& from, const Vec3& ray, double* grey) const {
    const Vec3 normals[] = {Vec3(0.6, 0, 0.8), Vec3(-0.7, 0, 0.714), Vec3(0, 1, 0)};
    const double offsets[] = {2.6, 2.4, 0.9};
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
      const double along = (offsets[i] - normals[i].dot(from)) / normals[i].dot(ray);
      if (!(along > 0) || along >= nearest) continue;
      nearest = along;
      if (!grey) continue;
      const Vec3 p = from + along * ray;
      const double u = i == 2 ? p.x() : p.cross(normals[i]).y(), v = i == 2 ? p.z() : p.y();
      const auto print = paper + 7 * static_cast<unsigned>(i);
      *grey = 0.5 * smooth(u / 0.04, v / 0.04, print) + 0.5 * smooth(u / 0.11, v / 0.11, print + 3);
    }
    return from + nearest * ray;
  }

  Frame frame_at(const SE3d& T_c_w) const {
    Image<std::uint8_t> image(map.width, map.height, 0);
    const SE3d T_w_c = T_c_w.inverse();
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) {
        double grey = 0;
        hit(T_w_c.t, T_w_c.R * map.camera.unproject(Vec2(x, y)), &grey);
        image(x, y) = static_cast<std::uint8_t>(grey);
      }
    Frame frame;
    frame.image = std::make_shared<const Pyramid>(image.view(), parameters.pyramid_levels);
    return frame;
  }

  // A camera that has gone round the middle of the scene by `turn`, is `nearer` times as near, and is rolled.
  static SE3d around(double turn, double nearer, double roll) {
    const Vec3 middle(0.1, 0, 3);
    const Eigen::Matrix3d R =
        textplane::so3_exp<double>(Vec3(0, turn, 0)) * textplane::so3_exp<double>(Vec3(0, 0, roll));
    return SE3d{R, middle - R * middle / nearer}.inverse();
  }

  void expect_found(const SE3d& truth) {
    SCOPED_TRACE(testing::Message() << truth.inverse().t.transpose());
    const Relocalisation found = relocalise(map, parameters, frame_at(truth));
    ASSERT_TRUE(found.ok);
    EXPECT_LT((found.T_c_w.inverse().t - truth.inverse().t).norm(), 0.01);
    EXPECT_LT(turn_between(found.T_c_w, truth) / kDegree, 0.2);
  }

  Parameters parameters;
  Map map;
  unsigned paper = 1;
};

TEST_F(PlacesTest, AnotherViewOfAPlaceIsFound) {
  ASSERT_GT(map.points.size(), 200u);
  expect_found(around(25 * kDegree, 1, 0));
  expect_found(around(-20 * kDegree, 1.5, 0));
  expect_found(around(20 * kDegree, 1 / 1.5, 0));
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
  const MatchedPose before = pose_by_place(map, parameters, looks, 0);
  ASSERT_GT(before.inliers, 50);
  const auto kept = map.keyframe(0).looks;
  for (std::size_t i = 0; i < map.points.size(); i += 2) drop_point(map, static_cast<int>(i));
  const MatchedPose half = pose_by_place(map, parameters, looks, 0);
  EXPECT_GT(half.inliers, before.inliers / 4);
  EXPECT_LT(half.inliers, before.inliers * 3 / 4) << "what has left the map is not matched";
  EXPECT_EQ(map.keyframe(0).looks, kept) << "nothing is described again";
  const Vec3 p = hit(Vec3::Zero(), map.camera.unproject(Vec2(300, 200)), nullptr);
  map.points.push_back({p});
  for (int k = 0; k < 2; ++k)
    add_observation(map, static_cast<int>(map.points.size()) - 1, k,
                    map.camera.project(map.keyframe(k).T_w_c.inverse() * p));
  pose_by_place(map, parameters, looks, 0);
  EXPECT_EQ(map.keyframe(0).looks->points.size(), map.keyframe(0).points.size()) << "a new point is described";
}

TEST_F(PlacesTest, DescriptorsTurnWithTheCamera) {
  const SE3d turned = moved({0, 0, 0}, {0, 0, 70 * kDegree});
  const SmoothedLevels levels(*map.keyframe(0).frame.image, 3), other(*frame_at(turned).image, 3);
  std::vector<double> same, different;
  Descriptor before{};
  for (const MapPoint& point : map.points) {
    const Vec2 px = map.camera.project(point.p_w), then = map.camera.project(turned * point.p_w);
    Descriptor a, b;
    if (!levels.describe(px.cast<float>(), 2, &a) || !other.describe(then.cast<float>(), 2, &b)) continue;
    same.push_back(bits_apart(a, b));
    different.push_back(bits_apart(before, b));
    before = a;
  }
  ASSERT_GT(same.size(), 100u);
  std::sort(same.begin(), same.end());
  std::sort(different.begin(), different.end());
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
  const Descriptor a{0x1, 0, 0, 0}, all{~0ULL, ~0ULL, ~0ULL, ~0ULL};
  EXPECT_EQ(bits_apart(a, {}), 1);
  EXPECT_EQ(bits_apart(all, {}), 256);
  EXPECT_EQ(bits_apart(all, a), 255);
}

}  // namespace places_test
}  // namespace textslam
