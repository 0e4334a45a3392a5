// Pose graph: key frames and their relative poses. Closing a loop distributes the drift along the path.
#ifndef TEXTSLAM_LOOP_POSE_GRAPH_HPP
#define TEXTSLAM_LOOP_POSE_GRAPH_HPP

#include <vector>

#include "io/evaluate.hpp"
#include "textslam/common/geometry.hpp"
#include "textslam/common/parameters.hpp"

namespace textslam {

/// Translation, rotation (radians) and logarithm of the scale.
using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

/// S times (step's translation, exponential of its rotation, exponential of its last entry).
Similarity moved(const Similarity& S, const Vector7& step);

/// What is known of nodes a and b: S_w_b = S_w_a S_a_b, moved by an error of this information (inverse covariance).
struct GraphEdge {
  int a = 0, b = 0;
  Similarity S_a_b;
  Matrix7 information = Matrix7::Identity();
};

/// Nodes are S_w_k, frame k to the world, monocular: each with a scale. Minimises over all but node `fixed`
///
///   sum over edges of e^T information e,  e = (t, log R, log s) of S_a_b^-1 S_w_a^-1 S_w_b,
///
/// by Gauss-Newton. All nodes must be connected. False, and the nodes as they were, where the system is singular.
bool relax(std::vector<Similarity>& nodes, const std::vector<GraphEdge>& edges, int fixed,
           const Parameters& parameters = {});

}  // namespace textslam

#endif  // TEXTSLAM_LOOP_POSE_GRAPH_HPP
