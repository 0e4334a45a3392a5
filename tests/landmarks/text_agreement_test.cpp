// Texts that contradict the others: less weight, no part, and in the end no place.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "landmarks/text_map_support.hpp"

namespace text_map_test {

class TextAgreementTest : public TextMapTest {
 protected:
  TextAgreementTest() : map(scene.camera) { walk(map, 6); }

  // The first sign slides along its wall, and its points with it.
  void slide(double metres) { scene.signs[0].T_w_h.t.x() += metres; }
  // No text is ever doubted.
  static textplane::TextMapOptions trusting() {
    textplane::TextMapOptions options;
    options.text_huber = options.most_disagreement = 1e6;
    return options;
  }
  int id_of_first() const { return map.objects()[0].id; }
  static const textplane::TextReport& report_of(const TextFit& fit, int id) {
    return *std::find_if(fit.reports.begin(), fit.reports.end(), [id](const auto& one) { return one.id == id; });
  }
  bool has(int id) const {
    return std::any_of(map.objects().begin(), map.objects().end(), [id](const auto& text) { return text.id == id; });
  }

  // Three frames and a key frame without detections; the points are as true as they can be.
  void live() {
    const SE3d T = pose(5.4 + 0.1 * next_);
    Pyramid frame = image(T);
    for (int k = 0; k < 3; ++k) map.track(frame, T, points(T, 0.5));
    ASSERT_EQ(map.add_keyframe(next_++, std::move(frame), T, {}, points(T, 0.1)), Status::ok);
  }

  TextMap map;

 private:
  int next_ = 7;
};

TEST_F(TextAgreementTest, ATextThatMovedTakesNoPart) {
  TextMap other(scene.camera, trusting());
  walk(other, 6);
  slide(0.01);
  const SE3d T = pose(5.5);
  const Pyramid frame = image(T);
  const auto seen = points(T, 0.5);
  const TextFit fit = map.track(frame, T, seen);
  ASSERT_EQ(fit.reports.size(), 3U);
  for (const auto& report : fit.reports)
    EXPECT_EQ(report.use, report.id == id_of_first() ? textplane::TextUse::disagrees : textplane::TextUse::used);
  EXPECT_EQ(fit.texts, 2);
  EXPECT_EQ(report_of(fit, id_of_first()).share, 0);
  ASSERT_TRUE(fit.refined);
  const TextFit all = other.track(frame, T, seen);
  EXPECT_LT(shift(fit.T_c_w, T), 0.3 * shift(all.T_c_w, T));
}

TEST_F(TextAgreementTest, TheOnlyTextLeavesThePoseWhereItDisagrees) {
  TextMap one(scene.camera);
  for (int id = 0; id <= 6; ++id)
    ASSERT_EQ(one.add_keyframe(id, image(pose(id)), pose(id), {quads(pose(id))[0]}, points(pose(id), 0.1)), Status::ok);
  ASSERT_EQ(mapped(one), 1);
  const SE3d T = pose(5.5);
  EXPECT_EQ(one.track(image(T), T, points(T, 0.2)).reports[0].use, textplane::TextUse::used);
  slide(0.02);
  const TextFit fit = one.track(image(T), T, points(T, 0.2));
  EXPECT_EQ(fit.reports[0].use, textplane::TextUse::disagrees);
  EXPECT_EQ(fit.status, Status::diverged);
  EXPECT_TRUE(same_bits(fit.T_c_w, T));
}

TEST_F(TextAgreementTest, ATextThatDisagreesALittleCountsLess) {
  const SE3d T = pose(5.5);
  const auto share = [&] { return report_of(map.track(image(T), T, points(T, 0.5)), id_of_first()).share; };
  const double before = share();
  slide(0.005);
  const double after = share();
  EXPECT_GT(after, 0);
  EXPECT_LT(after, 0.8 * before);
}

TEST_F(TextAgreementTest, TextsThatAgreeKeepTheirWeight) {
  TextMap other(scene.camera, trusting());
  walk(other, 6);
  int same = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const SE3d T = pose(4 + 0.1 * seed);
    const Pyramid frame = image(T);
    const auto seen = points(T, 0.5, seed);
    const SE3d weighed = map.track(frame, T, seen).T_c_w;
    same += same_bits(weighed, other.track(frame, T, seen).T_c_w);
  }
  EXPECT_GE(same, 16);
}

TEST_F(TextAgreementTest, ATextThatKeepsDisagreeingLosesItsPlace) {
  const int id = id_of_first(), most = map.options().text.max_failures;
  slide(0.01);
  for (int k = 1; k < most; ++k) live();
  EXPECT_TRUE(has(id));
  live();
  EXPECT_FALSE(has(id));
  EXPECT_EQ(mapped(map), 2);
}

TEST_F(TextAgreementTest, ATextThatAgreesAgainKeepsItsPlace) {
  const int id = id_of_first(), most = map.options().text.max_failures;
  slide(0.01);
  for (int k = 1; k < most; ++k) live();
  slide(-0.01);
  live();
  slide(0.01);
  live();
  EXPECT_TRUE(has(id));
}

}  // namespace text_map_test
