// Loops closed on a map of known drift: its points, planes and ids follow.
#include "textslam/loop/loop_closure.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>

#include "textplane/geometry/plane.hpp"
#include "textslam/lens_support.hpp"
#include "textslam/loop/circle_support.hpp"
#include "textslam/loop/loop_alignment.hpp"
#include "textslam/map/observations.hpp"

namespace textslam {
namespace loop_closure_test {

// A map of a walk round a circle and some steps on: points in front of each key frame, seen by it and the next two, or
// more. The last key frames look at what the first ones saw, and the map does not know. From each key frame to the
// next, lengths grow by a factor that they should not.
class LoopClosureTest : public testing::Test {
 protected:
  static constexpr int kRound = 30, kKeyFrames = 33, kEach = 20;
  static constexpr double kGrowth = 1.004;

  explicit LoopClosureTest(const textplane::LensMap* lens = nullptr, int seen_by = 3) : seen_by_(seen_by) {
    map.camera = {{262, 262, 159.5, 119.5}, lens};
    map.width = 320;
    map.height = 240;
    const std::vector<Similarity> round = circle(kRound);
    for (int k = 0; k < kKeyFrames; ++k) true_nodes.push_back(round[static_cast<std::size_t>(k % kRound)]);
    // As mapped: true steps, each a little larger than the one before it.
    std::vector<Similarity> mapped = {true_nodes[0]};
    for (std::size_t k = 0; k + 1 < true_nodes.size(); ++k) {
      Similarity step = compose(inverse(true_nodes[k]), true_nodes[k + 1]);
      step.scale = kGrowth;
      mapped.push_back(compose(mapped.back(), step));
    }
    make_map(mapped);
    make_loop(mapped);
  }
  void make_map(const std::vector<Similarity>& mapped) {
    for (int k = 0; k < kKeyFrames; ++k) {
      const Similarity& S = mapped[static_cast<std::size_t>(k)];
      Frame frame;
      frame.index = 3 * k;
      map.keyframes.push_back({frame, SE3d{S.R, S.t}, {}});
    }
    for (int k = 0; k < kKeyFrames; ++k) {
      const Similarity& S = mapped[static_cast<std::size_t>(k)];
      for (int i = 0; i < kEach; ++i) {
        const Vec3 in_k(0.08 * (i % 5 - 2), 0.1 * (i / 5 - 1.5), 2 + 0.1 * (i % 3));
        map.points.emplace_back();
        map.points.back().p_w = S * in_k;
        true_points.push_back(true_nodes[static_cast<std::size_t>(k)] * in_k);
        for (int seen = k; seen < std::min(k + seen_by_, kKeyFrames); ++seen)
          add_observation(map, k * kEach + i, seen,
                          map.camera.project(inverse(true_nodes[static_cast<std::size_t>(seen)]) * true_points.back()));
      }
    }
    TextObject text;
    text.id = 0;
    text.state = TextState::mapped;
    text.host = 15;
    text.theta = Vec3(0.05, 0, 0.5);
    text.covariance = 1e-4 * Eigen::Matrix3d::Identity();
    text.patch.camera = map.camera.pinhole;
    text.patch.quad.corner = {Vec2(100, 100), Vec2(200, 100), Vec2(200, 140), Vec2(100, 140)};
    map.texts.push_back(text);
  }
  // What key frame 30 to 32 see is what key frame 0 to 2 saw.
  void make_loop(const std::vector<Similarity>& mapped) {
    loop.ok = true;
    loop.keyframe = kKeyFrames - 1;
    loop.met = loop.keyframe - kRound;
    const auto newest = static_cast<std::size_t>(loop.keyframe), met = static_cast<std::size_t>(loop.met);
    loop.link.S_a_b = compose(mapped[met], inverse(mapped[newest]));
    for (int i = 0; i < kEach; ++i) {
      const int old_point = loop.met * kEach + i;
      if (i % 2 == 0) loop.link.points.emplace_back(old_point, loop.keyframe * kEach + i);
    }
    for (int k = kRound; k < kKeyFrames; ++k) {
      loop.link.sightings.push_back({k, {}});
      for (int id = 0; id < (k - kRound + 1) * kEach; ++id) {
        Track track;
        track.point = id;
        track.px = map.camera.project(inverse(node(k)) * true_points[static_cast<std::size_t>(id)]).cast<float>();
        loop.link.sightings.back().tracks.push_back(track);
      }
    }
    loop.seen.tracks = loop.link.sightings.back().tracks;
  }
  const Similarity& node(int k) const { return true_nodes[static_cast<std::size_t>(k)]; }
  double error(int k) const { return (map.keyframe(k).T_w_c.t - true_nodes[static_cast<std::size_t>(k)].t).norm(); }

  int seen_by_;
  Map map;
  Parameters parameters;
  Loop loop;
  std::vector<Similarity> true_nodes;
  std::vector<Vec3> true_points;
};

TEST_F(LoopClosureTest, DriftIsSpreadAndEverythingFollows) {
  parameters.loop_drift = 0.05;  // this map has lost more than most
  const double before = error(loop.keyframe);
  ASSERT_GT(before, 0.2);
  const double share = (map.keyframe(loop.keyframe).T_w_c.t - map.keyframe(loop.met).T_w_c.t).norm() /
                       path_length_between(map, loop.met, loop.keyframe);
  const std::vector<SE3d> poses = [&] {
    std::vector<SE3d> all;
    for (const KeyFrame& keyframe : map.keyframes) all.push_back(keyframe.T_w_c);
    return all;
  }();
  const std::vector<MapPoint> points = map.points;
  const TextObject text = map.texts[0];

  const LoopCorrection correction = close_loop(map, parameters, loop);
  ASSERT_TRUE(correction.corrected);
  const double growth = std::pow(kGrowth, kRound);
  EXPECT_NEAR(correction.found.scale, 1 / growth, 0.005);
  EXPECT_NEAR(correction.found.translation, share, 0.1 * share);
  // The growth was even: between the old and the recent part the scales come back evenly, and the way is round again.
  EXPECT_NEAR(correction.scales[0], 1, 1e-12);
  for (int k = loop.met + 2; k < kRound; ++k)
    EXPECT_LT(correction.scales[static_cast<std::size_t>(k)], correction.scales[static_cast<std::size_t>(k) - 1]);
  EXPECT_NEAR(correction.scales.back() / correction.scales[2], 1 / growth, 0.005);
  for (int k = 0; k < kKeyFrames; ++k) EXPECT_LT(error(k), 0.35 * before) << k;
  EXPECT_LT((map.keyframe(loop.keyframe).T_w_c.t - map.keyframe(loop.met).T_w_c.t).norm(), 0.02 * before);

  // Points keep their place in the view of the key frame that saw them first, at a distance that goes with its scale.
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (map.points[i].bad) continue;
    const auto host = static_cast<std::size_t>(points[i].observations.front().keyframe);
    const Vec3 was = poses[host].inverse() * points[i].p_w,
               is = map.keyframes[host].T_w_c.inverse() * map.points[i].p_w;
    EXPECT_LT((is - correction.scales[host] * was).norm(), 1e-9);
  }
  const double s = correction.scales[15];
  EXPECT_LT((map.texts[0].theta - text.theta / s).norm(), 1e-12);
  EXPECT_LT((map.texts[0].covariance - text.covariance / (s * s)).norm(), 1e-12);
}

// The drift is that of the path: it comes back whole, however many key frames share the points on the way.
class DenseLoopClosureTest : public LoopClosureTest {
 protected:
  DenseLoopClosureTest() : LoopClosureTest(nullptr, 6) {}
};
TEST_F(DenseLoopClosureTest, DriftIsCorrected) {
  parameters.loop_drift = 0.01;
  const double before = error(loop.keyframe);
  ASSERT_TRUE(close_loop(map, parameters, loop).corrected);
  EXPECT_LT((map.keyframe(loop.keyframe).T_w_c.t - map.keyframe(loop.met).T_w_c.t).norm(), 0.02 * before);
}

// The same behind a lens, which the derivatives of the pixels have, too.
class WideLoopClosureTest : public LoopClosureTest {
 protected:
  WideLoopClosureTest() : LoopClosureTest(&lens_support::wide_lens()) {}
};
TEST_F(WideLoopClosureTest, AlignmentRestsOnOldPoints) {
  const Similarity newest = similarity_of(map.keyframe(loop.keyframe).T_w_c), exact = compose(loop.link.S_a_b, newest);
  loop.link.S_a_b = moved(loop.link.S_a_b, 0.02 * Vector7::Ones());
  const LoopAlignment aligned = align_loop(map, parameters, loop.link, loop.keyframe);
  ASSERT_TRUE(aligned.ok);
  EXPECT_LT(distance(aligned.S_w_k, exact), 0.02);
  map.camera.lens = nullptr;
  EXPECT_GT(distance(align_loop(map, parameters, loop.link, loop.keyframe).S_w_k, exact), 0.025);
}
TEST_F(WideLoopClosureTest, DriftIsCorrected) {
  parameters.loop_drift = 0.05;
  const double before = error(loop.keyframe);
  ASSERT_TRUE(close_loop(map, parameters, loop).corrected);
  EXPECT_LT((map.keyframe(loop.keyframe).T_w_c.t - map.keyframe(loop.met).T_w_c.t).norm(), 0.02 * before);
}

// The link, which rests on young points, is off; the pixels of the old points put it right.
TEST_F(LoopClosureTest, AlignmentRestsOnOldPoints) {
  const Similarity newest = similarity_of(map.keyframe(loop.keyframe).T_w_c), exact = compose(loop.link.S_a_b, newest);
  loop.link.S_a_b = moved(loop.link.S_a_b, 0.02 * Vector7::Ones());
  const LoopAlignment aligned = align_loop(map, parameters, loop.link, loop.keyframe);
  ASSERT_TRUE(aligned.ok);
  EXPECT_LT(distance(aligned.S_w_k, exact), 0.02);
  EXPECT_GT(distance(compose(loop.link.S_a_b, newest), exact), 0.08);
  const double least = Eigen::SelfAdjointEigenSolver<Matrix7>(aligned.information).eigenvalues()[0];
  EXPECT_GT(least, 0);

  // Seen by one key frame alone the scale is open: it stays as the link had it, and the information says so.
  loop.link.sightings.erase(loop.link.sightings.begin(), loop.link.sightings.end() - 1);
  const LoopAlignment open = align_loop(map, parameters, loop.link, loop.keyframe);
  ASSERT_TRUE(open.ok);
  EXPECT_NEAR(open.S_w_k.scale, loop.link.S_a_b.scale, 1e-3);
  EXPECT_LT(Eigen::SelfAdjointEigenSolver<Matrix7>(open.information).eigenvalues()[0], 1e-6 * least);
  loop.link.sightings[0].tracks.resize(static_cast<std::size_t>(parameters.join_min_pairs) - 1);
  EXPECT_FALSE(align_loop(map, parameters, loop.link, loop.keyframe).ok);
}

TEST_F(LoopClosureTest, WhatIsInBothBecomesOne) {
  const std::size_t observed = map.point(loop.met * kEach).observations.size();
  const LoopCorrection correction = close_loop(map, parameters, loop);
  std::set<int> merged;
  for (const auto& [kept, other] : loop.link.points) {
    EXPECT_TRUE(map.point(other).bad);
    EXPECT_EQ(correction.points[static_cast<std::size_t>(other)], kept);
    EXPECT_EQ(map.point(kept).observations.size(), observed + 1) << "the new one was seen by the newest alone";
    merged.insert(other);
  }
  for (int i = 0; i < static_cast<int>(map.points.size()); ++i) {
    if (merged.count(i) == 0) {
      EXPECT_EQ(correction.points[static_cast<std::size_t>(i)], i);
    }
  }
  // All that the newest key frame showed of the old part is observed by it now, once; links hold both ways.
  for (const Track& track : loop.seen.tracks) {
    const auto& seen = map.keyframe(loop.keyframe).points;
    EXPECT_EQ(std::count(seen.begin(), seen.end(), track.point), 1);
  }
  std::size_t of_points = 0, of_keyframes = 0;
  for (const MapPoint& point : map.points) of_points += point.observations.size();
  for (const KeyFrame& keyframe : map.keyframes) {
    of_keyframes += keyframe.points.size();
    EXPECT_EQ(std::set<int>(keyframe.points.begin(), keyframe.points.end()).size(), keyframe.points.size());
    for (const int id : keyframe.points) EXPECT_FALSE(map.point(id).bad);
  }
  EXPECT_EQ(of_points, of_keyframes);
  EXPECT_TRUE(local_map(map, parameters, loop.keyframe).has_keyframe(loop.met)) << "from here on the tracker sees it";
}

// Corners a pixel apart are two points, though they pair up: what one showed is not where the other is.
TEST_F(LoopClosureTest, NeighboursAreNotMerged) {
  const auto [kept, other] = loop.link.points[3];
  for (PointObservation& o : map.point(other).observations) o.px.x() += 0.8;
  const LoopCorrection correction = close_loop(map, parameters, loop);
  EXPECT_FALSE(map.point(other).bad);
  EXPECT_EQ(correction.points[static_cast<std::size_t>(other)], other);
  EXPECT_TRUE(map.point(loop.link.points[2].second).bad);
  EXPECT_EQ(map.point(kept).observations.back().keyframe, loop.keyframe) << "observed there all the same";
}

TEST_F(LoopClosureTest, LittleDriftIsLeftToTheAdjustments) {
  parameters.loop_max_shift = 1e4;
  const Map before = map;
  const LoopCorrection correction = close_loop(map, parameters, loop);
  EXPECT_FALSE(correction.corrected);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    EXPECT_EQ(correction.scales[k], 1);
    EXPECT_EQ((map.keyframes[k].T_w_c.t - before.keyframes[k].T_w_c.t).norm(), 0);
  }
  EXPECT_EQ(map.texts[0].theta, before.texts[0].theta);
  EXPECT_TRUE(map.point(loop.link.points[0].second).bad) << "merged all the same";
}

}  // namespace loop_closure_test
}  // namespace textslam
