// Eigen's dense decompositions as oracles. Each takes seconds to compile for each size it is used with: here once, for
// any size.
#ifndef TEXTPLANE_TESTS_SUPPORT_DENSE_HPP
#define TEXTPLANE_TESTS_SUPPORT_DENSE_HPP

#include <Eigen/Core>

namespace textplane_test {

/// Eigenvalues of a symmetric matrix, ascending.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);

/// x that minimises |a x - b|, and solves a x = b where it can be, by QR with column pivoting.
Eigen::MatrixXd dense_solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SUPPORT_DENSE_HPP
