// minimise(): what it promises about the state when something goes wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "solver/gauss_newton_problem.hpp"

namespace gauss_newton_faults_test {
using textplane::Evaluation;
using textplane::minimise;
using textplane::SolveOptions;
using textplane::SolveSummary;
using textplane::Status;
using textplane_test::Recorder;
using textplane_test::System;

// One residual a parameter, each with its own unit, and switches for everything that can go wrong.
struct Faulty {
  using State = Eigen::Vector3d;
  static constexpr int kParameters = 3;
  Eigen::Vector3d scale{1, 1e3, 1e-3};
  Eigen::Vector3d target{1, 2e-3, 3e3};
  double trial_lost = 0;
  bool nan_cost = false, nan_hessian = false, nan_trial = false, never_lower = false, fails_at_trials = false;
  Status first = Status::ok;
  int linearisations = 0;

  double cost(const State& x) const { return scale.cwiseProduct(x - target).squaredNorm(); }
  System<3> linearise(const State& x) noexcept {
    System<3> s;
    s.status = first;
    if (fails_at_trials && linearisations > 0 && x != start) s.status = Status::too_few;
    if (linearisations++ == 0) start = x;
    s.H = scale.cwiseAbs2().asDiagonal();
    s.b = scale.cwiseAbs2().cwiseProduct(x - target);
    s.cost = cost(x);
    if (nan_cost) s.cost = std::numeric_limits<double>::quiet_NaN();
    if (nan_hessian) s.H(1, 0) = std::numeric_limits<double>::infinity();
    return s;
  }
  Evaluation evaluate(const State& x) noexcept {
    const double c = nan_trial ? std::numeric_limits<double>::quiet_NaN() : never_lower ? cost(start) : cost(x);
    return {c, trial_lost, Status::ok};
  }
  State retract(const State& x, const Eigen::Vector3d& d) const noexcept { return x + d; }

  Eigen::Vector3d start{0, 0, 0};
};

TEST(GaussNewton, UnitsOfParametersDoNotMatter) {
  Faulty problem;
  Eigen::Vector3d x(0, 0, 0);
  SolveOptions options;
  options.cost_tolerance = 0;
  const SolveSummary s = minimise(problem, x, options);
  EXPECT_EQ(s.status, Status::converged);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(x[i] / problem.target[i], 1, 1e-9);
}

TEST(GaussNewton, NonFiniteSystemsLeaveTheStateAlone) {
  for (const bool hessian : {false, true}) {
    Faulty problem;
    problem.nan_cost = !hessian;
    problem.nan_hessian = hessian;
    Eigen::Vector3d x(0, 0, 0);
    System<3> untouched;
    untouched.cost = 42;
    EXPECT_EQ(minimise(problem, x, SolveOptions{}, &untouched).status, Status::non_finite);
    EXPECT_EQ(x, Eigen::Vector3d(0, 0, 0));
    EXPECT_EQ(untouched.cost, 42);
  }
}

TEST(GaussNewton, NonFiniteTrialsAreRejected) {
  Faulty problem;
  problem.nan_trial = true;
  Eigen::Vector3d x(0, 0, 0);
  SolveOptions options;
  options.max_iterations = 1000;
  const SolveSummary s = minimise(problem, x, options);
  EXPECT_EQ(s.status, Status::diverged);
  EXPECT_EQ(s.accepted, 0);
  EXPECT_EQ(x, Eigen::Vector3d(0, 0, 0));
}

TEST(GaussNewton, StallEndsSoonAndSaysSo) {
  Faulty problem;
  problem.never_lower = true;
  Eigen::Vector3d x(0, 0, 0);
  SolveOptions options;
  options.max_iterations = 1000;
  const SolveSummary s = minimise(problem, x, options);
  EXPECT_EQ(s.status, Status::diverged);
  EXPECT_LT(s.iterations, 20);
  EXPECT_EQ(x, Eigen::Vector3d(0, 0, 0));
}

// A cost with a floor that no parameter reaches: at its minimum, rounding or the kinks of an interpolant may leave a
// step that promises next to nothing and gains nothing. That is convergence, not failure.
struct KinkedFloor : Faulty {
  System<3> linearise(const State& x) noexcept {
    System<3> s = Faulty::linearise(x);
    s.cost += 1e6;
    return s;
  }
  Evaluation evaluate(const State&) noexcept { return {cost(start) + 1e6, 0, Status::ok}; }
};

TEST(GaussNewton, StallAtAFlatMinimumIsConvergence) {
  KinkedFloor problem;
  Eigen::Vector3d x(0, 0, 0);
  EXPECT_EQ(minimise(problem, x).status, Status::converged);
  EXPECT_EQ(x, Eigen::Vector3d(0, 0, 0));
}

TEST(GaussNewton, TrialsThatLoseTooMuchAreRejected) {
  Faulty problem;
  problem.trial_lost = 0.11;
  Eigen::Vector3d x(0, 0, 0);
  SolveSummary s = minimise(problem, x);
  EXPECT_EQ(s.accepted, 0);
  EXPECT_EQ(s.status, Status::diverged);
  EXPECT_EQ(x, Eigen::Vector3d(0, 0, 0));
  problem.trial_lost = 0.1;
  s = minimise(problem, x);
  EXPECT_GT(s.accepted, 0);
  EXPECT_EQ(s.status, Status::converged);
}

TEST(GaussNewton, TrialsThatCannotBeLinearisedAreRejected) {
  Faulty problem;
  problem.fails_at_trials = true;
  Eigen::Vector3d x(0, 0, 0);
  const SolveSummary s = minimise(problem, x);
  EXPECT_EQ(s.accepted, 0);
  EXPECT_EQ(x, Eigen::Vector3d(0, 0, 0));
  // The last linearisation is that of the state returned.
  EXPECT_EQ(s.final_cost, problem.cost(x));
}

TEST(GaussNewton, ReportsTheStatusOfAFailedLinearisation) {
  Faulty problem;
  problem.first = Status::no_contrast;
  Eigen::Vector3d x(5, 5, 5);
  EXPECT_EQ(minimise(problem, x).status, Status::no_contrast);
  EXPECT_EQ(x, Eigen::Vector3d(5, 5, 5));
}

TEST(GaussNewton, AResidualWithoutDerivativeIsRankDeficient) {
  Faulty zero;
  zero.scale[1] = 0;
  Eigen::Vector3d y(0, 0, 0);
  EXPECT_EQ(minimise(zero, y).status, Status::rank_deficient);
}

}  // namespace gauss_newton_faults_test
