// The life of a TextMap: moved key frames, bad input, ids and states, hosts that leave, memory, rigs.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <vector>

#include "landmarks/text_map_support.hpp"

namespace text_map_test {

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
  const TextFit fit = map.track(frame, T * aside, {});
  EXPECT_TRUE(fit.refined);
  const SE3d along = fit.T_c_w * aside.inverse();
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
  EXPECT_EQ(map.track(image(pose(5)), pose(5), {}).texts, 3) << "seen by their new hosts";
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

TEST_F(TextMapTest, AFitStaysWhatItWasWhereItIsCopied) {
  TextMap map(scene.camera);
  walk(map, 6);
  const SE3d T = pose(5.5);
  const auto copy = map.track(image(T), T, points(T, 1));
  const auto& latest = map.track(image(T), pose(5), {});
  EXPECT_EQ(copy.reports.size(), 3U);
  EXPECT_FALSE(same_bits(copy.T_c_w, latest.T_c_w));
  EXPECT_EQ(&map.track(Pyramid(), T, {}), &latest);
  EXPECT_TRUE(latest.reports.empty());
  EXPECT_EQ(copy.texts, 3);
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
