// Automatic differentiation of the same residual by ceres::Jet.
#ifndef TEXTPLANE_BENCH_PEERS_CERES_HPP
#define TEXTPLANE_BENCH_PEERS_CERES_HPP

#include "problem.hpp"

namespace textplane_bench {

/// A ceres::AutoDiffCostFunction for one problem: N residuals, parameters (v, omega) of the left perturbation and
/// theta.
class CeresCost {
 public:
  __attribute__((visibility("default"))) explicit CeresCost(const Problem& problem);
  __attribute__((visibility("default"))) ~CeresCost();
  CeresCost(const CeresCost&) = delete;
  CeresCost& operator=(const CeresCost&) = delete;

  /// Residuals and Jacobian.
  __attribute__((visibility("default"))) void rows();
  /// rows(), then J^T J and J^T r by Eigen's matrix product, without robust weights.
  __attribute__((visibility("default"))) void equations(Equations* out);

 private:
  struct State;
  State* state_;
};

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_PEERS_CERES_HPP
