// The straightforward peer: double precision, fixed-size Eigen, two passes over the pixels.
#ifndef TEXTPLANE_BENCH_PEERS_EIGEN_HPP
#define TEXTPLANE_BENCH_PEERS_EIGEN_HPP

#include "problem.hpp"

namespace textplane_bench {

/// Exact Huber normal equations of (v, omega, theta).
__attribute__((visibility("default"))) void baseline_pose_plane(const Problem& problem, Equations* out);
/// Those of (v, omega).
__attribute__((visibility("default"))) void baseline_pose(const Problem& problem, Equations* out);

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_PEERS_EIGEN_HPP
