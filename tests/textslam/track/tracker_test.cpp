// What may move the pose of a tracker's frame.
#include "textslam/track/tracker.hpp"

#include <gtest/gtest.h>

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
