// Places that span two planes, and a sign that moves: what passes for a text, and is none that stands.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/renderer_support.hpp"
#include "renderer/spanning.hpp"
#include "renderer/truth.hpp"

namespace textslam {
namespace renderer_spanning_test {

constexpr double kInterval = 1.0 / 30.0;
constexpr int kFrames = 240;
const DetectorErrors kNone{0.0, 0.0, 0.0, 1.0};

std::vector<SpanningPlace> places_in(const Shot& shot, double in_view) {
  return spanning_places(shot, test_camera(), kFrames, kInterval, in_view, 5);
}

std::vector<Detection> seen(const std::vector<SpanningPlace>& places, const Shot& shot, int frame,
                            const DetectorErrors& errors) {
  const double time = frame * kInterval;
  return detect_spanning(places, shot.scene, test_camera(), shot.motion(time), time, errors,
                         Random(hash(3, static_cast<std::uint64_t>(frame))));
}

// In a room with its walls alone a place lies on two of them: nothing is hidden, and no quad is one plane's.
TEST(RendererSpanning, EachHalfOfAPlaceLiesOnAWallOfItsOwn) {
  const Shot shot = make_shot("sparse", 1, 640, 480);
  const std::vector<Surface>& walls = shot.scene.surfaces();
  const std::vector<SpanningPlace> places = places_in(shot, 2.0);
  ASSERT_GE(places.size(), 2u);
  const auto on = [&](const Surface& surface, const Vector3<double>& p) {
    const Vector3<double> offset = p - surface.rectangle.corner;
    return std::abs(surface.rectangle.normal().dot(offset)) < 1e-9;
  };
  for (const SpanningPlace& place : places) {
    int shared = 0, left = 0, right = 0;
    for (const Surface& surface : walls) {
      left += on(surface, place[0]) && on(surface, place[3]);
      right += on(surface, place[1]) && on(surface, place[2]);
      shared += on(surface, place[0]) && on(surface, place[1]);
    }
    EXPECT_GE(left, 1);
    EXPECT_GE(right, 1);
    EXPECT_EQ(shared, 0) << "the two halves are on different planes";
  }
}

TEST(RendererSpanning, AsManyAreInViewAsAskedForAndTheyStay) {
  for (const char* kind : {"room", "corridor"}) {
    const Shot shot = make_shot(kind, 1, 640, 480);
    for (const double in_view : {1.0, 3.0}) {
      const std::vector<SpanningPlace> places = places_in(shot, in_view);
      double all = 0.0;
      int kept = 0, pairs = 0;
      std::vector<Detection> before;
      for (int frame = 0; frame < kFrames; ++frame) {
        const std::vector<Detection> now = seen(places, shot, frame, kNone);
        all += static_cast<double>(now.size()) / kFrames;
        pairs += static_cast<int>(before.size());
        for (const Detection& old : before)
          for (const Detection& d : now) kept += textplane::iou(d.quad, old.quad) > 0.2;
        for (const Detection& d : now) {
          EXPECT_EQ(d.text, kUnreadText);
          EXPECT_TRUE(textplane::is_convex(d.quad));
        }
        before = now;
      }
      EXPECT_GE(all, in_view) << kind;
      EXPECT_LE(all, in_view + 1.0) << kind << ": the last place is in view of every frame at most";
      EXPECT_GT(kept, 0.9 * pairs) << kind << ": the next frame shows it there, too";
    }
  }
}

TEST(RendererSpanning, TheyAreMissedAndJitteredAsSignsAre) {
  const Shot shot = make_shot("room", 2, 640, 480);
  const std::vector<SpanningPlace> places = places_in(shot, 3.0);
  DetectorErrors errors = kNone;
  errors.missed = 0.6;
  errors.corner_sigma = 4.0;
  int whole = 0, found = 0;
  double squares = 0.0, coordinates = 0.0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const std::vector<Detection> exact = seen(places, shot, frame, kNone);
    whole += static_cast<int>(exact.size());
    for (const Detection& d : seen(places, shot, frame, errors)) {
      ++found;
      double nearest = HUGE_VAL;
      for (const Detection& e : exact) {
        double sum = 0.0;
        for (std::size_t k = 0; k < 4; ++k) sum += (d.quad.corner[k] - e.quad.corner[k]).squaredNorm();
        nearest = std::min(nearest, sum);
      }
      squares += nearest;
      coordinates += 8.0;
    }
  }
  EXPECT_NEAR(found / static_cast<double>(whole), 0.4, 5.0 * std::sqrt(0.24 / whole));
  EXPECT_NEAR(std::sqrt(squares / coordinates), 4.0, 5.0 * 4.0 / std::sqrt(2.0 * coordinates));
}

TEST(RendererSpanning, NoneOnRequest) { EXPECT_TRUE(places_in(make_shot("sparse", 1, 640, 480), 0.0).empty()); }

TEST(RendererMoving, OneSignOfTheRoomSlidesAlongItsWallAndHasNoPlaceInTheTruth) {
  const Shot room = make_shot("room", 1, 640, 480), moving = make_shot("moving", 1, 640, 480);
  const std::vector<Sign>&still = room.scene.signs(), &signs = moving.scene.signs();
  ASSERT_EQ(signs.size(), still.size());
  int carried = 0;
  for (std::size_t i = 0; i < signs.size(); ++i) {
    carried += signs[i].carrier != nullptr;
    double least = HUGE_VAL, most = -HUGE_VAL, fastest = 0.0, other = 0.0;
    for (double t = 0.0; t < 8.0; t += kInterval) {
      const Vector3<double> from = still[i].corner[0], at = signs[i].standing(t).corner[0];
      least = std::min(least, at[0] - from[0]);
      most = std::max(most, at[0] - from[0]);
      other = std::max(other, (at - from).tail<2>().norm());
      fastest = std::max(fastest, (signs[i].standing(t + 1e-3).corner[0] - at).norm() / 1e-3);
    }
    EXPECT_LT(other, 1e-12) << "along the wall";
    if (!signs[i].carrier) {
      EXPECT_EQ(most - least, 0.0);
      continue;
    }
    EXPECT_GT(most - least, 0.4);
    EXPECT_GT(fastest, 0.25);
    EXPECT_LT(fastest, 0.5);
    EXPECT_EQ(format_signs(signs).find('"' + signs[i].word + '"'), std::string::npos);
    EXPECT_NE(format_signs(still).find('"' + signs[i].word + '"'), std::string::npos);
  }
  EXPECT_EQ(carried, 1);
}

// The quad of a frame is where the letters are: the sign's plate, seen at the time, carries it.
TEST(RendererMoving, TheQuadOfAFrameFollowsThePlate) {
  const Shot shot = make_shot("moving", 2, 640, 480);
  int seen_whole = 0;
  for (int frame = 0; frame < kFrames; frame += 10) {
    const double time = frame * kInterval;
    for (const SignView& view : views_of_signs(shot.scene, test_camera(), shot.motion(time), time)) {
      const Sign& sign = shot.scene.signs()[static_cast<std::size_t>(view.sign)];
      if (!sign.carrier || view.visible < 1.0) continue;
      ++seen_whole;
      const Vector3<double> centre = sign.standing(time).at(0.5, 0.5), eye = shot.motion(time).t;
      const Hit hit = shot.scene.first_hit(eye, centre - eye, time);
      ASSERT_GE(hit.surface, 0);
      EXPECT_NE(shot.scene.surfaces()[static_cast<std::size_t>(hit.surface)].carrier, nullptr);
      EXPECT_NEAR(hit.distance, 1.0, 1e-9);
    }
  }
  EXPECT_GT(seen_whole, 3);
}

}  // namespace renderer_spanning_test
}  // namespace textslam
