// What holds for a TextMap whatever a host does: calls drawn at random, and the same calls in another order or twice.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <map>
#include <set>
#include <vector>

#include "landmarks/text_map_support.hpp"

namespace text_map_test {

template <class Matrix>
bool same_numbers(const Matrix& a, const Matrix& b) {
  return std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

void expect_same_bits(const TextMap& a, const TextMap& b) {
  ASSERT_EQ(a.objects().size(), b.objects().size());
  for (std::size_t i = 0; i < a.objects().size(); ++i) {
    const TextObject &x = a.objects()[i], &y = b.objects()[i];
    SCOPED_TRACE(x.id);
    EXPECT_EQ(x.id, y.id);
    EXPECT_EQ(x.state, y.state);
    EXPECT_EQ(x.host, y.host);
    EXPECT_EQ(x.views, y.views);
    EXPECT_EQ(x.votes, y.votes);
    EXPECT_EQ(x.detections, y.detections);
    EXPECT_EQ(x.shown, y.shown);
    EXPECT_EQ(x.failures, y.failures);
    EXPECT_EQ(x.zncc, y.zncc);
    EXPECT_EQ(x.variance_factor, y.variance_factor);
    EXPECT_TRUE(same_numbers(x.theta, y.theta));
    EXPECT_TRUE(same_numbers(x.covariance, y.covariance));
    for (std::size_t k = 0; k < 4; ++k) EXPECT_TRUE(same_numbers(x.patch.quad.corner[k], y.patch.quad.corner[k]));
  }
}

class TextMapProperties : public TextMapTest {
 protected:
  // One call of a host: mostly a key frame, with some of its quads and a wrong one; else a move, or a removal.
  void call(TextMap& map, Random& random, int step) const {
    const double kind = random.uniform(0, 1);
    const SE3d T = pose(0.4 * step);
    if (kind < 0.75) {
      std::vector<TextDetection> seen;
      for (const TextDetection& detection : quads(T))
        if (random.uniform(0, 1) < 0.7) seen.push_back(detection);
      const double x = random.uniform(10, 240), y = random.uniform(10, 190);
      seen.emplace_back();
      seen.back().quad.corner = {Vec2(x, y), Vec2(x + 60, y), Vec2(x + 60, y + 30), Vec2(x, y + 30)};
      EXPECT_EQ(map.add_keyframe(step, image(T), T, seen, points(T, 0.3)), Status::ok);
    } else if (kind < 0.85) {
      const SE3d aside = textplane::se3_exp<double>(random.twist(0.02, 0.01));
      map.move([&](int id) { return map.keyframes().text_keyframe(id).T_c_w() * aside; });
    } else {
      map.remove_keyframe(static_cast<int>(random.uniform(0, step + 1)));
    }
  }
};

struct Known {
  TextState state;
  int detections, shown;
};

TEST_F(TextMapProperties, NoCallLosesAnIdOrGoesBack) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    textplane::TextMapOptions options;
    options.max_images = 10;
    TextMap map(scene.camera, options);
    Random random(seed);
    std::map<int, Known> before;
    int newest = -1;
    for (int step = 0; step < 30; ++step) {
      call(map, random, step);
      std::map<int, Known> now;
      for (const TextObject& text : map.objects()) {
        EXPECT_TRUE(now.empty() || now.rbegin()->first < text.id) << "in the order of their ids";
        now[text.id] = {text.state, text.detections, text.shown};
        EXPECT_NE(text.state, TextState::dropped);
        EXPECT_LE(text.detections, text.shown);
        const auto known = before.find(text.id);
        if (known == before.end()) {
          EXPECT_GT(text.id, newest) << "an id that was used before";
          continue;
        }
        EXPECT_GE(text.state, known->second.state);
        EXPECT_GE(text.detections, known->second.detections);
        EXPECT_GE(text.shown, known->second.shown);
      }
      if (!now.empty()) newest = std::max(newest, now.rbegin()->first);
      before = now;
    }
    EXPECT_GE(mapped(map), 2) << "or nothing was tried";
  }
}

// What only looks, and what takes none of its key frames away, takes no text away.
TEST_F(TextMapProperties, TracksMovesAndRemovedStrangersKeepEveryText) {
  TextMap map(scene.camera), untouched(scene.camera);
  walk(map, 8);
  walk(untouched, 8);
  const SE3d T = pose(6.5);
  map.track(image(T), T, points(T, 0.5));
  map.track(image(T), textplane::se3_exp<double>(Random(2).twist(1, 1)) * T, {});
  map.remove_keyframe(77);
  map.move([&](int id) { return pose(id); });
  expect_same_bits(map, untouched);
}

TEST_F(TextMapProperties, CornersOfMovedKeyFramesComeBackToTheBit) {
  TextMap map(scene.camera);
  walk(map, 6);
  const auto corners_of = [&] {
    std::vector<std::array<Vec3, 4>> all;
    for (const TextObject& text : map.objects()) {
      all.emplace_back();
      EXPECT_TRUE(map.corners(text, &all.back()));
    }
    return all;
  };
  map.move([&](int id) { return pose(id); });
  const auto before = corners_of();
  ASSERT_EQ(before.size(), 3U);
  const SE3d aside = textplane::se3_exp<double>(Random(9).twist(0.2, 0.1));
  map.move([&](int id) { return pose(id) * aside; });
  const auto moved = corners_of();
  map.move([&](int id) { return pose(id); });
  const auto after = corners_of();
  for (std::size_t i = 0; i < before.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_TRUE(same_numbers(after[i][k], before[i][k]));
      EXPECT_LT((aside * moved[i][k] - before[i][k]).norm(), 1e-12) << "they go with their key frames";
      EXPECT_GT((moved[i][k] - before[i][k]).norm(), 0.01);
    }
}

TEST_F(TextMapProperties, TheSameDrawnCallsGiveTheSameBits) {
  TextMap a(scene.camera), b(scene.camera);
  Random of_a(5), of_b(5);
  for (int step = 0; step < 16; ++step) call(a, of_a, step);
  for (int step = 0; step < 16; ++step) call(b, of_b, step);
  ASSERT_GE(mapped(a), 2);
  expect_same_bits(a, b);
  const SE3d T = pose(5.5);
  EXPECT_TRUE(same_bits(a.track(image(T), T, points(T, 0.5)).T_c_w, b.track(image(T), T, points(T, 0.5)).T_c_w));
}

// The store forgets old key frames, and a host may use their ids again: for other images.
TEST_F(TextMapProperties, AnIdThatWasForgottenIsANewKeyFrame) {
  textplane::TextMapOptions options;
  options.max_images = 4;
  TextMap map(scene.camera, options);
  walk(map, 9);
  ASSERT_EQ(mapped(map), 3);
  int forgotten = 1;
  const auto names = [&](const TextObject& text) {
    return std::find(text.views.begin(), text.views.end(), forgotten) != text.views.end();
  };
  while (forgotten < 5 && (map.keyframes().has(forgotten) || !names(map.objects()[0]))) ++forgotten;
  ASSERT_LT(forgotten, 5) << "no text was seen by a key frame that is forgotten";
  const SE3d T = pose(9.5);
  ASSERT_EQ(map.add_keyframe(forgotten, image(T), T, quads(T), points(T, 0.1)), Status::ok);
  for (const TextObject& text : map.objects()) {
    EXPECT_TRUE(std::is_sorted(text.views.begin(), text.views.end()));
    EXPECT_EQ(std::set<int>(text.views.begin(), text.views.end()).size(), text.views.size());
  }
  map.remove_keyframe(forgotten);
  for (int id = 0; id < 9; ++id) map.remove_keyframe(id);
  for (const TextObject& text : map.objects()) EXPECT_LE(text.views.size() + 1, 1U) << "of key frame 9 alone";
}

}  // namespace text_map_test
