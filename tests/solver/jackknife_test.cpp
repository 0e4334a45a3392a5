// The covariance by leaving groups out is what leaving them out gives.
#include "textplane/solver/jackknife.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

namespace jackknife_test {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using textplane::GroupEquations;
using textplane::jackknife_covariance;

// r = J x - y in groups, each with an error of its own.
struct Linear {
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 3>> J;
  std::vector<Eigen::VectorXd> y;

  Linear(int groups, double common_error) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int g = 0; g < groups; ++g) {
      const int rows = 5 + g % 3;
      J.emplace_back(rows, 3);
      for (int i = 0; i < rows; ++i)
        for (int c = 0; c < 3; ++c) J.back()(i, c) = 1 + normal(random);
      y.emplace_back(Eigen::VectorXd::Constant(rows, common_error * normal(random)));
      for (int i = 0; i < rows; ++i) y.back()[i] += 0.01 * normal(random);
    }
  }
  Vector3d solve(std::size_t without) const {
    Matrix3d H = Matrix3d::Zero();
    Vector3d b = Vector3d::Zero();
    for (std::size_t g = 0; g < J.size(); ++g) {
      if (g == without) continue;
      H += J[g].transpose() * J[g];
      b += J[g].transpose() * y[g];
    }
    return H.inverse() * b;
  }
  std::vector<GroupEquations<>> at(const Vector3d& x) const {
    std::vector<GroupEquations<>> groups;
    for (std::size_t g = 0; g < J.size(); ++g)
      groups.push_back({J[g].transpose() * J[g], J[g].transpose() * (J[g] * x - y[g])});
    return groups;
  }
};

constexpr std::size_t kNone = 1000;

TEST(Jackknife, IsWhatSolvingWithoutEachGroupGives) {
  const Linear problem(9, 0.1);
  const Vector3d x = problem.solve(kNone);
  Matrix3d expected = Matrix3d::Zero();
  for (std::size_t g = 0; g < 9; ++g) {
    const Vector3d moved = problem.solve(g) - x;
    expected += 8.0 / 9 * moved * moved.transpose();
  }
  EXPECT_GT(expected.trace(), 1e-5);
  EXPECT_TRUE(jackknife_covariance(problem.at(x)).isApprox(expected, 1e-9));
}

// What the measurements of a group have in common is seen, which the inverse of the normal equations cannot tell.
TEST(Jackknife, SeesWhatAGroupShares) {
  const Linear alone(40, 0), shared(40, 0.1);
  const double own = jackknife_covariance(alone.at(alone.solve(kNone))).trace();
  EXPECT_GT(jackknife_covariance(shared.at(shared.solve(kNone))).trace(), 25 * own);
}

TEST(Jackknife, OneGroupOrNoneTellsNothing) {
  EXPECT_EQ(jackknife_covariance<3>({}), Matrix3d::Zero());
  const Linear one(1, 0.1);
  EXPECT_EQ(jackknife_covariance(one.at(one.solve(kNone))), Matrix3d::Zero());
  GroupEquations<> all, none;
  all.H.setIdentity();
  EXPECT_EQ(jackknife_covariance<3>({all, none}), Matrix3d::Zero()) << "the second alone determines nothing";
}

}  // namespace jackknife_test
