// Initialisation of textslam on images made by formula: signs on one blank wall, which is all that there is to see.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/spots.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/plane_fit.hpp"
#include "textslam/init/initialiser.hpp"

namespace textslam {
namespace initialiser_test {

SE3d moved(const Vec3& t, const Vec3& w) { return {textplane::so3_exp<double>(w), t}; }

// A wall with boards of random spots, all in its plane; the camera at the origin sees it at a slant.
class InitialiserTest : public testing::Test {
 protected:
  InitialiserTest() {
    map.camera = {420, 420, 239.5, 179.5};
    map.width = 480;
    map.height = 360;
  }

  static double ink(double x, double y) {
    return textplane_test::between_spots(x / 0.05, y / 0.05, [](int i, int j) {
      const auto column = static_cast<std::uint32_t>(i), row = static_cast<std::uint32_t>(j);
      return textplane_test::spot_number(column, row) % 2 == 0 ? 40.0 : 210.0;
    });
  }

  static SE3d along(int index) {
    const double way = 0.03 * index;
    return moved({way, -0.3 * way, 0.4 * way}, {0.1 * way, -0.15 * way, 0.05 * way});
  }

  // Camera `index` on its way, with the boards' detections.
  Frame frame_at(int index) const {
    const SE3d T_w_c = pose_of(index);
    const SE3d T_b_c = T_w_b.inverse() * T_w_c;
    Image<std::uint8_t> image(map.width, map.height, 128);
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) {
        const Vec3 ray = T_b_c.R * map.camera.pinhole.unproject(Vec2(x, y));
        const Vec3 p = T_b_c.t - T_b_c.t.z() / ray.z() * ray;
        for (const Vec2& board : boards)
          if (std::abs(p.x() - board.x()) < kHalfWidth && std::abs(p.y() - board.y()) < kHalfHeight)
            image(x, y) = static_cast<std::uint8_t>(std::lround(ink(p.x(), p.y())));
      }
    Frame frame;
    frame.index = index;
    frame.timestamp = interval * index;
    frame.image = std::make_shared<const Pyramid>(image.view(), parameters.pyramid_levels);
    for (const Vec2& board : boards) {
      Detection detection;
      const double signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
      for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 corner(board.x() + signs[i][0] * kHalfWidth, board.y() + signs[i][1] * kHalfHeight, 0);
        detection.quad.corner[i] = map.camera.project(T_b_c.inverse() * corner);
      }
      frame.detections.push_back(detection);
    }
    return frame;
  }

  // The frame at which the map began; -1: at none of the first 60.
  int begin() {
    Initialiser initialiser(parameters);
    for (int index = 0; index < 60; ++index)
      if (initialiser.add(frame_at(index), map, &tracks)) return index;
    return -1;
  }

  static constexpr double kHalfWidth = 0.4, kHalfHeight = 0.16;
  double interval = 0.04;                                // s between two frames
  std::function<SE3d(int)> pose_of = along;              // T_w_c of frame `index`
  const SE3d T_w_b = moved({0, 0, 2}, {0.25, 0.45, 0});  // z of the wall away from the reader
  std::vector<Vec2> boards = {{-0.35, -0.4}, {0.2, 0.3}};
  Parameters parameters;
  Map map;
  std::vector<Track> tracks;
};

TEST_F(InitialiserTest, TwoSignsOnAWallStartTheMapAndGiveItsPlane) {
  const int frame = begin();
  ASSERT_GT(frame, 0);
  ASSERT_EQ(map.keyframes.size(), 2U);
  EXPECT_EQ(map.keyframe(0).frame.index, 0);
  EXPECT_EQ(map.keyframe(1).frame.index, frame);
  const double way = 0.03 * frame;
  const Vec3 t(way, -0.3 * way, 0.4 * way);
  EXPECT_GT(map.keyframe(1).T_w_c.t.normalized().dot(t.normalized()), std::cos(4 * M_PI / 180));
  std::vector<Vec3> points;
  for (const MapPoint& point : map.points)
    if (!point.bad) points.push_back(point.p_w);
  ASSERT_GE(points.size(), 30U);
  const auto plane = textplane::plane_from_points(points);
  ASSERT_TRUE(textplane::is_ok(plane.status));
  EXPECT_LT(degrees_between(-textplane::plane_normal(plane.value), T_w_b.R.col(2)), 3);
  for (const Track& track : tracks) EXPECT_LE(track.observations.size(), 2U);
}

// An image that has no more corners than that starts the map where the motion is known well.
TEST_F(InitialiserTest, FewCornersStartTheMapWithoutAWordThatTheyAreText) {
  parameters.mode = Mode::points;
  const int frame = begin();
  ASSERT_GT(frame, 0);
  EXPECT_LT(map.points.size(), static_cast<std::size_t>(parameters.init_min_matches));
  const double first = 0.03 * map.keyframe(0).frame.index, way = 0.03 * frame - first;
  EXPECT_GT(way, 0);
  const Vec3 t = map.keyframe(1).T_w_c.t;
  const SE3d T_w_a = moved({first, -0.3 * first, 0.4 * first}, {0.1 * first, -0.15 * first, 0.05 * first});
  const Vec3 truth = T_w_a.R.transpose() * Vec3(way, -0.3 * way, 0.4 * way);
  EXPECT_GT(t.normalized().dot(truth.normalized()), std::cos(4 * M_PI / 180));
}

TEST_F(InitialiserTest, FewThatAreLeftOfManyDoNot) {
  parameters.mode = Mode::points;
  parameters.init_match_share = 1.5;  // more than there are
  EXPECT_EQ(begin(), -1);
  EXPECT_TRUE(map.keyframes.empty());
}

TEST_F(InitialiserTest, OneSignAloneDoesNot) {
  boards.pop_back();
  EXPECT_EQ(begin(), -1);
  EXPECT_TRUE(map.keyframes.empty());
}

// A camera that turns, while it hardly moves, sees nothing of the first reference in the end. Of the next ones it does,
// so that not all parallax has to come after the turn.
TEST_F(InitialiserTest, ATurnTakesTheFirstReferenceAlone) {
  parameters.mode = Mode::points;
  pose_of = [](int index) { return moved({0.004 * index, 0, 0}, {0, 0.05 * std::min(index, 18), 0}); };
  boards.clear();
  for (int column = 0; column < 12; ++column)
    for (const double y : {-0.5, 0.0, 0.5}) boards.emplace_back(-5 + 0.9 * column, y);
  const auto reference = [&] { return map.keyframe(0).frame.index; };
  parameters.init_references = 1;
  const int alone = begin();
  ASSERT_GT(alone, 0);
  const int last = reference();
  ASSERT_GT(last, 0) << "the first one is lost";
  parameters.init_references = Parameters().init_references;
  const int frame = begin();
  ASSERT_GT(frame, 0);
  EXPECT_LT(frame, alone);
  EXPECT_GT(reference(), 0);
  EXPECT_LT(reference(), last);
  const SE3d T_a_b = pose_of(reference()).inverse() * pose_of(frame);
  EXPECT_GT(map.keyframe(1).T_w_c.t.normalized().dot(T_a_b.t.normalized()), std::cos(4 * M_PI / 180));
}

// Where no motion is ever clearly the best, one is taken after a time, and not after a number of frames.
TEST_F(InitialiserTest, PatienceIsTime) {
  parameters.init_clear = 1e3;
  parameters.init_patience = 0;
  const int earliest = begin();
  parameters.init_patience = 0.4;
  const int at_25_hz = begin();
  EXPECT_GE(interval * at_25_hz, 0.4);
  interval = 0.2;
  const int at_5_hz = begin();
  ASSERT_GT(earliest, 0);
  EXPECT_GT(at_25_hz, earliest);
  EXPECT_LT(at_5_hz, at_25_hz);
  EXPECT_GE(at_5_hz, earliest);
}

}  // namespace initialiser_test
}  // namespace textslam
