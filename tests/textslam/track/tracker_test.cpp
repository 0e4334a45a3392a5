// What may move the pose of a tracker's frame.
#include "textslam/track/tracker.hpp"

#include <gtest/gtest.h>

#include "textplane/features/select.hpp"
#include "textplane/geometry/plane.hpp"
#include "textslam/relocalise/places_support.hpp"

namespace textslam {
namespace tracker_test {

using namespace places_support;

class TrackerTest : public PlacesTest {
 protected:
  static constexpr double kStep = 0.03;  // forward, each frame

  TrackerTest() { tracker.start(map.keyframe(0).frame, map.keyframe(0).T_w_c.inverse(), tracks_of_keyframe(map, 0)); }

  // The point whose first observation is nearest to a pixel.
  MapPoint& point_at(const Vec2& px) {
    const auto distance = [&](const MapPoint& point) { return (point.observations.front().px - px).norm(); };
    return *std::min_element(map.points.begin(), map.points.end(),
                             [&](const MapPoint& a, const MapPoint& b) { return distance(a) < distance(b); });
  }
  // Along its ray of the first frame.
  void move_point(const Vec2& px, double depth) {
    Vec3& p_w = point_at(px).p_w;
    p_w *= depth / p_w.z();
  }
  // A text on a wall, as `seen` shows it from where the first frame was taken.
  void add_text(const Frame& seen, const Vec2& px, const Vec3& normal, double offset) {
    TextObject text;
    text.id = static_cast<int>(map.texts.size());
    text.state = TextState::mapped;
    text.host = 0;
    text.theta = textplane::plane_from_normal<double>(-normal, offset);
    textplane::SelectOptions options;
    options.levels = parameters.text.levels;
    const Quad<double> quad{{px, px + Vec2(90, 0), px + Vec2(90, 50), px + Vec2(0, 50)}};
    text.patch = textplane::make_patch(seen.image->view(), map.camera, quad, options);
    ASSERT_TRUE(textplane::is_ok(text.patch.status));
    map.texts.push_back(std::move(text));
  }
  void add_texts(const Frame& seen) {
    parameters.mode = Mode::text;
    for (const double y : {60.0, 140.0, 220.0}) {
      add_text(seen, {450, y}, {0.6, 0, 0.8}, 2.6);
      add_text(seen, {60, y}, {-0.7, 0, 0.714}, 2.4);
    }
  }
  SE3d truth(int frame) const { return moved({0, 0, kStep * frame}, {0, 0, 0}).inverse(); }

  // The largest error of the position over some frames.
  double worst_of(int frames) {
    double worst = 0;
    for (int k = 1; k <= frames; ++k) {
      const TrackReport report = tracker.track(frame_at(truth(k)));
      EXPECT_TRUE(report.ok) << k;
      worst = std::max(worst, (report.T_c_w.inverse().t - truth(k).inverse().t).norm());
    }
    return worst;
  }

  Tracker tracker{map, parameters};
};

TEST_F(TrackerTest, PointsThatTheCameraPassesAtAWrongDepthDoNotHoldItBack) {
  move_point({100, 150}, 8.5 * kStep);
  move_point({150, 350}, 8 * kStep);
  move_point({560, 200}, 7.5 * kStep);
  EXPECT_LT(worst_of(8), kStep / 2);
}

TEST_F(TrackerTest, TextsHelpWherePointsAreFew) {
  for (std::size_t i = 0; i < map.points.size(); ++i) map.points[i].bad = i % 12 != 0;
  add_texts(map.keyframe(0).frame);
  EXPECT_LT(worst_of(8), kStep / 30);
}

// Six signs were papered over. They have many pixels: together they would pull harder than the points.
TEST_F(TrackerTest, TextsThatAreNotSeenWhereTheyShouldBeDoNotHoldItBack) {
  for (std::size_t i = 0; i < map.points.size(); ++i) map.points[i].bad = i % 12 != 0;
  paper = 50;
  const Frame before = frame_at(truth(0));
  paper = 1;
  add_texts(before);
  EXPECT_LT(worst_of(8), kStep / 20);
}

TEST_F(TrackerTest, APointThatFitsAgainIsHeardAgain) {
  MapPoint& point = point_at({100, 150});
  const Vec3 before = point.p_w;
  point.p_w *= 0.5;
  const auto fits = [&] {
    for (const Track& track : tracker.tracks())
      if (track.point >= 0 && &map.point(track.point) == &point) return track.inlier;
    ADD_FAILURE() << "the track is lost";
    return false;
  };
  for (int k = 1; k <= 3; ++k) tracker.track(frame_at(truth(k)));
  EXPECT_FALSE(fits());
  point.p_w = before;
  tracker.track(frame_at(truth(4)));
  EXPECT_TRUE(fits());
}

}  // namespace tracker_test
}  // namespace textslam
