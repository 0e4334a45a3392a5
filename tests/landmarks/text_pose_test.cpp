// The pose by texts whose planes are unknowns, held by their covariances.
#include "textplane/landmarks/text_pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "landmarks/text_map_support.hpp"

namespace text_map_test {

class TextPoseTest : public TextMapTest {
 protected:
  TextPoseTest() : map(scene.camera) {
    walk(map, 6);
    objects = map.objects();
  }
  // From a pose that is a little off, with planes that are known `times` worse in variance.
  SE3d solved(double times, int iterations) {
    const SE3d truth = pose(5.5);
    const Pyramid frame = image(truth);
    const textplane::TextImage view = view_of(frame);
    std::vector<textplane::FrameText> texts;
    for (TextObject& object : objects) {
      object.covariance *= times;
      texts.push_back(used(object));
    }
    SE3d T = textplane::se3_exp<double>(Random(4).twist(0.003, 0.001)) * truth;
    EXPECT_TRUE(solver.solve({}, 1, texts, view, &T, iterations));
    for (TextObject& object : objects) object.covariance /= times;
    return T;
  }
  textplane::TextImage view_of(const Pyramid& frame) const {
    textplane::TextImage view;
    view.pyramid = frame;
    view.camera = scene.camera;
    return view;
  }
  textplane::FrameText used(const TextObject& object) const {
    textplane::FrameText text;
    text.object = &object;
    text.T_w_h = map.keyframes().text_keyframe(object.host).T_w_c;
    text.used = true;
    return text;
  }
  double position_information() const { return solver.information().template topLeftCorner<3, 3>().trace(); }

  TextMap map;
  std::vector<TextObject> objects;
  textplane::TextPose solver;
};

TEST_F(TextPoseTest, ATextSaysLessWhereItsPlaneIsLessKnown) {
  solved(1, 8);
  const double known = position_information();
  solved(1e4, 8);
  EXPECT_LT(position_information(), 0.7 * known);
  EXPECT_GT(position_information(), 0);
}

// The covariances pull the planes back to what is known of them.
TEST_F(TextPoseTest, MoreIterationsComeToTheSamePose) {
  const SE3d few = solved(1, 10), many = solved(1, 60);
  EXPECT_LT(shift(few, many), 1e-5);
  EXPECT_LT(shift(many, pose(5.5)), 2e-3);
}

// Two texts and no points: each alone has a pose and a covariance, and these say how far the two are apart.
TEST_F(TextPoseTest, TextsDisagreeByTheDistanceOfTheirOwnPoses) {
  scene.signs[1].T_w_h.t.x() += 0.003;
  const Pyramid frame = image(pose(5.5));
  const textplane::TextImage view = view_of(frame);
  std::vector<textplane::FrameText> texts = {used(objects[1]), used(objects[2])};
  SE3d T[2];
  textplane::FixedMatrix<double, 6, 6> covariance[2];
  for (std::size_t i = 0; i < 2; ++i) {
    texts[i].used = true;
    texts[1 - i].used = false;
    T[i] = pose(5.5);
    ASSERT_TRUE(solver.solve({}, 1, texts, view, &T[i], 60));
    covariance[i] = textplane::Ldlt<double, 6>(solver.information(), 1e-14).inverse();
  }
  const Vec6 apart = textplane::se3_log<double>(T[0] * T[1].inverse());
  const textplane::FixedMatrix<double, 6, 6> sum = covariance[0] + covariance[1];
  const double r = std::sqrt(apart.dot(textplane::Ldlt<double, 6>(sum, 1e-14).solve(apart)) / 6);

  texts[0].used = texts[1].used = true;
  SE3d both = pose(5.5);
  ASSERT_TRUE(solver.solve({}, 1, texts, view, &both, 60));
  EXPECT_TRUE(solver.weigh(texts, 1e-3, 1e6));
  for (const auto& text : texts) EXPECT_NEAR(1e-3 / text.trust, r, 0.05 * r);
}

// Points that have all moved by the same: their residuals stay as they are.
TEST_F(TextPoseTest, TheDoubtOfThePointsBringsTextsAndPointsTogether) {
  const Pyramid frame = image(pose(5.5));
  const textplane::TextImage view = view_of(frame);
  std::vector<textplane::FrameText> texts;
  for (const TextObject& object : objects) texts.push_back(used(object));
  std::vector<textplane::PosePointTerm> terms;
  for (const TextPoint& point : points(pose(5.5), 0.3)) terms.push_back({point.p_w + Vec3(0.005, 0, 0), point.px, 1});
  SE3d at = pose(5.5);
  ASSERT_TRUE(solver.solve(terms, 0.3, texts, view, &at, 60));
  const double f = solver.point_doubt(texts, 1);
  ASSERT_GT(f, 4);
  ASSERT_LT(f, 250);
  // It is the same however the points were weighed before.
  ASSERT_TRUE(solver.solve(terms, 0.3 * std::sqrt(f), texts, view, &at, 60));
  EXPECT_NEAR(std::log(solver.point_doubt(texts, f)), std::log(f), 0.5);
  texts[1].used = texts[2].used = false;
  ASSERT_TRUE(solver.solve(terms, 0.3, texts, view, &at, 60));
  EXPECT_EQ(solver.point_doubt(texts, 1), 0) << "one text";
}

}  // namespace text_map_test
