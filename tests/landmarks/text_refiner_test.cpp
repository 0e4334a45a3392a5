// The last refinement tells how sure a plane is: views that disagree make it less so, the surface round it more.
#include "textplane/landmarks/text_refiner.hpp"

#include "landmarks/walk_support.hpp"

namespace landmarks_test {

// Points that are known to so much in every direction, for PointLookup.
struct Points {
  std::vector<Vec3> all;
  double sigma = 0.002;

  int text_point_count() const { return static_cast<int>(all.size()); }
  bool text_point(int i, Vec3* p_w) const {
    *p_w = all[static_cast<std::size_t>(i)];
    return true;
  }
  double text_point_variance(int, const Vec3&) const { return sigma * sigma; }
};

class TextRefinerTest : public WalkTest {
 protected:
  TextRefinerTest() {
    for (int i = 0; i < 6; ++i) add_target(at(0.1 * i - 0.2, 0.3, 0.04 * (i % 3)));
  }
  // Turns every other key frame about its viewing axis, so that the views contradict each other.
  void disturb(double degrees) {
    for (int k = 1; k < static_cast<int>(frames.all.size()); ++k)
      frames[k].T_w_c.R *= so3_exp<double>(Vec3(0, 0, (k % 2 == 0 ? degrees : -degrees) * kDegree));
  }
  bool refined(const Points* points = nullptr) {
    TextRefiner refiner(options, KeyframeLookup(frames));
    if (!points) return refiner.refine(text) == Refinement::refined;
    const PointLookup lookup(*points);
    return refiner.refine(text, &lookup) == Refinement::refined;
  }
};

TEST_F(TextRefinerTest, ViewsThatDisagreeMakeAPlaneLessSure) {
  options.refine_hosts = 1;  // else the planes of several hosts scatter, which is seen without
  ASSERT_TRUE(refined());
  const double agreed = normal_sigma(text);
  EXPECT_LT(angle_error(text), 0.5);
  disturb(0.3);
  ASSERT_TRUE(refined());
  EXPECT_GT(normal_sigma(text), 2 * agreed);
  EXPECT_LT(angle_error(text) * kDegree, 3 * normal_sigma(text));
}

// Whoever asks for more finds the text as it was.
TEST_F(TextRefinerTest, ATextWhoseNormalIsUncertainSaysSoAndKeepsWhatIsKnown) {
  TextObject certain = text;
  TextRefiner refiner(options, KeyframeLookup(frames));
  ASSERT_EQ(refiner.refine(certain), Refinement::refined);
  options.refine_max_sigma = 0.001;
  EXPECT_EQ(TextRefiner(options, KeyframeLookup(frames)).refine(text), Refinement::uncertain);
  EXPECT_EQ(text.theta, certain.theta);
  EXPECT_EQ(text.covariance, certain.covariance);
}

TEST_F(TextRefinerTest, ATextThatAgreesWithNoneOfItsViewsIsRefused) {
  disturb(15);
  const TextObject before = text;
  EXPECT_FALSE(refined());
  expect_unchanged(before);
}

// The limit is for what is known in the end, by the surface as well.
TEST_F(TextRefinerTest, OneThatItsSurfaceTellsIsNot) {
  disturb(1);
  const TextObject before = text;
  ASSERT_TRUE(refined());
  options.refine_max_sigma = 0.7 * normal_sigma(text) / kDegree;
  text = before;
  EXPECT_FALSE(refined());
  Points points;  // on the wall, in and beside the sign
  for (int i = 0; i < 80; ++i) points.all.emplace_back(-0.45 + 0.1 * (i % 10), -0.35 + 0.1 * (i / 10), 3);
  EXPECT_TRUE(refined(&points));
  EXPECT_LT(normal_sigma(text), options.refine_max_sigma * kDegree);
}

}  // namespace landmarks_test
