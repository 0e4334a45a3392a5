// Widths of texts by the boxes around them, distances of two, and the metres that follow.
#include "textslam/text/metric_scale.hpp"

#include <gtest/gtest.h>

#include <random>

#include "map_file/map_file_support.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/text/text_centre.hpp"
#include "textslam/text/text_width.hpp"

namespace textslam {
namespace metric_scale_test {

using namespace map_file_support;

// The boards as many key frames see them, with boxes that err by about a pixel.
class MetricScaleTest : public MapFileTest {
 protected:
  MetricScaleTest() {
    std::mt19937 random(5);
    const auto error = [&] { return 2e-9 * static_cast<double>(random() % 1000000000) - 1.0; };
    map.keyframes.resize(1);
    map.points.clear();
    for (TextObject& text : map.texts) {
      text.views.clear();
      text.covariance.setZero();
    }
    for (int i = 0; i < 20; ++i) {
      const SE3d T_c_w = moved({0.02 * i - 0.2, 0.01 * i, 0}, {0, 0.01 * i - 0.1, 0});
      KeyFrame keyframe;
      keyframe.T_w_c = T_c_w.inverse();
      for (std::size_t b = 0; b < boards.size(); ++b) {
        Detection box;
        box.quad = quad_of(boards[b], T_c_w);
        for (Vec2& corner : box.quad.corner) corner += Vec2(error(), error());
        keyframe.frame.detections.push_back(box);
      }
      map.keyframes.push_back(keyframe);
      for (TextObject& text : map.texts) text.views.push_back(i + 1);
    }
    map.keyframes[0].frame.detections.clear();
  }
};

TEST_F(MetricScaleTest, ManyBoxesTellTheWidth) {
  for (const TextObject& text : map.texts) {
    const TextWidth found = text_width(map, parameters, text);
    EXPECT_GE(found.boxes, 15);
    EXPECT_NEAR(found.width, 2 * kHalfWidth, 4 * found.sigma);
    EXPECT_NEAR(found.width, 2 * kHalfWidth, 0.01 * 2 * kHalfWidth);
    EXPECT_LT(found.sigma, 0.006 * found.width);
    EXPECT_GT(found.sigma, 0.0005 * found.width);
  }
}

// A box around two signs, or a part of one.
TEST_F(MetricScaleTest, ABoxFarOffDoesNotCount) {
  Quad<double>& box = map.keyframes[4].frame.detections[1].quad;
  box.corner[1].x() += 12;
  box.corner[2].x() += 12;
  const TextWidth found = text_width(map, parameters, map.texts[1]);
  EXPECT_LE(found.boxes, 19);
  EXPECT_NEAR(found.width, 2 * kHalfWidth, 0.01 * 2 * kHalfWidth);
}

TEST_F(MetricScaleTest, AnUncertainPlaneMakesTheWidthUncertain) {
  const double before = text_width(map, parameters, map.texts[0]).sigma;
  map.texts[0].covariance = 1e-4 * map.texts[0].theta * map.texts[0].theta.transpose();  // its distance, to 1 %
  const TextWidth after = text_width(map, parameters, map.texts[0]);
  EXPECT_NEAR(after.sigma, std::hypot(before, 0.01 * 2 * kHalfWidth), 2e-4);
}

TEST_F(MetricScaleTest, KnownWidthsGiveMetres) {
  const double width = 2 * kHalfWidth;
  const MetricScale one = metric_scale(map, parameters, {{"open", "", 3 * width, 0.001 * width}});
  EXPECT_EQ(one.texts, 1);
  EXPECT_NEAR(one.metres, 3, 0.03);
  EXPECT_LT(std::abs(one.metres - 3), 4 * 3 * one.sigma);
  const MetricScale three = metric_scale(
      map, parameters, {{"OPEN", "", 3 * width, 1e-3}, {"Exit", "", 3 * width, 1e-3}, {"taxi", "", 3 * width, 1e-3}});
  EXPECT_EQ(three.texts, 3);
  EXPECT_LT(three.sigma, one.sigma);
  // One of the widths is wrong by a tenth.
  const MetricScale odd =
      metric_scale(map, parameters, {{"OPEN", "", 3 * width, 1e-3}, {"EXIT", "", 3.3 * width, 1e-3}});
  EXPECT_GT(odd.sigma, 0.03);
  EXPECT_EQ(metric_scale(map, parameters, {{"CLOSED", "", 1, 0.1}}).texts, 0);
}

// The errors of both centres along the line between them count, and no words that two signs have.
TEST_F(MetricScaleTest, AKnownDistanceGivesMetres) {
  for (TextObject& text : map.texts) text.covariance.setZero();
  const double apart = (text_centre(map, map.texts[0]).at - text_centre(map, map.texts[1]).at).norm();
  const std::string a = textplane::consensus(map.texts[0].votes), b = textplane::consensus(map.texts[1].votes);
  const MetricScale one = metric_scale(map, parameters, {{a, b, 3 * apart, 1e-9}});
  EXPECT_EQ(one.texts, 1);
  EXPECT_NEAR(one.metres, 3, 1e-12);
  EXPECT_GT(one.sigma, 0);
  EXPECT_LT(one.sigma, 0.05);
  const MetricScale rough = metric_scale(map, parameters, {{a, b, 3 * apart, 0.3 * apart}});
  EXPECT_NEAR(rough.sigma, std::hypot(one.sigma, 0.1), 1e-9);
  map.texts[0].covariance = 1e-2 * map.texts[0].theta * map.texts[0].theta.transpose();
  EXPECT_GT(metric_scale(map, parameters, {{a, b, 3 * apart, 1e-9}}).sigma, one.sigma);
  EXPECT_EQ(metric_scale(map, parameters, {{a, a, 1, 0.1}}).texts, 0);
  EXPECT_EQ(metric_scale(map, parameters, {{a, "CLOSED", 1, 0.1}}).texts, 0);
  map.texts[2].votes = map.texts[1].votes;
  EXPECT_EQ(metric_scale(map, parameters, {{a, b, 3 * apart, 1e-9}}).texts, 0);
}

TEST(KnownLengths, AreParsedStrictly) {
  KnownLength known;
  EXPECT_TRUE(parse_known_length("EXIT..ROOM 12=4.2:0.01", &known));
  EXPECT_EQ(known.word, "EXIT");
  EXPECT_EQ(known.other, "ROOM 12");
  EXPECT_EQ(known.length, 4.2);
  EXPECT_TRUE(parse_known_length("NO=EXIT=0.31:0.001", &known));
  EXPECT_EQ(known.word, "NO=EXIT");
  EXPECT_EQ(known.other, "");
  EXPECT_EQ(known.length, 0.31);
  EXPECT_EQ(known.sigma, 0.001);
  EXPECT_TRUE(parse_known_length("EXIT=2", &known));
  EXPECT_NEAR(known.sigma, 0.004, 1e-12);
  for (const char* wrong : {"EXIT", "", "=1", "EXIT=", "EXIT=-1", "EXIT=0", "EXIT=nan", "EXIT=1:", "EXIT=1:0",
                            "EXIT=1m", "..EXIT=1", "EXIT..=1", "EXIT..EXIT=1"})
    EXPECT_FALSE(parse_known_length(wrong, &known)) << wrong;
}

}  // namespace metric_scale_test
}  // namespace textslam
