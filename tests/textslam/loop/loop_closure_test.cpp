// Loops closed on chains of known drift: the pose graph puts a chain right, and a map's points, planes and ids follow.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>

#include "textplane/geometry/plane.hpp"
#include "textslam/loop/loop_alignment.hpp"
#include "textslam/loop/loop_closure.hpp"
#include "textslam/loop/pose_graph.hpp"
#include "textslam/map/observations.hpp"

namespace textslam {
namespace loop_closure_test {

Similarity similarity(double scale, const Vec3& w, const Vec3& t) {
  Similarity S;
  S.scale = scale;
  S.R = textplane::so3_exp<double>(w);
  S.t = t;
  return S;
}

double distance(const Similarity& A, const Similarity& B) {
  const Similarity E = compose(inverse(A), B);
  return E.t.norm() + textplane::so3_log<double>(E.R).norm() + std::abs(std::log(E.scale));
}

// A walk once round a circle of radius 2, looking outwards.
std::vector<Similarity> circle(int n) {
  std::vector<Similarity> nodes;
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * M_PI * k / n;
    nodes.push_back(
        similarity(1, {0, angle, 0}, {2 * std::sin(angle), 0.1 * std::sin(3 * angle), 2 * std::cos(angle)}));
  }
  return nodes;
}

TEST(PoseGraphTest, CompositionAndInverse) {
  const Similarity A = similarity(1.3, {0.2, -0.4, 0.1}, {1, 2, 3}), B = similarity(0.7, {-0.3, 0.1, 0.5}, {-2, 0, 1});
  const Vec3 p(0.3, -1, 2);
  EXPECT_LT((compose(A, B) * p - A * (B * p)).norm(), 1e-12);
  EXPECT_LT((inverse(A) * (A * p) - p).norm(), 1e-12);
}

// What Gauss-Newton stops at is a minimum: no change of any node makes the sum smaller.
TEST(PoseGraphTest, StopsAtTheMinimum) {
  std::vector<Similarity> nodes = circle(6);
  std::vector<GraphEdge> edges;
  const auto edge = [&](int a, int b, const Similarity& off, double length) {
    const Similarity S_a_b = compose(inverse(nodes[static_cast<std::size_t>(a)]), nodes[static_cast<std::size_t>(b)]);
    edges.push_back({a, b, compose(S_a_b, off), Matrix7::Identity() / length});
    edges.back().information(1, 4) = edges.back().information(4, 1) = 0.3 / length;
  };
  for (int k = 0; k < 5; ++k)
    edge(k, k + 1, similarity(1 + 0.01 * k, {0.02, -0.03, 0.01}, {0.05, 0, -0.04 * k}), 1 + k);
  edge(5, 0, similarity(0.9, {0.1, 0, 0.05}, {0.2, -0.1, 0}), 0.1);
  edge(1, 4, similarity(1.05, {0, 0.05, 0}, {0, 0.1, 0.1}), 2);
  const auto cost = [&](const std::vector<Similarity>& S) {
    double sum = 0;
    for (const GraphEdge& e : edges) {
      const Similarity S_a_b = compose(inverse(S[static_cast<std::size_t>(e.a)]), S[static_cast<std::size_t>(e.b)]);
      const Similarity E = compose(inverse(e.S_a_b), S_a_b);
      Vector7 error;
      error << E.t, textplane::so3_log<double>(E.R), std::log(E.scale);
      sum += error.dot(e.information * error);
    }
    return sum;
  };
  const std::vector<Similarity> start = nodes;
  ASSERT_TRUE(relax(nodes, edges, 2));
  EXPECT_EQ(distance(nodes[2], start[2]), 0) << "fixed";
  const double least = cost(nodes);
  EXPECT_LT(least, 0.5 * cost(start));
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (int axis = 0; k != 2 && axis < 7; ++axis)
      for (const double d : {1e-3, -1e-3}) {
        std::vector<Similarity> other = nodes;
        Vec3 w = Vec3::Zero(), t = Vec3::Zero();
        if (axis < 3) t[axis] = d;
        if (axis >= 3 && axis < 6) w[axis - 3] = d;
        other[k] = compose(other[k], similarity(axis == 6 ? 1 + d : 1, w, t));
        EXPECT_GT(cost(other), least) << "node " << k << ", axis " << axis;
      }
}

// The estimated chain of true nodes whose steps each have a drift; an edge a step.
std::vector<Similarity> drifted(const std::vector<Similarity>& truth, const std::vector<Similarity>& drift,
                                const std::vector<double>& lengths, std::vector<GraphEdge>* edges) {
  std::vector<Similarity> nodes = {truth[0]};
  for (std::size_t k = 0; k + 1 < truth.size(); ++k) {
    const Similarity measured = compose(compose(inverse(truth[k]), truth[k + 1]), drift[k]);
    edges->push_back({static_cast<int>(k), static_cast<int>(k) + 1, measured, Matrix7::Identity() / lengths[k]});
    nodes.push_back(compose(nodes[k], measured));
  }
  return nodes;
}

// On a screw all steps commute: what is lost in proportion to the way comes back in proportion to it, and exactly.
TEST(PoseGraphTest, AChainWithKnownDriftIsPutRight) {
  std::vector<Similarity> truth = {similarity(1, {0, 0, 0}, {0, 0, 0})}, drift;
  std::vector<double> lengths;
  for (int k = 0; k < 40; ++k) {
    const double length = 0.5 + k % 4;
    truth.push_back(compose(truth.back(), similarity(1, {0, 0, 0.1}, {0, 0, 0.3})));
    drift.push_back(similarity(1, {0, 0, 0.01 * length}, {0, 0, 0}));
    lengths.push_back(length);
  }
  std::vector<GraphEdge> edges;
  std::vector<Similarity> nodes = drifted(truth, drift, lengths, &edges);
  const double lost = distance(nodes.back(), truth.back());
  ASSERT_GT(lost, 0.7);
  std::vector<Similarity> open = nodes;
  ASSERT_TRUE(relax(open, edges, 0));
  EXPECT_LT(distance(open.back(), nodes.back()), 1e-9) << "nothing pulls";

  edges.push_back({0, 40, compose(inverse(truth.front()), truth.back()), 1e9 * Matrix7::Identity()});
  ASSERT_TRUE(relax(nodes, edges, 0));
  for (std::size_t k = 0; k < nodes.size(); ++k) EXPECT_LT(distance(nodes[k], truth[k]), 1e-6) << k;
}

// Scale drifts as well, in place; then once round a circle, where it does not commute with the way.
TEST(PoseGraphTest, ScaleComesBackToo) {
  std::vector<GraphEdge> edges;
  std::vector<Similarity> truth(21, similarity(1, {0, 0, 0}, {1, 2, 3}));
  const Similarity drift = similarity(1.01, {0, 0, 0}, {0, 0, 0});
  std::vector<Similarity> nodes =
      drifted(truth, std::vector<Similarity>(20, drift), std::vector<double>(20, 1), &edges);
  edges.push_back({0, 20, similarity(1, {0, 0, 0}, {0, 0, 0}), 1e9 * Matrix7::Identity()});
  ASSERT_TRUE(relax(nodes, edges, 0));
  for (std::size_t k = 0; k < nodes.size(); ++k) EXPECT_LT(distance(nodes[k], truth[k]), 1e-6) << k;

  edges.clear();
  truth = circle(40);
  nodes = drifted(truth, std::vector<Similarity>(39, drift), std::vector<double>(39, 1), &edges);
  const std::vector<Similarity> before = nodes;
  edges.push_back({0, 39, compose(inverse(truth.front()), truth.back()), 1e9 * Matrix7::Identity()});
  ASSERT_TRUE(relax(nodes, edges, 0));
  EXPECT_LT(distance(nodes.back(), truth.back()), 1e-6);
  double lost = 0, left = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    lost += distance(before[k], truth[k]);
    left += distance(nodes[k], truth[k]);
  }
  EXPECT_LT(left, 0.5 * lost);
}

TEST(PoseGraphTest, WhatDoesNotHangTogetherIsLeftAlone) {
  std::vector<Similarity> nodes = circle(4);
  const std::vector<Similarity> before = nodes;
  EXPECT_FALSE(relax(nodes, {{0, 1, similarity(1, {0, 0, 0}, {1, 0, 0}), Matrix7::Identity()}}, 0));
  for (std::size_t k = 0; k < nodes.size(); ++k) EXPECT_EQ(distance(nodes[k], before[k]), 0);
}

// A map of a walk round a circle and some steps on: points in front of each key frame, seen by it and the next two. The last
// key frames look at what the first ones saw, and the map does not know. From each key frame to the next, lengths grow by a
// factor that they should not.
class LoopClosureTest : public testing::Test {
 protected:
  static constexpr int kRound = 30, kKeyFrames = 33, kEach = 20;
  static constexpr double kGrowth = 1.004;

  LoopClosureTest() {
    map.camera = {262, 262, 159.5, 119.5};
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
        for (int seen = k; seen <= k + 2 && seen < kKeyFrames; ++seen)
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
    text.patch.quad.corner = {Vec2(100, 100), Vec2(200, 100), Vec2(200, 140), Vec2(100, 140)};
    map.texts.push_back(text);

    // What key frame 30 to 32 see is what key frame 0 to 2 saw.
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
