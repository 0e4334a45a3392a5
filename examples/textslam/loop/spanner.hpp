// Spanner: the few edges of a graph along which all others are about as short.
//
// Key frames of one stretch of the path all share points with one another, but have drifted together: the drift
// between two of them is the sum of the drifts on the way. An edge for each such pair would make the path stiffer with
// each key frame on it. A spanner leaves the path, and where the path came back to a place, the edges that say so.
#ifndef TEXTSLAM_LOOP_SPANNER_HPP
#define TEXTSLAM_LOOP_SPANNER_HPP

#include <vector>

namespace textslam {

struct PathEdge {
  int a = 0, b = 0;
  double length = 0;
};

/// The greedy spanner of Althoefer et al. (1993): of `edges` between nodes 0 to `nodes` - 1, in order of their length,
/// each whose ends are connected by no path of those taken before that is at most `stretch` times as long. What is
/// connected stays so. Lengths are positive; edges of equal length count in the order given.
std::vector<PathEdge> greedy_spanner(int nodes, std::vector<PathEdge> edges, double stretch);

}  // namespace textslam

#endif  // TEXTSLAM_LOOP_SPANNER_HPP
