// The last refinement tells how sure a plane is: views that disagree make it less so, the surface round it more.
#include "textslam/text/text_refiner.hpp"
#include "textslam/map/text_geometry.hpp"

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
  void refine() { TextRefiner(map, parameters).refine(); }
};

TEST_F(TextRefinerTest, ViewsThatDisagreeMakeAPlaneLessSure) {
  parameters.refine_hosts = 1;  // else the planes of several hosts scatter, which is seen without
  refine();
  ASSERT_EQ(text().state, TextState::mapped);
  const double agreed = normal_sigma(text());
  EXPECT_LT(angle_error(text()), 0.5);
  disturb(0.3);
  refine();
  ASSERT_EQ(text().state, TextState::mapped);
  EXPECT_GT(normal_sigma(text()), 2 * agreed);
  EXPECT_LT(angle_error(text()) * kDegree, 3 * normal_sigma(text()));
}

TEST_F(TextRefinerTest, ATextWhoseNormalNobodyKnowsIsDropped) {
  parameters.refine_max_sigma = 0.001;
  refine();
  EXPECT_EQ(text().state, TextState::dropped);
}

TEST_F(TextRefinerTest, ATextThatAgreesWithNoneOfItsViewsIsDropped) {
  disturb(15);
  refine();
  EXPECT_EQ(text().state, TextState::dropped);
}

TEST_F(TextRefinerTest, AndOneThatTheDetectorSawTooSeldom) {
  text().shown = static_cast<int>(text().detections / parameters.text_detected_share) + 1;
  refine();
  EXPECT_EQ(text().state, TextState::dropped);
}

// The limit is for what is known in the end, by the surface as well.
TEST_F(TextRefinerTest, OneThatItsSurfaceTellsStays) {
  disturb(1);
  const Map before = map;
  refine();
  parameters.refine_max_sigma = 0.7 * normal_sigma(text()) / kDegree;
  map = before;
  refine();
  EXPECT_EQ(text().state, TextState::dropped);
  map = before;
  add_wall();
  refine();
  EXPECT_EQ(text().state, TextState::mapped);
  EXPECT_LT(normal_sigma(text()), parameters.refine_max_sigma * kDegree);
}

}  // namespace text_hosting_test
}  // namespace textslam
