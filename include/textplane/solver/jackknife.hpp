// Certainty of an estimate, by how much the groups of its measurements disagree (the jackknife of Quenouille and
// Tukey).
//
// The inverse of the normal equations takes all errors as independent. Those of one image's pixels are not: they share
// a pose and a light. The images are, so each is left out in turn.
#ifndef TEXTPLANE_SOLVER_JACKKNIFE_HPP
#define TEXTPLANE_SOLVER_JACKKNIFE_HPP

#include <vector>

#include "textplane/core/numeric.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// What one group gives to the normal equations of N unknowns at the estimate: H = J^T W J, b = J^T W r.
template <int N = 3>
struct GroupEquations {
  FixedMatrix<double, N, N> H = FixedMatrix<double, N, N>::Zero();      ///< J^T W J
  Eigen::Matrix<double, N, 1> b = Eigen::Matrix<double, N, 1>::Zero();  ///< J^T W r
};

/// Covariance at the estimate where the b sum to zero: (n - 1) / n sum_i d_i d_i^T, with d_i = (sum_j!=i H_j)^-1 b_i
/// the motion without group i; exact for linear residuals. Groups whose others are singular are skipped; zero for fewer
/// than two.
template <int N>
FixedMatrix<double, N, N> jackknife_covariance(const std::vector<GroupEquations<N>>& groups) {
  FixedMatrix<double, N, N> H = FixedMatrix<double, N, N>::Zero(), covariance = H;
  for (const GroupEquations<N>& group : groups) H += group.H;
  const double n = static_cast<double>(groups.size());
  for (const GroupEquations<N>& group : groups) {
    const Ldlt<double, N> others(H - group.H);
    if (!others.ok()) continue;
    const Eigen::Matrix<double, N, 1> moved = others.solve(group.b);
    covariance += (n - 1) / n * moved * moved.transpose();
  }
  return covariance;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_JACKKNIFE_HPP
