// How sure an estimate is by how far the groups of its measurements pull apart.
//
// The inverse of the normal equations takes the errors of all measurements for independent of each other. Those of the
// pixels of one image are not: it has one pose, one light, and neighbouring pixels share what is wrong with them. What
// is independent are the images, and leaving them out by turns tells how far any one of them moves the estimate
// (Quenouille's and Tukey's jackknife).
#ifndef TEXTSLAM_TEXT_JACKKNIFE_HPP
#define TEXTSLAM_TEXT_JACKKNIFE_HPP

#include <Eigen/Core>
#include <vector>

#include "textplane/core/numeric.hpp"

namespace textslam {

/// What one group gives to the normal equations at the estimate: H = J^T W J, b = J^T W r.
struct GroupEquations {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
};

/// Covariance of the estimate at which the groups' b sum to zero: (n - 1) / n sum_i d_i d_i^T with d_i = (sum_j!=i
/// H_j)^-1 b_i, by which it moves without group i; exact where the residuals are linear. Groups without which the
/// others would not determine it tell nothing here and are passed over; zero for less than two groups.
inline Eigen::Matrix3d jackknife_covariance(const std::vector<GroupEquations>& groups) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero(), covariance = Eigen::Matrix3d::Zero();
  for (const GroupEquations& group : groups) H += group.H;
  const double n = static_cast<double>(groups.size());
  for (const GroupEquations& group : groups) {
    const textplane::Ldlt<double, 3> others(H - group.H);
    if (!others.ok()) continue;
    const Eigen::Vector3d moved = others.solve(group.b);
    covariance += (n - 1) / n * moved * moved.transpose();
  }
  return covariance;
}

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_JACKKNIFE_HPP
