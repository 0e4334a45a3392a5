// Texts that are one sign, mapped twice, become one object; others stay apart.
#include "textplane/landmarks/text_merge.hpp"

#include <gtest/gtest.h>

#include "landmarks/frames_support.hpp"

namespace landmarks_test {

// Two key frames that look at a wall three units away; texts are put on it from either.
class TextMergeTest : public testing::Test {
 protected:
  TextMergeTest() {
    frames.camera = {525, 525, 319.5, 239.5};
    frames.all.resize(6);
    frames[1].T_w_c = {so3_exp<double>(Vec3(0.02, -0.15, 0.05)), Vec3(0.6, 0.1, 0.2)};
  }
  // A text with its left end at (x, 0, 3), 0.6 wide, hosted by a key frame; turned about its centre's vertical axis and
  // farther away by a factor.
  int add(int host, double x, const std::string& word, const std::vector<int>& targets, double turn = 0,
          double far = 1) {
    TextObject text;
    text.id = static_cast<int>(texts.size());
    text.state = TextState::mapped;
    text.host = host;
    text.views = targets;
    text.patch.camera = frames.camera;
    if (!word.empty()) text.votes[word] = 2;
    text.detections = 5;
    text.shown = 9;
    const SE3d T_h_w = frames[host].T_w_c.inverse();
    const Vec3 centre(x + 0.3, 0.1, 3);
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 p(i == 0 || i == 3 ? -0.3 : 0.3, i < 2 ? -0.1 : 0.1, 0);
      text.patch.quad.corner[i] = frames.camera.project(T_h_w * Vec3(centre + p));
    }
    const Vec3 normal = T_h_w.R * so3_exp<double>(Vec3(0, turn * kDegree, 0)) * Vec3(0, 0, -1);
    text.theta = plane_from_normal<double>(normal, -normal.dot(far * (T_h_w * centre)));
    text.covariance = 1e-8 * Eigen::Matrix3d::Identity();
    texts.push_back(text);
    return text.id;
  }
  bool same(int a, int b) const {
    const bool one = same_text(options, KeyframeLookup(frames), text(a), text(b));
    EXPECT_EQ(same_text(options, KeyframeLookup(frames), text(b), text(a)), one);
    return one;
  }
  TextObject& text(int id) { return texts[static_cast<std::size_t>(id)]; }
  const TextObject& text(int id) const { return texts[static_cast<std::size_t>(id)]; }

  Frames frames;
  std::vector<TextObject> texts;
  TextOptions options;
};

TEST_F(TextMergeTest, OneSignSeenFromTwoPlacesIsOne) {
  const int a = add(0, -0.4, "EXIT", {2, 3});
  EXPECT_TRUE(same(a, add(1, -0.4, "EXIT", {})));
  EXPECT_TRUE(same(a, add(1, -0.4, "", {}))) << "unread";
  EXPECT_TRUE(same(a, add(1, -0.35, "EXIT", {}, 3, 1.01))) << "a little off";
  EXPECT_FALSE(same(a, add(1, -0.4, "OPEN", {}))) << "another word";
  EXPECT_FALSE(same(a, add(1, 0.3, "EXIT", {}))) << "the sign beside it";
  EXPECT_FALSE(same(a, add(1, -0.4, "EXIT", {}, 30))) << "another slant";
  EXPECT_FALSE(same(a, add(0, -0.4, "EXIT", {}, 0, 1.2))) << "the same quad, but farther away";
}

TEST_F(TextMergeTest, WhatIsUncertainMayDisagreeMore) {
  const int a = add(0, -0.4, "EXIT", {}), b = add(1, -0.4, "EXIT", {}, 14);
  EXPECT_FALSE(same(a, b));
  // 3 degrees of the normal: theta is 1/3 long.
  text(b).covariance = std::pow(3 * kDegree / 3, 2) * Eigen::Matrix3d::Identity();
  EXPECT_TRUE(same(a, b));
}

TEST_F(TextMergeTest, TheOneObservedMoreIsKeptAndGetsAll) {
  const int few = add(0, -0.4, "EXIT", {2, 3}), many = add(1, -0.4, "", {3, 4, 5, 2}), apart = add(0, 0.5, "EXIT", {2});
  text(few).failures = text(many).failures = 2;
  EXPECT_EQ(merge_duplicate_texts(options, KeyframeLookup(frames), texts), 1);
  EXPECT_EQ(text(few).state, TextState::dropped);
  EXPECT_TRUE(text(few).views.empty()) << "what was seen of it is given back";
  EXPECT_EQ(text(apart).state, TextState::mapped);
  const TextObject& kept = text(many);
  EXPECT_EQ(kept.state, TextState::mapped);
  EXPECT_EQ(kept.views, (std::vector<int>{0, 2, 3, 4, 5})) << "each once, and not its own host";
  EXPECT_EQ(consensus(kept.votes), "EXIT");
  EXPECT_EQ(kept.detections, 10);
  EXPECT_EQ(kept.shown, 18);
  EXPECT_EQ(kept.failures, 0);
  EXPECT_EQ(merge_duplicate_texts(options, KeyframeLookup(frames), texts), 0);
}

// A pair is compared where one of the two was seen, whichever comes first. The older one is kept, so what was seen may
// be gone after the first.
TEST_F(TextMergeTest, PairsOfWhichNoneWasSeenWait) {
  for (int seen = -1; seen < 3; ++seen) {
    texts.clear();
    for (const int host : {0, 1, 2}) add(host, -0.4, "EXIT", {3});
    const int merged = merge_duplicate_texts(options, KeyframeLookup(frames), texts,
                                             [seen](const TextObject& text) { return text.id == seen; });
    EXPECT_EQ(merged, seen < 0 ? 0 : seen == 0 ? 2 : 1);
  }
}

TEST_F(TextMergeTest, ThreeBecomeOneAndUnfinishedOnesStay) {
  const int a = add(0, -0.4, "EXIT", {1, 2});
  add(1, -0.4, "EXIT", {2});
  add(2, -0.4, "EXIT", {3});
  text(add(1, -0.4, "EXIT", {2})).state = TextState::tentative;
  EXPECT_EQ(merge_duplicate_texts(options, KeyframeLookup(frames), texts), 2);
  EXPECT_EQ(text(a).state, TextState::mapped);
  EXPECT_EQ(text(a).views, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(text(a).votes.at("EXIT"), 6);
  EXPECT_EQ(text(3).state, TextState::tentative);
}

}  // namespace landmarks_test
