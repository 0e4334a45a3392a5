// The greedy spanner against its definition by all distances, and on the graphs that a walk makes.
#include "textslam/loop/spanner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace textslam {
namespace spanner_test {

// All shortest distances, by Floyd and Warshall.
class Distances {
 public:
  Distances(int nodes, const std::vector<PathEdge>& edges)
      : d_(static_cast<std::size_t>(nodes),
           std::vector<double>(static_cast<std::size_t>(nodes), std::numeric_limits<double>::infinity())) {
    for (std::size_t i = 0; i < d_.size(); ++i) d_[i][i] = 0;
    for (const PathEdge& e : edges) {
      const auto a = static_cast<std::size_t>(e.a), b = static_cast<std::size_t>(e.b);
      d_[a][b] = d_[b][a] = std::min(d_[a][b], e.length);
    }
    for (std::size_t k = 0; k < d_.size(); ++k)
      for (std::size_t i = 0; i < d_.size(); ++i)
        for (std::size_t j = 0; j < d_.size(); ++j) d_[i][j] = std::min(d_[i][j], d_[i][k] + d_[k][j]);
  }
  double operator()(int a, int b) const { return d_[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)]; }

 private:
  std::vector<std::vector<double>> d_;
};

bool same(const std::vector<PathEdge>& left, const std::vector<PathEdge>& right) {
  return std::equal(left.begin(), left.end(), right.begin(), right.end(), [](const PathEdge& x, const PathEdge& y) {
    return x.a == y.a && x.b == y.b && x.length == y.length;
  });
}

std::vector<PathEdge> by_definition(int nodes, std::vector<PathEdge> edges, double stretch) {
  std::stable_sort(edges.begin(), edges.end(),
                   [](const PathEdge& x, const PathEdge& y) { return x.length < y.length; });
  std::vector<PathEdge> taken;
  for (const PathEdge& e : edges)
    if (!(Distances(nodes, taken)(e.a, e.b) <= stretch * e.length)) taken.push_back(e);
  return taken;
}

// Lengths are whole, so that equal lengths, and paths just as long as allowed, are among them.
TEST(SpannerTest, IsThatOfTheDefinition) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 60; ++trial) {
    const int nodes = 2 + trial % 12;
    std::uniform_int_distribution<int> node(0, nodes - 1), length(1, 9);
    std::vector<PathEdge> edges;
    for (int i = 0; i < 4 * nodes; ++i) {
      const int a = node(random), b = node(random);
      if (a != b) edges.push_back({a, b, static_cast<double>(length(random))});
    }
    for (const double stretch : {1.0, 1.5, 3.0}) {
      SCOPED_TRACE("trial " + std::to_string(trial) + ", stretch " + std::to_string(stretch));
      const std::vector<PathEdge> taken = greedy_spanner(nodes, edges, stretch);
      ASSERT_TRUE(same(taken, by_definition(nodes, edges, stretch)));
      const Distances all(nodes, edges), left(nodes, taken);
      for (const PathEdge& e : edges) EXPECT_LE(left(e.a, e.b), stretch * e.length);
      for (int a = 0; a < nodes; ++a)
        for (int b = 0; b < a; ++b) EXPECT_EQ(std::isfinite(all(a, b)), std::isfinite(left(a, b)));
    }
  }
}

TEST(SpannerTest, OfAWalkLeavesThePath) {
  std::vector<PathEdge> edges;
  for (int b = 0; b < 50; ++b)
    for (int a = std::max(0, b - 15); a < b; ++a) edges.push_back({a, b, 0.1 + (b - a)});
  const std::vector<PathEdge> taken = greedy_spanner(50, edges, 2);
  ASSERT_EQ(taken.size(), 49U);
  for (const PathEdge& e : taken) EXPECT_EQ(e.b, e.a + 1);

  // Back at the beginning, five key frames see what five saw before: the place is tied to itself, by few edges.
  for (int a = 0; a < 5; ++a)
    for (int b = 45; b < 50; ++b) edges.push_back({a, b, 0.1 + std::abs(b - 45 - a)});
  const std::vector<PathEdge> closed = greedy_spanner(50, edges, 2);
  EXPECT_GE(closed.size(), 50U);
  EXPECT_LE(closed.size(), 54U);
  EXPECT_LT(Distances(50, closed)(0, 49), 10);
}

TEST(SpannerTest, OfNothingIsNothing) {
  EXPECT_TRUE(greedy_spanner(0, {}, 2).empty());
  EXPECT_TRUE(greedy_spanner(3, {}, 2).empty());
}

}  // namespace spanner_test
}  // namespace textslam
