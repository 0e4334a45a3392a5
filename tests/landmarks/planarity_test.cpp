// A text round a cylinder or over an edge is told from a flat one, by how far it is bent.
#include "textplane/landmarks/planarity.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "landmarks/walk_support.hpp"
#include "textplane/landmarks/text_map.hpp"
#include "textplane/landmarks/text_refiner.hpp"

namespace landmarks_test {

class PlanarityTest : public WalkTest {
 protected:
  void walk(const std::function<double(double)>& shape) {
    wall.relief = shape;
    begin();
    for (int i = 0; i < 6; ++i) add_target(at(0.1 * i - 0.2, 0.3, 0.04 * (i % 3)));
  }
  static std::function<double(double)> cylinder(double radius) {
    return [radius](double x) { return radius - std::sqrt(std::max(0.0, radius * radius - x * x)); };
  }
  Bend bend() {
    std::vector<PlaneTarget> targets;
    for (const int id : text.views) targets.push_back({frames[id].image->view(), frames.between(id, 0), 0});
    PhotometricWorkspace workspace;
    workspace.reserve(text.patch.max_pixels());
    Bend out;
    EXPECT_TRUE(bend_of(text.patch, text.theta, targets, wall.camera, options.refine_bend_sigmas, workspace, &out));
    return out;
  }
  Refinement refinement() { return TextRefiner(options, KeyframeLookup(frames)).refine(text); }
  // How many texts a TextMap had mapped after each key frame of the walk.
  std::vector<std::ptrdiff_t> mapped_on_the_way() const {
    TextMap map(wall.camera);
    std::vector<std::ptrdiff_t> out;
    for (std::size_t i = 0; i < frames.all.size(); ++i) {
      TextDetection sign;
      sign.quad = wall.quad_in(frames.all[i].T_w_c);
      map.add_keyframe(static_cast<int>(i), Pyramid(*frames.all[i].image), frames.all[i].T_w_c.inverse(), {sign}, {});
      out.push_back(std::count_if(map.objects().begin(), map.objects().end(),
                                  [](const TextObject& one) { return one.state == TextState::mapped; }));
    }
    return out;
  }
};

TEST_F(PlanarityTest, ABendIsTheTurnOfTheNormalFromEndToEnd) {
  // Depth x^2 / 2R over the half width h: the slopes at both ends differ by 2 h / R.
  for (const double turn : {0.3, 0.6, -0.6}) {
    const double radius = 2 * kHalfWidth / std::abs(turn);
    walk([&](double x) { return std::copysign(x * x / (2 * radius), turn); });
    const Bend found = bend();
    EXPECT_NEAR(found.value.x(), turn, 0.1 * std::abs(turn) + 3 * found.sigma.x());
    EXPECT_NEAR(found.value.y(), 0, 0.05 + 3 * found.sigma.y());
    EXPECT_LT(found.sigma.x(), 0.1);
    EXPECT_GT(found.explained, 0.15);
  }
}

TEST_F(PlanarityTest, AFlatTextHasNone) {
  walk(nullptr);
  const Bend found = bend();
  EXPECT_NEAR(found.value.x(), 0, 0.02 + 3 * found.sigma.x());
  EXPECT_NEAR(found.value.y(), 0, 0.02 + 3 * found.sigma.y());
  EXPECT_LT(found.explained, 0.05);
  EXPECT_EQ(refinement(), Refinement::refined);
}

// Bends of .5 and 1.2: the more a text is bent, the less it knows its plane, and that must not save it.
TEST_F(PlanarityTest, ATextRoundACylinderIsBent) {
  for (const double radius : {1.2, 0.5}) {
    walk(cylinder(radius));
    EXPECT_EQ(refinement(), Refinement::bent) << radius;
  }
}

TEST_F(PlanarityTest, OneOverTheEdgeOfACartonIsBent) {
  for (const double slope : {0.3, 0.6}) {
    walk([&](double x) { return slope * std::abs(x); });
    EXPECT_EQ(refinement(), Refinement::bent) << slope;
  }
}

TEST_F(PlanarityTest, APageThatCurlsALittleStays) {
  walk(cylinder(8));
  EXPECT_EQ(refinement(), Refinement::refined);
}

TEST_F(PlanarityTest, NoMapTakesABentText) {
  const auto most = [&] {
    const auto mapped = mapped_on_the_way();
    return *std::max_element(mapped.begin(), mapped.end());
  };
  walk(nullptr);
  EXPECT_EQ(most(), 1) << "flat";
  walk(cylinder(0.6));
  EXPECT_EQ(most(), 0);
}

TEST_F(PlanarityTest, AMapGivesUpATextThatTurnsOutToBeBent) {
  wall.relief = cylinder(0.8);
  frames.all.clear();
  for (int i = 0; i < 8; ++i) add_keyframe(at(0.02 * i, 0));
  for (int i = 1; i <= 10; ++i) add_keyframe(at(0.14 + 0.04 * i, 0.025 * i, 0.05 + 0.04 * (i % 3)));
  const auto mapped = mapped_on_the_way();
  EXPECT_EQ(mapped[7], 1) << "from one side it looks flat";
  EXPECT_EQ(mapped.back(), 0);
}

// What bends the images of a flat text turns its plane as well: two views whose poses err about the viewing axis.
TEST_F(PlanarityTest, ABendThatIsNoneMakesAPlaneLessSure) {
  walk(cylinder(2));
  const Bend found = bend();
  TextObject doubtful = text;
  doubtful.covariance = found.doubt;
  const double excess = std::abs(found.value.x()) - options.refine_bend_sigmas * found.sigma.x();
  ASSERT_GT(excess, 0.1);
  EXPECT_NEAR(normal_sigma(doubtful), excess / 4, 0.1 * excess / 4) << "a fourth of it";
}

}  // namespace landmarks_test
