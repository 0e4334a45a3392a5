// A map made earlier goes on: its texts are restored, tracked and observed.
#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <vector>

#include "landmarks/text_map_support.hpp"

namespace text_map_test {

class TextMapRestoreTest : public TextMapTest {
 protected:
  TextMapRestoreTest() : saved(scene.camera) {}

  // `map` gets the first texts of `saved`, and the poses of their hosts.
  void restore(TextMap& map, std::size_t count = 3) {
    walk(saved, 6);
    ASSERT_EQ(mapped(saved), 3);
    std::set<int> hosts;
    for (const TextObject& text : saved.objects()) hosts.insert(text.host);
    for (const int id : hosts) ASSERT_EQ(map.restore_keyframe(id, pose(id)), Status::ok);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(map.restore_text(saved.objects()[i]), Status::ok);
  }

  TextMap saved;
};

TEST_F(TextMapRestoreTest, TracksToTheSameBits) {
  TextMap map(scene.camera);
  restore(map);
  const SE3d T = pose(5.5);
  const Pyramid frame = image(T);
  const TextFit fit = map.track(frame, T, points(T, 0.5));
  EXPECT_TRUE(fit.refined);
  EXPECT_EQ(fit.texts, 3);
  EXPECT_TRUE(same_bits(fit.T_c_w, saved.track(frame, T, points(T, 0.5)).T_c_w));
}

TEST_F(TextMapRestoreTest, KeyFramesObserveTheTextsAndAddNewOnes) {
  TextMap map(scene.camera);
  restore(map, 2);
  const SE3d T = pose(7);
  ASSERT_EQ(map.add_keyframe(7, image(T), T, quads(T), points(T, 0.1)), Status::ok);
  ASSERT_EQ(map.objects().size(), 3U) << "of the signs, one is new";
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(map.objects()[i].views.back(), 7);
    EXPECT_EQ(map.objects()[i].detections, saved.objects()[i].detections + 1);
  }
  EXPECT_GT(map.objects()[2].id, map.objects()[1].id);
}

TEST_F(TextMapRestoreTest, RefusesWhatCannotBeTracked) {
  TextMap map(scene.camera);
  restore(map);
  const std::size_t before = map.objects().size();
  SE3d bad;
  bad.t[0] = kNaN;
  EXPECT_EQ(map.restore_keyframe(50, bad), Status::non_finite);
  EXPECT_EQ(map.restore_keyframe(saved.objects()[0].host, SE3d()), Status::invalid_argument);

  TextObject good = saved.objects().back();
  EXPECT_EQ(map.restore_text(good), Status::invalid_argument) << "its id is in use";
  good.id += 10;
  const auto refused = [&](auto change) {
    TextObject text = good;
    change(text);
    return map.restore_text(text) == Status::invalid_argument && map.objects().size() == before;
  };
  EXPECT_TRUE(refused([](TextObject& text) { text.host = 50; }));
  EXPECT_TRUE(refused([](TextObject& text) { text.state = TextState::candidate; }));
  EXPECT_TRUE(refused([](TextObject& text) { text.patch.levels.clear(); }));
  EXPECT_TRUE(refused([](TextObject& text) { text.patch.status = Status::too_few; }));
  EXPECT_TRUE(refused([](TextObject& text) { text.patch.camera.fx = 0; }));
  EXPECT_TRUE(refused([](TextObject& text) { text.patch.quad.corner[1].x() = kNaN; }));
  EXPECT_TRUE(refused([](TextObject& text) { text.theta[2] = kNaN; }));
  EXPECT_TRUE(refused([](TextObject& text) { text.covariance(1, 1) = kNaN; }));
  EXPECT_TRUE(refused([](TextObject& text) { text.variance_factor = 0; }));
  EXPECT_EQ(map.restore_text(good), Status::ok);
  EXPECT_EQ(map.objects().size(), before + 1);
}

}  // namespace text_map_test
