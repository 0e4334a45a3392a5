// Eigen's dense decompositions as oracles. Each takes seconds to compile for each size it is used with: here once, for any size.
#ifndef TEXTPLANE_TESTS_SUPPORT_DENSE_HPP
#define TEXTPLANE_TESTS_SUPPORT_DENSE_HPP

#include <Eigen/Core>

namespace textplane_test {

/// Eigenvalues of a symmetric matrix, ascending.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);

/// x with a x = b for a positive definite a, by its LDL^T.
Eigen::MatrixXd definite_solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The inverse of a regular matrix, by LU with full pivoting.
Eigen::MatrixXd full_inverse(const Eigen::MatrixXd& a);

/// x that minimises |a x - b|, by QR with column pivoting.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SUPPORT_DENSE_HPP
