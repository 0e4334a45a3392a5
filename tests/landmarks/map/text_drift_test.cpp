// Points that drift together: their residuals do not show it, the texts do.
#include <gtest/gtest.h>

#include <cstddef>

#include "landmarks/text_map_support.hpp"

namespace text_map_test {

class TextDriftTest : public TextMapTest {
 protected:
  TextDriftTest() : map(scene.camera), frame(image(T)) { walk(map, 6); }

  // Of a map whose points have all moved by `metres` sideways since the texts were mapped, as the host's pose has.
  TextFit tracked(double metres, unsigned seed) {
    const Vec3 moved(metres, 0, 0);
    auto seen = points(T, 0.3, seed);
    for (TextPoint& point : seen) point.p_w += moved;
    SE3d host = T;
    host.t -= T.R * moved;
    return map.track(frame, host, seen);
  }
  // The distance of the pose from the truth after `frames` frames, metres.
  double error_after(int frames, double metres, TextFit* fit) {
    for (int k = 0; k < frames; ++k) *fit = tracked(metres, static_cast<unsigned>(k + 1));
    return shift(fit->T_c_w, T);
  }

  const SE3d T = pose(5.5);
  TextMap map;
  Pyramid frame;
};

constexpr double kDrift = 0.005;

TEST_F(TextDriftTest, TextsThatAgreeTellHowFarPointsDrifted) {
  TextFit fit;
  const double first = error_after(1, kDrift, &fit);
  EXPECT_EQ(fit.drift, 1);
  const double later = error_after(60, kDrift, &fit);
  EXPECT_GT(fit.drift, 2);
  EXPECT_LT(later, 0.5 * first);
  EXPECT_TRUE(fit.refined);
  EXPECT_EQ(fit.texts, 3);
}

TEST_F(TextDriftTest, PointsThatAgreeKeepTheirWeight) {
  TextFit fit;
  error_after(60, 0, &fit);
  EXPECT_GE(fit.drift, 1);
  EXPECT_LT(fit.drift, 1.3);
}

TEST_F(TextDriftTest, IsForgottenWhenPointsAgreeAgain) {
  TextFit fit;
  error_after(60, kDrift, &fit);
  const double drifted = fit.drift;
  error_after(100, 0, &fit);
  EXPECT_LT(fit.drift, 1 + 0.3 * (drifted - 1));
}

TEST_F(TextDriftTest, OneTextDoesNotMakeThePointsDoubtful) {
  scene.signs[1].T_w_h.t.x() += kDrift;
  const Pyramid moved = image(T);
  scene.signs[1].T_w_h.t.x() -= kDrift;  // points and the other texts have not moved
  TextFit fit;
  for (unsigned k = 1; k <= 60; ++k) fit = map.track(moved, T, points(T, 0.3, k));
  EXPECT_LT(fit.drift, 1.3);
}

TEST_F(TextDriftTest, OneTextInViewIsNotTrustedAboveThePoints) {
  TextFit fit;
  error_after(60, kDrift, &fit);
  std::size_t least = 3;
  for (double turn = 0; turn < 0.8; turn += 0.04) {
    SE3d aside = T;
    aside.R = textplane::so3_exp<double>(Vec3(0, turn, 0)) * aside.R;
    fit = map.track(frame, aside, {});
    if (fit.reports.empty()) break;
    least = fit.reports.size();
    EXPECT_EQ(fit.drift > 1, least > 1);
  }
  EXPECT_EQ(least, 1U);
}

}  // namespace text_map_test
