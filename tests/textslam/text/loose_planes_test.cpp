// Planes from points alone: RANSAC on known planes, and the life of a text object whose plane it is.
#include "textslam/text/loose_planes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "textplane/geometry/plane.hpp"
#include "textslam/map/observations.hpp"

namespace textslam {
namespace loose_planes_test {

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

double degrees_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI; }

// Points of a plane seen through a quad, their depths off by up to `noise` (relative); every `stray`-th is somewhere
// else.
struct Points {
  std::vector<Vec3> m;
  std::vector<double> rho;
};
Points on_plane(const Vec3& theta, int n, double noise, int stray, std::mt19937& random) {
  Points points;
  for (int i = 0; i < n; ++i) {
    const Vec3 m(uniform(random, -0.2, 0.2), uniform(random, -0.05, 0.05), 1);
    const bool off = stray > 0 && i % stray == 0;
    points.m.push_back(m);
    points.rho.push_back(theta.dot(m) * (1 + uniform(random, -noise, noise)) * (off ? uniform(random, 0.4, 0.8) : 1));
  }
  return points;
}

TEST(LoosePlane, IsExactForExactPointsWhateverTheNumberOfDraws) {
  std::mt19937 random(1);
  const Vec3 theta = textplane::plane_from_normal<double>({0.4, -0.2, -1}, 2.5);
  for (const int n : {6, 18, 60}) {  // all triples of 6 and 18, draws among 60
    const Points points = on_plane(theta, n, 0, 3, random);
    const LoosePlane plane = fit_loose_plane(points.m, points.rho, Parameters{});
    ASSERT_EQ(plane.ok, n > 6) << "4 of 6 points are too few";
    if (!plane.ok) continue;
    EXPECT_LT((plane.theta - theta).norm(), 1e-9);
    ASSERT_EQ(plane.inliers.size(), static_cast<std::size_t>(n - n / 3));
    for (const int i : plane.inliers) EXPECT_NE(i % 3, 0);
  }
}

TEST(LoosePlane, NoiseAndStraysCostLittle) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 theta =
        textplane::plane_from_normal<double>({uniform(random, -0.6, 0.6), uniform(random, -0.3, 0.3), -1}, 3);
    const Points points = on_plane(theta, 60, 0.005, 3, random);
    const LoosePlane plane = fit_loose_plane(points.m, points.rho, Parameters{});
    ASSERT_TRUE(plane.ok);
    EXPECT_LT(degrees_between(plane.theta, theta), 3);
    // The covariance is of the error's size: five standard deviations along each axis.
    for (int k = 0; k < 3; ++k)
      EXPECT_LT(std::abs(plane.theta[k] - theta[k]), 5 * std::sqrt(plane.covariance(k, k)) + 1e-12);
    const LoosePlane again = fit_loose_plane(points.m, points.rho, Parameters{});
    EXPECT_EQ(plane.theta, again.theta);
    EXPECT_EQ(plane.inliers, again.inliers);
  }
}

TEST(LoosePlane, RefusesWhatIsNoPlane) {
  std::mt19937 random(3);
  const Parameters parameters;
  EXPECT_FALSE(fit_loose_plane({}, {}, parameters).ok);
  Points points = on_plane({0, 0, 0.5}, 2, 0, 0, random);
  EXPECT_FALSE(fit_loose_plane(points.m, points.rho, parameters).ok) << "two points";
  points = on_plane({0, 0, 0.5}, 40, 0, 0, random);
  for (double& rho : points.rho) rho *= uniform(random, 0.5, 1.5);
  EXPECT_FALSE(fit_loose_plane(points.m, points.rho, parameters).ok) << "a cloud";
  points = on_plane({0, 0, 0.5}, 40, 0, 0, random);
  for (Vec3& m : points.m) m.y() = 0.25 * m.x();
  EXPECT_FALSE(fit_loose_plane(points.m, points.rho, parameters).ok) << "a line";
}

// A camera that moves along x before a wall 3 units away with a text on it; points on the wall, observed in every key
// frame.
class LoosePlanesTest : public testing::Test {
 protected:
  LoosePlanesTest() {
    parameters.mode = Mode::loose;
    map.camera = {525, 525, 319.5, 239.5};
    map.width = 640;
    map.height = 480;
    normal = Vec3(0.3, 0.1, -1).normalized();
    std::mt19937 random(4);
    const Vec3 theta = textplane::plane_from_normal<double>(normal, 3);
    for (int i = 0; i < 40; ++i)
      map.points.push_back(
          {textplane::plane_point<double>(
               theta, map.camera.pinhole.unproject({uniform(random, 250, 390), uniform(random, 210, 270)})),
           {},
           0,
           0,
           false});
    TextObject text;
    text.id = 0;
    text.host = 0;
    text.patch.camera = map.camera.pinhole;
    text.patch.quad.corner = {Vec2(260, 215), Vec2(380, 215), Vec2(380, 265), Vec2(260, 265)};
    text.detections = 4;
    map.texts.push_back(text);
  }
  // The next key frame; its points are those of the map from `first` on.
  int add_keyframe(std::size_t first = 0) {
    const int id = static_cast<int>(map.keyframes.size());
    map.keyframes.push_back({{}, {Eigen::Matrix3d::Identity(), Vec3(0.05 * id, 0, 0)}, {}});
    map.keyframe(id).frame.image = blank;
    for (std::size_t i = first; i < map.points.size(); ++i) {
      const Vec3 p = map.keyframe(id).T_w_c.inverse() * map.points[i].p_w;
      add_observation(map, static_cast<int>(i), id, map.camera.project(p));
    }
    return id;
  }
  TextObject& text() { return map.texts.front(); }

  Parameters parameters;
  Map map;
  Vec3 normal;
  std::shared_ptr<const Pyramid> blank =
      std::make_shared<const Pyramid>(Image<std::uint8_t>(640, 480, std::uint8_t{100}).view(), 1);
};

TEST_F(LoosePlanesTest, ObjectLivesFromCandidateToMapped) {
  add_keyframe();
  update_loose_planes(map, parameters, 0);
  EXPECT_EQ(text().state, TextState::candidate) << "its own host tells nothing";
  for (int observations = 2; observations < parameters.text.min_observations; ++observations) {
    update_loose_planes(map, parameters, add_keyframe());
    ASSERT_EQ(text().state, TextState::tentative);
    EXPECT_EQ(static_cast<int>(text().views.size()) + 1, observations);
    EXPECT_LT(degrees_between(-text().theta, normal), 1e-6);
  }
  text().detections = parameters.text.min_detections - 1;
  update_loose_planes(map, parameters, add_keyframe());
  EXPECT_EQ(text().state, TextState::tentative) << "seen by the detector too rarely";
  text().detections = parameters.text.min_detections;
  update_loose_planes(map, parameters, add_keyframe());
  EXPECT_EQ(text().state, TextState::mapped);
}

TEST_F(LoosePlanesTest, KeyFramesWithoutItsPointsDoNotObserve) {
  add_keyframe();
  update_loose_planes(map, parameters, add_keyframe());
  ASSERT_EQ(text().views.size(), 1u);
  update_loose_planes(map, parameters, add_keyframe(map.points.size()));
  EXPECT_EQ(text().views.size(), 1u);
}

TEST_F(LoosePlanesTest, RefreshFollowsThePointsAndKeepsWhatItCannotFitAnew) {
  add_keyframe();
  update_loose_planes(map, parameters, add_keyframe());
  ASSERT_TRUE(text().has_plane());
  const Vec3 before = text().theta;
  for (MapPoint& point : map.points) point.p_w *= 1.25;
  refresh_loose_planes(map, parameters);
  EXPECT_LT((text().theta - before / 1.25).norm(), 1e-9);
  const Vec3 after = text().theta;
  for (MapPoint& point : map.points) point.bad = true;
  refresh_loose_planes(map, parameters);
  EXPECT_EQ(text().theta, after);
  for (int i = 0; i < 5; ++i) update_loose_planes(map, parameters, add_keyframe());
  EXPECT_EQ(text().state, TextState::dropped) << "a plane that finds no points again and again";
}

TEST_F(LoosePlanesTest, CandidatesWithoutAPlaneAreDroppedInTheEnd) {
  for (MapPoint& point : map.points) point.bad = true;
  add_keyframe();
  for (int i = 0; i < parameters.text.patience; ++i) update_loose_planes(map, parameters, add_keyframe());
  EXPECT_EQ(text().state, TextState::candidate);
  update_loose_planes(map, parameters, add_keyframe());
  EXPECT_EQ(text().state, TextState::dropped);
}

}  // namespace loose_planes_test
}  // namespace textslam
