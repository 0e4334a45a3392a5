// Numeric differences, as the published TextSLAM takes them.
#ifndef TEXTPLANE_BENCH_PEERS_NUMERIC_HPP
#define TEXTPLANE_BENCH_PEERS_NUMERIC_HPP

#include <vector>

#include "problem.hpp"

namespace textplane_bench {

/// ceres::NumericDiffCostFunction with central differences. Parameters: the world-to-camera poses of host and target
/// (quaternion x y z w, translation) and theta, 17 columns. A residual block has eight pixels; mean and norm of both
/// sides are held. Like the published code, each evaluation makes both 4 x 4 poses, inverts the host's, and intersects
/// each ray with the plane. The host's pose is the identity.
class NumericCost {
 public:
  __attribute__((visibility("default"))) explicit NumericCost(const Problem& problem);
  __attribute__((visibility("default"))) ~NumericCost();
  NumericCost(const NumericCost&) = delete;
  NumericCost& operator=(const NumericCost&) = delete;

  /// Residuals and Jacobian of all whole blocks.
  __attribute__((visibility("default"))) void rows();
  /// Writes d r / d theta of the last rows(), three numbers a pixel; returns the number of pixels.
  __attribute__((visibility("default"))) int theta_rows(std::vector<double>* out) const;

 private:
  struct State;
  State* state_;
};

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_PEERS_NUMERIC_HPP
