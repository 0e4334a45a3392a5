// The adjustment beside tracking: the same result as in step, and a map that grew meanwhile stays in one piece.
#include "textslam/adjust/adjuster.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "textslam/map/observations.hpp"
#include "textslam/track/tracker.hpp"

namespace textslam {
namespace adjuster_test {

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

// Key frames along a line that look at a cloud of points; poses and points are a little off the truth.
class AdjusterTest : public testing::Test {
 protected:
  static constexpr int kPoints = 120;

  AdjusterTest() : image_(std::make_shared<Pyramid>(textplane::Image<std::uint8_t>(64, 48).view(), 1)) {
    map_.camera = {525, 525, 319.5, 239.5};
    map_.width = 640;
    map_.height = 480;
    parameters_.mode = Mode::points;
    for (int i = 0; i < kPoints; ++i)
      truth_.push_back({uniform(random_, -1.2, 1.2), uniform(random_, -0.8, 0.8), uniform(random_, 3, 5)});
    for (const Vec3& p : truth_) {
      map_.points.emplace_back();
      map_.points.back().p_w = p + off(0.02);
    }
    for (int i = 0; i < 8; ++i) add_keyframe(map_);
  }

  Vec3 off(double size) {
    return {uniform(random_, -size, size), uniform(random_, -size, size), uniform(random_, -size, size)};
  }

  // The next key frame on the line, with the points it sees.
  void add_keyframe(Map& map) {
    const int id = static_cast<int>(map.keyframes.size());
    const SE3d T_w_c{textplane::so3_exp<double>(Vec3(0, -0.01 * id, 0)), Vec3(0.08 * id, 0, 0)};
    Frame frame;
    frame.index = 3 * id;
    frame.image = image_;
    const double error = id < 2 ? 0 : 0.01;
    map.keyframes.push_back({frame, {T_w_c.R, T_w_c.t + off(error)}, {}});
    for (int i = 0; i < kPoints; ++i)
      add_observation(map, i, id, map.camera.project(T_w_c.inverse() * truth_[static_cast<std::size_t>(i)]));
  }

  static double error_px(const Map& map, int keyframe) {
    double sum = 0;
    int count = 0;
    for (const MapPoint& point : map.points)
      for (const PointObservation& o : point.observations)
        if (o.keyframe == keyframe) {
          sum += (map.camera.project(map.keyframe(keyframe).T_w_c.inverse() * point.p_w) - o.px).squaredNorm();
          ++count;
        }
    return std::sqrt(sum / std::max(count, 1));
  }

  static void expect_same(const Map& a, const Map& b, std::size_t keyframes) {
    for (std::size_t i = 0; i < keyframes; ++i) {
      EXPECT_EQ(a.keyframes[i].T_w_c.t, b.keyframes[i].T_w_c.t) << i;
      EXPECT_EQ(a.keyframes[i].T_w_c.R, b.keyframes[i].T_w_c.R) << i;
    }
    for (std::size_t i = 0; i < kPoints; ++i) EXPECT_EQ(a.points[i].p_w, b.points[i].p_w) << i;
  }

  std::mt19937 random_{1};
  std::shared_ptr<const Pyramid> image_;
  Parameters parameters_;
  Map map_;
  std::vector<Vec3> truth_;
};

TEST_F(AdjusterTest, InStepItIsDoneAtOnce) {
  ASSERT_GT(error_px(map_, 7), 0.5);
  Adjuster adjuster(parameters_);
  adjuster.keyframe_added(map_);
  EXPECT_LT(error_px(map_, 7), 0.05);
  EXPECT_FALSE(adjuster.collect(map_).changed);
}

TEST_F(AdjusterTest, BesideTheFramesItChangesNothingUntilItIsCollected) {
  const Map before = map_;
  Map in_step = map_;
  Adjuster(parameters_).keyframe_added(in_step);
  parameters_.real_time = true;
  Adjuster adjuster(parameters_);
  adjuster.keyframe_added(map_);
  expect_same(map_, before, map_.keyframes.size());
  const Adjuster::Collected done = adjuster.settle(map_);
  EXPECT_TRUE(done.changed);
  EXPECT_EQ(done.frame, 21);
  expect_same(map_, in_step, map_.keyframes.size());
}

TEST_F(AdjusterTest, WhatCameMeanwhileMovesAlong) {
  Map in_step = map_;
  adjust_local(in_step, parameters_);
  const auto adjustment = StagedAdjustment::around_newest(map_, parameters_);
  ASSERT_NE(adjustment, nullptr);
  adjustment->solve();

  add_keyframe(map_);
  map_.points.emplace_back();
  map_.points.back().p_w = {0.1, 0.2, 4};
  const SE3d T_7_8 = map_.keyframe(7).T_w_c.inverse() * map_.keyframe(8).T_w_c,
             T_7_w = map_.keyframe(7).T_w_c.inverse();
  const Vec3 in_7 = T_7_w * map_.points.back().p_w;
  const SE3d moved = adjustment->apply(map_);

  expect_same(map_, in_step, 8);
  EXPECT_GT(moved.t.norm(), 1e-4) << "the test moves nothing";
  const SE3d now = map_.keyframe(7).T_w_c.inverse() * map_.keyframe(8).T_w_c;
  EXPECT_LT((now.t - T_7_8.t).norm(), 1e-12);
  EXPECT_LT((now.R - T_7_8.R).norm(), 1e-12);
  EXPECT_LT((map_.keyframe(7).T_w_c.inverse() * map_.points.back().p_w - in_7).norm(), 1e-12);
  EXPECT_LT((moved * T_7_w.inverse().t - map_.keyframe(7).T_w_c.t).norm(), 1e-12);
}

TEST_F(AdjusterTest, AKeyFrameThatComesMeanwhileIsNotForgotten) {
  parameters_.real_time = true;
  Adjuster adjuster(parameters_);
  adjuster.keyframe_added(map_);
  add_keyframe(map_);
  adjuster.keyframe_added(map_);
  const Adjuster::Collected done = adjuster.settle(map_);
  EXPECT_EQ(done.frame, 24) << "the second adjustment ran, too";
  EXPECT_LT(error_px(map_, 8), 0.05);
  EXPECT_FALSE(adjuster.settle(map_).changed);
}

// Around the newest key frame the oldest ones are out of reach.
TEST_F(AdjusterTest, AMapThatHasGrownIsAdjustedAsAWhole) {
  parameters_.window_frames = parameters_.window_fixed = 2;
  const auto error_after = [&](double growth, int most_frames) {
    parameters_.whole_growth = growth;
    parameters_.whole_most_frames = most_frames;
    Map map = map_;
    Adjuster adjuster(parameters_);
    adjuster.keyframe_added(map);
    map.keyframe(2).T_w_c.t.x() += 0.05;
    add_keyframe(map);
    adjuster.keyframe_added(map);
    return error_px(map, 2);
  };
  EXPECT_LT(error_after(9.0 / 8, 9), 0.05);
  EXPECT_GT(error_after(9.1 / 8, 9), 1) << "it has not grown enough";
  EXPECT_GT(error_after(9.0 / 8, 8), 1) << "it is too large";
}

// Another map may have fewer key frames than the one before: it has not been adjusted yet.
TEST_F(AdjusterTest, GrowthIsThatOfTheMap) {
  parameters_.window_frames = parameters_.window_fixed = 2;
  parameters_.whole_growth = 2;
  Adjuster adjuster(parameters_);
  Map other = map_;
  adjuster.keyframe_added(other);
  map_.number = 1;
  map_.keyframe(2).T_w_c.t.x() += 0.05;
  adjuster.keyframe_added(map_);
  EXPECT_LT(error_px(map_, 2), 0.05);
}

// A loop moves key frames that are out of reach of the newest.
TEST_F(AdjusterTest, AfterALoopAllOfTheMapIsAdjusted) {
  parameters_.window_frames = parameters_.window_fixed = 2;
  map_.keyframe(2).T_w_c.t.x() += 0.05;
  Map in_step = map_;
  Adjuster at_once(parameters_);
  EXPECT_TRUE(at_once.map_corrected(in_step));
  EXPECT_FALSE(at_once.is_correcting());
  EXPECT_LT(error_px(in_step, 2), 0.05);

  parameters_.real_time = true;
  Adjuster adjuster(parameters_);
  const Map before = map_;
  EXPECT_FALSE(adjuster.map_corrected(map_));
  EXPECT_TRUE(adjuster.is_correcting());
  expect_same(map_, before, map_.keyframes.size());
  add_keyframe(map_);
  adjuster.keyframe_added(map_);
  const Adjuster::Collected done = adjuster.settle(map_);
  EXPECT_TRUE(done.corrected);
  EXPECT_FALSE(adjuster.is_correcting());
  EXPECT_LT(error_px(map_, 2), 0.05);
  EXPECT_LT(error_px(map_, 8), 0.05) << "the key frame that came meanwhile was adjusted, too";
  add_keyframe(map_);
  adjuster.keyframe_added(map_);
  EXPECT_FALSE(adjuster.settle(map_).corrected) << "an adjustment like any other";
}

TEST_F(AdjusterTest, MayBeLeftWhileItRuns) {
  parameters_.real_time = true;
  Adjuster adjuster(parameters_);
  adjuster.keyframe_added(map_);
}

}  // namespace adjuster_test
}  // namespace textslam
