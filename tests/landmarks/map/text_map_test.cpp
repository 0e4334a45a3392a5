// TextMap as a host uses it: what it maps, and what it makes of a pose.
#include "textplane/landmarks/text_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "landmarks/text_map_support.hpp"

namespace text_map_test {

TEST_F(TextMapTest, MapsTextsFromKeyFramesWithPoints) {
  TextMap map(scene.camera);
  walk(map, 6);
  EXPECT_EQ(mapped(map), 3);
  EXPECT_LT(largest_angle(map), 1.0);
  for (const TextObject& text : map.objects()) EXPECT_EQ(textplane::consensus(text.votes), "sign");
}

TEST_F(TextMapTest, MapsTextsWithoutAnyPoint) {
  TextMap map(scene.camera);
  walk(map, 7, [](const SE3d&) { return std::vector<TextPoint>(); });
  EXPECT_EQ(mapped(map), 3);
  EXPECT_LT(largest_angle(map), 1.5);
}

TEST_F(TextMapTest, MapsTextsFromTracksOfUnknownDepth) {
  TextMap map(scene.camera);
  walk(map, 6, [&](const SE3d& T) {
    auto tracks = points(T, 0.1);
    for (TextPoint& point : tracks) point = TextPoint::track(point.px, point.id);
    return tracks;
  });
  EXPECT_EQ(mapped(map), 3);
  EXPECT_LT(largest_angle(map), 1.0);
}

TEST_F(TextMapTest, MapsTextsFromPixelsWithDepth) {
  TextMap map(scene.camera);
  walk(map, 6, [&](const SE3d& T) {
    auto depths = points(T, 0.0);
    for (TextPoint& point : depths) point = TextPoint::with_depth(point.px, (T * point.p_w).z());
    return depths;
  });
  EXPECT_EQ(mapped(map), 3);
  EXPECT_LT(largest_angle(map), 1.0);
}

TEST_F(TextMapTest, TracksBetterThanNoisyPoints) {
  TextMap map(scene.camera);
  walk(map, 6);
  double by_points = 0, by_both = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const SE3d truth = pose(4.5 + 0.1 * seed);
    const auto seen = points(truth, 1.0, seed);
    const SE3d start = textplane::se3_exp<double>(Random(seed).twist(0.01, 0.004)) * truth;
    const TextFit fit = map.track(image(truth), start, seen);
    ASSERT_TRUE(fit.refined) << textplane::to_string(fit.status);
    EXPECT_EQ(fit.texts, 3);
    double shares = 0;
    for (const auto& report : fit.reports) {
      EXPECT_GT(report.share, 0);
      shares += report.share;
    }
    EXPECT_LT(shares, 1) << "the points know the rest";
    by_both += shift(fit.T_c_w, truth) / 8;
    textplane::TextPose pose_of_points;
    std::vector<textplane::PosePointTerm> terms;
    for (const TextPoint& point : seen) terms.push_back({point.p_w, point.px, 1});
    std::vector<textplane::FrameText> no_texts;
    textplane::TextImage frame;
    frame.camera = scene.camera;
    SE3d T = start;
    ASSERT_TRUE(pose_of_points.solve(terms, 1, no_texts, frame, &T));
    by_points += shift(T, truth) / 8;
  }
  EXPECT_LT(by_both, 0.5 * by_points);
}

TEST_F(TextMapTest, TracksWithoutPoints) {
  TextMap map(scene.camera);
  walk(map, 6);
  const SE3d truth = pose(5.5), start = textplane::se3_exp<double>(Random(2).twist(0.01, 0.004)) * truth;
  const TextFit fit = map.track(image(truth), start, {});
  ASSERT_TRUE(fit.refined);
  EXPECT_LT(shift(fit.T_c_w, truth), 0.1 * shift(start, truth));
}

TEST_F(TextMapTest, FindsTheTextsWhereFewPointsLeadAstray) {
  TextMap map(scene.camera);
  walk(map, 6);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const SE3d T = pose(5.5);
    std::vector<TextPoint> few;
    for (const TextPoint& point : points(T, 4, seed))
      if (point.id % 3 == 0 && few.size() < 8) few.push_back(point);
    const TextFit fit = map.track(image(T), T, few);
    EXPECT_GE(fit.texts, 2) << seed;
    EXPECT_LT(shift(fit.T_c_w, T), 0.002) << seed;
  }
}

TEST_F(TextMapTest, LeavesThePoseWhereMostTextsDoNotFit) {
  TextMap map(scene.camera);
  walk(map, 6);
  const SE3d T = pose(5.5);
  scene.signs[1].T_w_h.t.x() += 0.3;
  const auto seen = points(T, 2);
  EXPECT_TRUE(map.track(image(T), T, seen).refined);
  scene.signs[2].T_w_h.t.x() += 0.3;
  const TextFit fit = map.track(image(T), T, seen);
  EXPECT_EQ(fit.texts, 1);
  EXPECT_FALSE(fit.refined);
  EXPECT_TRUE(same_bits(fit.T_c_w, T));
  EXPECT_TRUE(map.track(image(T), T, {}).refined);
}

TEST_F(TextMapTest, TakesTheLeastGainThatIsAskedFor) {
  const SE3d T = pose(5.5);
  const auto fit = [&](double least_gain) {
    textplane::TextMapOptions options;
    options.least_gain = least_gain;
    TextMap map(scene.camera, options);
    walk(map, 6);
    return map.track(image(T), T, points(T, 0.5));
  };
  const double gain = fit(0).gain;
  ASSERT_GT(gain, 0);
  EXPECT_TRUE(fit(gain).refined);
  const TextFit less = fit(std::nextafter(gain, 1.0));
  EXPECT_FALSE(less.refined);
  EXPECT_TRUE(same_bits(less.T_c_w, T));
}

TEST(TextPointTest, IsAsSureAsAPixelUnlessItSaysMore) {
  EXPECT_EQ(TextPoint::at(Vec2(3, 4), Vec3(0, 0, 1)).sigma, 1);
  EXPECT_EQ(TextPoint::with_depth(Vec2(3, 4), 2).sigma, 1);
  EXPECT_EQ(TextPoint::track(Vec2(3, 4), 7).sigma, 1);
}

TEST_F(TextMapTest, LeavesThePoseToTheBitWhereItHasNothingToSay) {
  TextMap map(scene.camera);
  const SE3d T = pose(0.3);
  EXPECT_TRUE(same_bits(map.track(image(T), T, points(T, 1)).T_c_w, T)) << "no text";
  walk(map, 6);
  SE3d away = T;
  away.R = textplane::so3_exp<double>(Vec3(0, 3, 0)) * away.R;
  const TextFit behind = map.track(image(T), away, {});
  EXPECT_TRUE(same_bits(behind.T_c_w, away));
  EXPECT_EQ(behind.status, Status::too_few);
  const Image<std::uint8_t> grey(320, 240, 128);
  const TextFit hidden = map.track(Pyramid(grey.view(), 3), T, points(T, 1));
  EXPECT_TRUE(same_bits(hidden.T_c_w, T));
  EXPECT_FALSE(hidden.refined);
  for (const auto& report : hidden.reports) EXPECT_EQ(report.use, textplane::TextUse::dissimilar);
}

TEST_F(TextMapTest, LeavesThePoseWherePointsContradictTheTexts) {
  TextMap map(scene.camera);
  walk(map, 6);
  // The signs moved together: the points say one pose, the texts another.
  const SE3d T = pose(5.5);
  Vec6 xi;
  xi << 0.05, 0, 0, 0, 0, 0;
  const SE3d moved = textplane::se3_exp<double>(xi) * T;
  const TextFit fit = map.track(image(moved), T, points(T, 0.2));
  EXPECT_TRUE(same_bits(fit.T_c_w, T));
  EXPECT_FALSE(fit.refined);
}

}  // namespace text_map_test
