// What the problems given to minimise() in tests are made of.
#ifndef TEXTPLANE_TESTS_SOLVER_GAUSS_NEWTON_PROBLEM_HPP
#define TEXTPLANE_TESTS_SOLVER_GAUSS_NEWTON_PROBLEM_HPP

#include <vector>

#include "textplane/solver/gauss_newton.hpp"

namespace textplane_test {
using textplane::Status;

template <int P>
struct System {
  Eigen::Matrix<double, P, P> H = Eigen::Matrix<double, P, P>::Zero();
  Eigen::Matrix<double, P, 1> b = Eigen::Matrix<double, P, 1>::Zero();
  double cost = 0;
  Status status = Status::ok;

  template <class Row>
  void add(const Row& j, double r, double weight) {
    H += weight * j.transpose() * j;
    b += weight * j.transpose() * r;
  }
};

// Records every state at which the solver linearised, with the cost there.
template <int P>
struct Recorder {
  std::vector<double> costs;
  int linearisations = 0, evaluations = 0;
};
}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SOLVER_GAUSS_NEWTON_PROBLEM_HPP
