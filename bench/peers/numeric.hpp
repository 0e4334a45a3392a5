// Numeric differences, of the kind that the published TextSLAM uses.
#ifndef TEXTPLANE_BENCH_PEERS_NUMERIC_HPP
#define TEXTPLANE_BENCH_PEERS_NUMERIC_HPP

#include <vector>

#include "problem.hpp"

namespace textplane_bench {

/// ceres::NumericDiffCostFunction, central differences, by the world-to-camera poses of host and target (quaternion x y z w and
/// translation each) and theta: 17 columns. A residual block has eight pixels with rays of their own, mean and norm of both sides
/// are held. As the published one does, each evaluation makes both 4 x 4 poses, inverts the host's, and meets the plane ray by
/// ray, H = R + t theta^T being its short form. The host's pose is the identity.
class NumericCost {
 public:
  __attribute__((visibility("default"))) explicit NumericCost(const Problem& problem);
  __attribute__((visibility("default"))) ~NumericCost();
  NumericCost(const NumericCost&) = delete;
  NumericCost& operator=(const NumericCost&) = delete;

  /// Residuals and Jacobian of all whole blocks.
  __attribute__((visibility("default"))) void rows();
  /// d r / d theta of the last rows(), three numbers a pixel, and how many pixels.
  __attribute__((visibility("default"))) int theta_rows(std::vector<double>* out) const;

 private:
  struct State;
  State* state_;
};

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_PEERS_NUMERIC_HPP
