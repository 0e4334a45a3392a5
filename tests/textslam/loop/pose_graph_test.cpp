// The pose graph puts chains of known drift right.
#include "textslam/loop/pose_graph.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "textslam/loop/circle_support.hpp"

namespace textslam {
namespace pose_graph_test {

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

}  // namespace pose_graph_test
}  // namespace textslam
