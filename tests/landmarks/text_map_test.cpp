// TextMap as a host uses it: three signs before a camera that moves sideways.
#include "textplane/landmarks/text_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <set>
#include <vector>

#include "solver/synthetic.hpp"

namespace text_map_test {
using namespace textplane_test::planar;
using textplane::Pyramid;
using textplane::Status;
using textplane::TextDetection;
using textplane::TextFit;
using textplane::TextMap;
using textplane::TextObject;
using textplane::TextPoint;
using textplane::TextState;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool same_bits(const SE3d& a, const SE3d& b) {
  return std::memcmp(a.R.data(), b.R.data(), 9 * sizeof(double)) == 0 &&
         std::memcmp(a.t.data(), b.t.data(), 3 * sizeof(double)) == 0;
}

double shift(const SE3d& a, const SE3d& b) { return (a.inverse().t - b.inverse().t).norm(); }

class TextMapTest : public testing::Test {
 protected:
  static SE3d pose(double step) {
    Vec6 xi;
    xi << 0.05 * step, -0.01 * step, 0.012 * step, 0.002 * step, -0.012 * step, 0.003 * step;
    return textplane::se3_exp<double>(xi);
  }
  Pyramid image(const SE3d& T_c_w) const {
    const FloatPyramid rendered = scene.render(T_c_w);
    const Image<float>& from = rendered.levels[0];
    Image<std::uint8_t> to(from.width(), from.height());
    for (int y = 0; y < to.height(); ++y)
      for (int x = 0; x < to.width(); ++x) to(x, y) = static_cast<std::uint8_t>(std::lround(from(x, y)));
    return Pyramid(to.view(), 3);
  }
  // The quads of the signs, as an exact detector sees them.
  std::vector<TextDetection> quads(const SE3d& T_c_w) const {
    std::vector<TextDetection> out;
    for (const Sign& sign : scene.signs) {
      TextDetection found;
      std::size_t i = 0;
      for (const Vec2& corner :
           {Vec2(sign.x0, sign.y0), Vec2(sign.x1, sign.y0), Vec2(sign.x1, sign.y1), Vec2(sign.x0, sign.y1)}) {
        const Vec3 m = scene.camera.unproject(corner);
        found.quad.corner[i++] = scene.camera.project(T_c_w * (sign.T_w_h * Vec3(m / sign.theta.dot(m))));
      }
      found.word = "sign";
      out.push_back(found);
    }
    return out;
  }
  // Points on the signs and about them, where this camera sees them, each with an error of `noise` px.
  std::vector<TextPoint> points(const SE3d& T_c_w, double noise, unsigned seed = 3) const {
    Random at(17), error(seed);
    std::vector<TextPoint> out;
    for (int i = 0; i < 90; ++i) {
      const Sign& sign = scene.signs[static_cast<std::size_t>(i % 3)];
      const Vec3 m = scene.camera.unproject({at.uniform(sign.x0, sign.x1), at.uniform(sign.y0, sign.y1)});
      const Vec3 p_w = sign.T_w_h * Vec3(m / sign.theta.dot(m));
      const Vec2 px = scene.camera.project(T_c_w * p_w) + noise * Vec2(error.normal(), error.normal());
      out.push_back(TextPoint::at(px, p_w, i));
    }
    return out;
  }
  // `map` after key frames 0 to last.
  void walk(TextMap& map, int last, bool with_points = true) const {
    for (int id = 0; id <= last; ++id) {
      const SE3d T = pose(id);
      const auto seen = with_points ? points(T, 0.1) : std::vector<TextPoint>();
      ASSERT_EQ(map.add_keyframe(id, image(T), T, quads(T), seen), Status::ok);
    }
  }
  static int mapped(const TextMap& map) {
    int n = 0;
    for (const TextObject& text : map.objects()) n += text.state == TextState::mapped;
    return n;
  }
  // Largest angle between a mapped text's normal and that of the sign it lies on, degrees.
  double largest_angle(const TextMap& map) const {
    double largest = 0;
    for (const TextObject& text : map.objects()) {
      const Vec3 normal = map.keyframes().text_keyframe(text.host).T_w_c.R * textplane::plane_normal(text.theta);
      double closest = 180;
      for (const Sign& sign : scene.signs)
        closest = std::min(
            closest, textplane::detail::degrees_between(normal, sign.T_w_h.R * textplane::plane_normal(sign.theta)));
      if (text.state == TextState::mapped) largest = std::max(largest, closest);
    }
    return largest;
  }

  const Scene scene = three_signs();
};

TEST_F(TextMapTest, MapsTextsFromKeyFramesWithPoints) {
  TextMap map(scene.camera);
  walk(map, 6);
  EXPECT_EQ(mapped(map), 3);
  EXPECT_LT(largest_angle(map), 1.0);
  for (const TextObject& text : map.objects()) EXPECT_EQ(textplane::consensus(text.votes), "sign");
}

TEST_F(TextMapTest, MapsTextsWithoutAnyPoint) {
  TextMap map(scene.camera);
  walk(map, 7, false);
  EXPECT_EQ(mapped(map), 3);
  EXPECT_LT(largest_angle(map), 1.5);
}

TEST_F(TextMapTest, MapsTextsFromTracksOfUnknownDepth) {
  TextMap map(scene.camera);
  for (int id = 0; id <= 6; ++id) {
    const SE3d T = pose(id);
    std::vector<TextPoint> tracks;
    for (const TextPoint& point : points(T, 0.1)) tracks.push_back(TextPoint::track(point.px, point.id));
    ASSERT_EQ(map.add_keyframe(id, image(T), T, quads(T), tracks), Status::ok);
  }
  EXPECT_EQ(mapped(map), 3);
  EXPECT_LT(largest_angle(map), 1.0);
}

TEST_F(TextMapTest, MapsTextsFromPixelsWithDepth) {
  TextMap map(scene.camera);
  for (int id = 0; id <= 6; ++id) {
    const SE3d T = pose(id);
    std::vector<TextPoint> depths;
    for (const TextPoint& point : points(T, 0.0))
      depths.push_back(TextPoint::with_depth(point.px, (T * point.p_w).z()));
    ASSERT_EQ(map.add_keyframe(id, image(T), T, quads(T), depths), Status::ok);
  }
  EXPECT_EQ(mapped(map), 3);
  EXPECT_LT(largest_angle(map), 1.0);
}

TEST_F(TextMapTest, TracksBetterThanNoisyPoints) {
  TextMap map(scene.camera);
  walk(map, 6);
  double by_points = 0, by_both = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const SE3d truth = pose(4.5 + 0.1 * seed);
    const auto seen = points(truth, 1.0, seed);
    const SE3d start = textplane::se3_exp<double>(Random(seed).twist(0.01, 0.004)) * truth;
    const TextFit fit = map.track(image(truth), start, seen);
    ASSERT_TRUE(fit.refined) << textplane::to_string(fit.status);
    EXPECT_EQ(fit.texts, 3);
    by_both += shift(fit.T_c_w, truth) / 8;
    textplane::TextPose pose_of_points;
    std::vector<textplane::PosePointTerm> terms;
    for (const TextPoint& point : seen) terms.push_back({point.p_w, point.px, 1});
    std::vector<textplane::FrameText> no_texts;
    textplane::TextImage frame;
    frame.camera = scene.camera;
    SE3d T = start;
    ASSERT_TRUE(pose_of_points.solve(terms, 1, no_texts, frame, &T));
    by_points += shift(T, truth) / 8;
  }
  EXPECT_LT(by_both, 0.5 * by_points);
}

TEST_F(TextMapTest, TracksWithoutPoints) {
  TextMap map(scene.camera);
  walk(map, 6);
  const SE3d truth = pose(5.5), start = textplane::se3_exp<double>(Random(2).twist(0.01, 0.004)) * truth;
  const TextFit fit = map.track(image(truth), start, {});
  ASSERT_TRUE(fit.refined);
  EXPECT_LT(shift(fit.T_c_w, truth), 0.1 * shift(start, truth));
}

TEST_F(TextMapTest, LeavesThePoseToTheBitWhereItHasNothingToSay) {
  TextMap map(scene.camera);
  const SE3d T = pose(0.3);
  EXPECT_TRUE(same_bits(map.track(image(T), T, points(T, 1)).T_c_w, T)) << "no text";
  walk(map, 6);
  SE3d away = T;
  away.R = textplane::so3_exp<double>(Vec3(0, 3, 0)) * away.R;
  const TextFit behind = map.track(image(T), away, {});
  EXPECT_TRUE(same_bits(behind.T_c_w, away));
  EXPECT_EQ(behind.status, Status::too_few);
  const Image<std::uint8_t> grey(320, 240, 128);
  const TextFit hidden = map.track(Pyramid(grey.view(), 3), T, points(T, 1));
  EXPECT_TRUE(same_bits(hidden.T_c_w, T));
  EXPECT_FALSE(hidden.refined);
  for (const auto& report : hidden.reports) EXPECT_EQ(report.use, textplane::TextUse::dissimilar);
}

TEST_F(TextMapTest, LeavesThePoseWherePointsContradictTheTexts) {
  TextMap map(scene.camera);
  walk(map, 6);
  // The signs moved together: the points say one pose, the texts another.
  const SE3d T = pose(5.5);
  Vec6 xi;
  xi << 0.05, 0, 0, 0, 0, 0;
  const SE3d moved = textplane::se3_exp<double>(xi) * T;
  const TextFit fit = map.track(image(moved), T, points(T, 0.2));
  EXPECT_TRUE(same_bits(fit.T_c_w, T));
  EXPECT_FALSE(fit.refined);
}

TEST_F(TextMapTest, KeyFramesMovedAndMovedBackGiveTheSameBits) {
  TextMap map(scene.camera);
  walk(map, 6);
  const SE3d T = pose(5.5);
  const auto seen = points(T, 0.5);
  const Pyramid frame = image(T);
  const SE3d before = map.track(frame, T, seen).T_c_w;
  const SE3d aside = textplane::se3_exp<double>(Random(9).twist(0.2, 0.1));
  map.move([&](int id) { return pose(id) * aside; });
  map.move([&](int id) { return pose(id); });
  EXPECT_TRUE(same_bits(map.track(frame, T, seen).T_c_w, before));
  // One rigid motion of the world changes nothing of what is seen.
  map.move([&](int id) { return pose(id) * aside; });
  const SE3d along = map.track(frame, T * aside, {}).T_c_w * aside.inverse();
  EXPECT_LT(shift(along, map.track(frame, T * aside, {}).T_c_w * aside.inverse()), 1e-12);
  EXPECT_LT(shift(along, T), 2e-3);
}

TEST_F(TextMapTest, RefusesIdsInUseAndInputThatIsNotFinite) {
  TextMap map(scene.camera);
  walk(map, 5);
  const std::size_t before = map.objects().size();
  const SE3d T = pose(6);
  EXPECT_EQ(map.add_keyframe(5, image(T), T, quads(T), {}), Status::invalid_argument);
  EXPECT_EQ(map.add_keyframe(6, Pyramid(), T, quads(T), {}), Status::invalid_argument);
  SE3d bad = T;
  bad.t[1] = kNaN;
  EXPECT_EQ(map.add_keyframe(6, image(T), bad, quads(T), {}), Status::non_finite);
  EXPECT_EQ(map.objects().size(), before);
  EXPECT_EQ(map.track(image(T), bad, points(T, 1)).status, Status::invalid_argument);
  EXPECT_EQ(map.track(Pyramid(), T, points(T, 1)).status, Status::invalid_argument);

  std::vector<TextDetection> broken = quads(T);
  broken[0].quad.corner[2].x() = kNaN;
  std::vector<TextPoint> strange = points(T, 0.1);
  strange[0].p_w.x() = kNaN;
  strange[1].px.y() = kNaN;
  strange[2].sigma = 0;
  EXPECT_EQ(map.add_keyframe(6, image(T), T, broken, strange), Status::ok);
  const TextFit fit = map.track(image(T), T, strange);
  EXPECT_TRUE(textplane::all_finite(fit.T_c_w));
  map.move([&](int) { return bad; });
  EXPECT_TRUE(textplane::all_finite(map.track(image(T), T, strange).T_c_w));
}

TEST_F(TextMapTest, IdsAreNeverUsedTwiceAndStatesOnlyAdvance) {
  TextMap map(scene.camera);
  std::set<int> gone;
  std::map<int, TextState> states;
  Random random(4);
  for (int id = 0; id < 30; ++id) {
    const SE3d T = pose(0.4 * id);
    std::vector<TextDetection> seen;
    for (TextDetection& detection : quads(T))
      if (random.uniform(0, 1) < 0.6) seen.push_back(detection);
    TextDetection wrong;
    const double x = random.uniform(10, 240), y = random.uniform(10, 190);
    wrong.quad.corner = {Vec2(x, y), Vec2(x + 60, y), Vec2(x + 60, y + 30), Vec2(x, y + 30)};
    seen.push_back(wrong);
    ASSERT_EQ(map.add_keyframe(id, image(T), T, seen, points(T, 0.3)), Status::ok);
    std::set<int> here;
    for (const TextObject& text : map.objects()) {
      EXPECT_TRUE(here.insert(text.id).second);
      EXPECT_EQ(gone.count(text.id), 0U);
      EXPECT_NE(text.state, TextState::dropped);
      const auto known = states.find(text.id);
      if (known != states.end()) {
        EXPECT_GE(text.state, known->second);
      }
      states[text.id] = text.state;
    }
    for (const auto& [text, state] : states)
      if (here.count(text) == 0) gone.insert(text);
  }
}

TEST_F(TextMapTest, AHostThatLeavesHandsItsTextsOn) {
  TextMap map(scene.camera);
  walk(map, 6);
  ASSERT_EQ(mapped(map), 3);
  std::set<int> hosts;
  for (const TextObject& text : map.objects()) hosts.insert(text.host);
  for (const int id : hosts) map.remove_keyframe(id);
  EXPECT_EQ(mapped(map), 3);
  EXPECT_LT(largest_angle(map), 1.0);
  for (const TextObject& text : map.objects()) {
    EXPECT_EQ(hosts.count(text.host), 0U);
    for (const int id : text.views) EXPECT_EQ(hosts.count(id), 0U);
  }
  for (int id = 0; id <= 6; ++id) map.remove_keyframe(id);
  EXPECT_TRUE(map.objects().empty()) << "no key frame, no text";
}

TEST_F(TextMapTest, MemoryIsBounded) {
  textplane::TextMapOptions options;
  options.max_images = 8;
  TextMap map(scene.camera, options);
  walk(map, 25);
  EXPECT_LE(map.keyframes().bytes(), 8U * (320 * 240 + 160 * 120 + 80 * 60));
  EXPECT_LE(map.keyframes().size(), 8U + 3U) << "the images kept, and the poses of the hosts";
  EXPECT_EQ(mapped(map), 3);
}

TEST_F(TextMapTest, TheSameCallsGiveTheSameBits) {
  TextMap a(scene.camera), b(scene.camera);
  walk(a, 6);
  walk(b, 6);
  ASSERT_EQ(a.objects().size(), b.objects().size());
  for (std::size_t i = 0; i < a.objects().size(); ++i) {
    EXPECT_EQ(a.objects()[i].theta, b.objects()[i].theta);
    EXPECT_EQ(a.objects()[i].covariance, b.objects()[i].covariance);
  }
}

TEST_F(TextMapTest, SeveralCamerasOfARigObserveOneText) {
  TextMap map(scene.camera);
  textplane::SE3d T_r_l;  // left to right
  T_r_l.t = Vec3(-0.12, 0, 0);
  Pinhole<double> other = scene.camera;
  std::vector<Pyramid> kept;
  kept.reserve(20);
  for (int step = 0; step <= 3; ++step)
    for (int side = 0; side < 2; ++side) {
      const SE3d T = side == 0 ? pose(step) : T_r_l * pose(step);
      kept.push_back(image(T));
      textplane::TextImage view;
      view.pyramid = kept.back();
      view.camera = other;
      ASSERT_EQ(map.add_keyframe(2 * step + side, view, T, quads(T), points(T, 0.1)), Status::ok);
    }
  EXPECT_EQ(mapped(map), 3);
  EXPECT_LT(largest_angle(map), 1.0);
  const SE3d truth = T_r_l * pose(2.5);
  const TextFit fit = map.track(image(truth), textplane::se3_exp<double>(Random(3).twist(0.01, 0.004)) * truth, {});
  EXPECT_LT(shift(fit.T_c_w, truth), 2e-3);
}

}  // namespace text_map_test
