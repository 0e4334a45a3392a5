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

Quad<double> quad_of(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  Quad<double> quad;
  quad.corner = {a, b, c, d};
  return quad;
}

TEST(GrownQuad, ARectangleGrowsOnAllFourSides) {
  const Quad<double> out = detail::grown(quad_of(Vec2(10, 20), Vec2(50, 20), Vec2(50, 35), Vec2(10, 35)), 3);
  const Quad<double> expected = quad_of(Vec2(7, 17), Vec2(53, 17), Vec2(53, 38), Vec2(7, 38));
  for (std::size_t k = 0; k < 4; ++k) EXPECT_LT((out.corner[k] - expected.corner[k]).norm(), 1e-12) << k;
}

TEST(GrownQuad, AMirroredQuadGrowsToTheMirrorOfWhatItGrewTo) {
  const Vec2 a(0, 0), b(20, -1), c(21, 16), d(0, 8), flip(1, -1), turn(-1, 1);
  const Quad<double> out = detail::grown(quad_of(a, b, c, d), 3);
  const auto& [oa, ob, oc, od] = out.corner;
  const auto expect_same = [](const Quad<double>& x, const Quad<double>& y) {
    for (std::size_t k = 0; k < 4; ++k) EXPECT_LT((x.corner[k] - y.corner[k]).norm(), 1e-12) << k;
  };
  const auto by = [](const Vec2& signs, const Vec2& p) { return Vec2(signs.cwiseProduct(p)); };
  expect_same(detail::grown(quad_of(by(flip, d), by(flip, c), by(flip, b), by(flip, a)), 3),
              quad_of(by(flip, od), by(flip, oc), by(flip, ob), by(flip, oa)));
  expect_same(detail::grown(quad_of(by(turn, b), by(turn, a), by(turn, d), by(turn, c)), 3),
              quad_of(by(turn, ob), by(turn, oa), by(turn, od), by(turn, oc)));
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
