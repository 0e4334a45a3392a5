// Widths of texts by the boxes around them, and the metres that follow.
#include "textslam/text/metric_scale.hpp"

#include <gtest/gtest.h>

#include <random>

#include "map_file/map_file_support.hpp"
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
  const MetricScale one = metric_scale(map, parameters, {{"open", 3 * width, 0.001 * width}});
  EXPECT_EQ(one.texts, 1);
  EXPECT_NEAR(one.metres, 3, 0.03);
  EXPECT_LT(std::abs(one.metres - 3), 4 * 3 * one.sigma);
  const MetricScale three =
      metric_scale(map, parameters, {{"OPEN", 3 * width, 1e-3}, {"Exit", 3 * width, 1e-3}, {"taxi", 3 * width, 1e-3}});
  EXPECT_EQ(three.texts, 3);
  EXPECT_LT(three.sigma, one.sigma);
  // One of the widths is wrong by a tenth.
  const MetricScale odd = metric_scale(map, parameters, {{"OPEN", 3 * width, 1e-3}, {"EXIT", 3.3 * width, 1e-3}});
  EXPECT_GT(odd.sigma, 0.03);
  EXPECT_EQ(metric_scale(map, parameters, {{"CLOSED", 1, 0.1}}).texts, 0);
}

TEST(KnownWidths, AreParsedStrictly) {
  KnownWidth known;
  EXPECT_TRUE(parse_known_width("NO=EXIT=0.31:0.001", &known));
  EXPECT_EQ(known.word, "NO=EXIT");
  EXPECT_EQ(known.width, 0.31);
  EXPECT_EQ(known.sigma, 0.001);
  EXPECT_TRUE(parse_known_width("EXIT=2", &known));
  EXPECT_NEAR(known.sigma, 0.004, 1e-12);
  for (const char* wrong : {"EXIT", "=1", "EXIT=", "EXIT=-1", "EXIT=0", "EXIT=nan", "EXIT=1:", "EXIT=1:0", "EXIT=1m"})
    EXPECT_FALSE(parse_known_width(wrong, &known)) << wrong;
}

}  // namespace metric_scale_test
}  // namespace textslam
