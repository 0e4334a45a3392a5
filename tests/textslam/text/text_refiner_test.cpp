// The last refinement takes the map's points into account, and drops what is no text.
#include "textslam/text/text_refiner.hpp"

#include "textplane/landmarks/text_view.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/text/text_hosting_support.hpp"

namespace textslam {
namespace text_hosting_test {

class TextRefinerTest : public TextHostingTest {
 protected:
  TextRefinerTest() {
    for (int i = 0; i < 6; ++i) add_target(at(0.1 * i - 0.2, 0.3, 0.04 * (i % 3)));
  }
  // Turns every other key frame about its viewing axis, so that the views contradict each other.
  void disturb(double degrees) {
    for (std::size_t k = 1; k < map.keyframes.size(); ++k)
      map.keyframes[k].T_w_c.R *= textplane::so3_exp<double>(Vec3(0, 0, (k % 2 == 0 ? degrees : -degrees) * kDegree));
  }
  // Points on the wall in and beside the sign, as the key frames see them.
  void add_wall() {
    for (int i = 0; i < 80; ++i) {
      map.points.emplace_back();
      map.points.back().p_w = Vec3(-0.45 + 0.1 * (i % 10), -0.35 + 0.1 * (i / 10), 3);
      for (const int k : map.keyframe_ids())
        add_observation(map, i, k, map.camera.project(map.keyframe(k).T_w_c.inverse() * map.points.back().p_w));
    }
  }
};

TEST_F(TextRefinerTest, KeepsATextThatItsViewsAgreeOn) {
  refine_texts(map, parameters);
  EXPECT_EQ(text().state, TextState::mapped);
  EXPECT_LT(angle_error(text()), 0.5);
}

TEST_F(TextRefinerTest, DropsOneThatAgreesWithNoneOfItsViews) {
  disturb(15);
  refine_texts(map, parameters);
  EXPECT_EQ(text().state, TextState::dropped);
}

TEST_F(TextRefinerTest, AndOneThatTheDetectorSawTooSeldom) {
  text().shown = static_cast<int>(text().detections / parameters.text.detected_share) + 1;
  refine_texts(map, parameters);
  EXPECT_EQ(text().state, TextState::dropped);
}

TEST_F(TextRefinerTest, LeavesThoseThatAreNotMappedAlone) {
  text().state = TextState::tentative;
  const Vec3 theta = text().theta;
  refine_texts(map, parameters);
  EXPECT_EQ(text().state, TextState::tentative);
  EXPECT_EQ(text().theta, theta);
}

// The limit is for what is known in the end, by the surface as well.
TEST_F(TextRefinerTest, OneThatItsSurfaceTellsStays) {
  disturb(1);
  const Map before = map;
  refine_texts(map, parameters);
  parameters.text.refine_max_sigma = 0.7 * normal_sigma(text()) / kDegree;
  map = before;
  refine_texts(map, parameters);
  EXPECT_EQ(text().state, TextState::dropped);
  map = before;
  add_wall();
  refine_texts(map, parameters);
  EXPECT_EQ(text().state, TextState::mapped);
  EXPECT_LT(normal_sigma(text()), parameters.text.refine_max_sigma * kDegree);
}

}  // namespace text_hosting_test
}  // namespace textslam
