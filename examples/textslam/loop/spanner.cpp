#include "textslam/loop/spanner.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace textslam {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

class Graph {
 public:
  explicit Graph(int nodes) : edges_(static_cast<std::size_t>(nodes)), distance_(edges_.size(), kFar) {}

  void add(const PathEdge& edge) {
    edges_[static_cast<std::size_t>(edge.a)].emplace_back(edge.length, edge.b);
    edges_[static_cast<std::size_t>(edge.b)].emplace_back(edge.length, edge.a);
  }

  // Is there a path from a to b that is no longer than this? Dijkstra's search, from a as far as that.
  bool has_path(int a, int b, double longest) {
    std::priority_queue<Reached, std::vector<Reached>, std::greater<Reached>> next;
    std::vector<int> touched;
    const auto reach = [&](double distance, int node) {
      double& known = distance_[static_cast<std::size_t>(node)];
      if (distance > longest || distance >= known) return;
      known = distance;
      touched.push_back(node);
      next.emplace(distance, node);
    };
    reach(0, a);
    while (!next.empty() && next.top().second != b) {
      const auto [distance, node] = next.top();
      next.pop();
      if (distance > distance_[static_cast<std::size_t>(node)]) continue;
      for (const auto& [length, other] : edges_[static_cast<std::size_t>(node)]) reach(distance + length, other);
    }
    for (const int node : touched) distance_[static_cast<std::size_t>(node)] = kFar;
    return !next.empty();
  }

 private:
  using Reached = std::pair<double, int>;  // length, node
  std::vector<std::vector<Reached>> edges_;
  std::vector<double> distance_;  // from the node where the search began
};

}  // namespace

std::vector<PathEdge> greedy_spanner(int nodes, std::vector<PathEdge> edges, double stretch) {
  std::stable_sort(edges.begin(), edges.end(),
                   [](const PathEdge& x, const PathEdge& y) { return x.length < y.length; });
  Graph graph(nodes);
  std::vector<PathEdge> taken;
  for (const PathEdge& edge : edges) {
    if (graph.has_path(edge.a, edge.b, stretch * edge.length)) continue;
    graph.add(edge);
    taken.push_back(edge);
  }
  return taken;
}

}  // namespace textslam
