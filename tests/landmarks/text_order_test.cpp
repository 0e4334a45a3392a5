// The plane of a text does not depend on the order in which its key frames are given, beyond rounding.
#include "textplane/landmarks/text_refiner.hpp"

#include "landmarks/walk_support.hpp"

namespace landmarks_test {

// Key frames under other ids, for KeyframeLookup.
struct Renamed {
  const Frames* frames;
  std::vector<int> own;  // id of `frames` of each id

  TextKeyframe text_keyframe(int id) const { return frames->text_keyframe(own[static_cast<std::size_t>(id)]); }
};

class TextOrderTest : public WalkTest {
 protected:
  TextOrderTest() {
    for (int i = 0; i < 5; ++i) add_target(at(0.1 * i - 0.2, 0.3, 0.04 * (i % 3)));
  }
  void expect_same_plane(const TextObject& a, const TextObject& b) {
    EXPECT_LT((a.theta - b.theta).norm(), 1e-5 * a.theta.norm());
    EXPECT_LT((a.covariance - b.covariance).norm(), 1e-2 * a.covariance.norm());
    EXPECT_NEAR(a.zncc, b.zncc, 1e-5);
  }
};

TEST_F(TextOrderTest, OfTheViewsThatAPlaneIsRefinedAgainst) {
  TextObject forth = text, back = text, mixed = text;
  std::vector<int> ids = text.views;
  ASSERT_TRUE(refine_text_plane(options, KeyframeLookup(frames), ids, text.theta, 0.6, forth));
  std::reverse(ids.begin(), ids.end());
  ASSERT_TRUE(refine_text_plane(options, KeyframeLookup(frames), ids, text.theta, 0.6, back));
  std::rotate(ids.begin(), ids.begin() + 3, ids.end());
  ASSERT_TRUE(refine_text_plane(options, KeyframeLookup(frames), ids, text.theta, 0.6, mixed));
  expect_same_plane(forth, back);
  expect_same_plane(forth, mixed);
}

TEST_F(TextOrderTest, OfTheIdsOfKeyFrames) {
  options.refine_hosts = 20;  // all: of too many, some are chosen by their places in the order
  TextObject before = text;
  ASSERT_EQ(TextRefiner(options, KeyframeLookup(frames)).refine(before), Refinement::refined);
  const int n = static_cast<int>(frames.all.size());
  for (const int step : {3, n - 1}) {  // of no common factor with n: 11 key frames
    Renamed renamed{&frames, std::vector<int>(frames.all.size())};
    std::vector<int> id_of(frames.all.size());
    for (int id = 0; id < n; ++id) {
      renamed.own[static_cast<std::size_t>(id)] = (id * step + 2) % n;
      id_of[static_cast<std::size_t>((id * step + 2) % n)] = id;
    }
    TextObject other = text;
    other.host = id_of[static_cast<std::size_t>(text.host)];
    for (int& id : other.views) id = id_of[static_cast<std::size_t>(id)];
    std::sort(other.views.begin(), other.views.end());
    ASSERT_EQ(TextRefiner(options, KeyframeLookup(renamed)).refine(other), Refinement::refined);
    expect_same_plane(before, other);
    EXPECT_NEAR(before.variance_factor, other.variance_factor, 1e-2 * before.variance_factor);
  }
}

}  // namespace landmarks_test
