// minimise(): convergence, robustness, and the set of residuals that steps are judged on.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "solver/gauss_newton_problem.hpp"

namespace gauss_newton_test {
using textplane::Evaluation;
using textplane::minimise;
using textplane::SolveOptions;
using textplane::SolveSummary;
using textplane::Status;
using textplane_test::Recorder;
using textplane_test::System;

struct Rosenbrock : Recorder<2> {
  using State = Eigen::Vector2d;
  static constexpr int kParameters = 2;

  static double cost(const State& x) {
    const double a = 1 - x[0], c = 10 * (x[1] - x[0] * x[0]);
    return a * a + c * c;
  }
  System<2> linearise(const State& x) noexcept {
    ++linearisations;
    System<2> s;
    s.add(Eigen::RowVector2d(-1, 0), 1 - x[0], 1);
    s.add(Eigen::RowVector2d(-20 * x[0], 10), 10 * (x[1] - x[0] * x[0]), 1);
    s.cost = cost(x);
    costs.push_back(s.cost);
    return s;
  }
  Evaluation evaluate(const State& x) noexcept {
    ++evaluations;
    return {cost(x), 0, Status::ok};
  }
  State retract(const State& x, const Eigen::Vector2d& d) const noexcept { return x + d; }
};

TEST(GaussNewton, MinimisesRosenbrock) {
  Rosenbrock problem;
  Eigen::Vector2d x(-1.2, 1);
  SolveOptions options;
  options.max_iterations = 100;
  options.step_tolerance = 1e-12;
  System<2> final_system;
  const SolveSummary s = minimise(problem, x, options, &final_system);
  EXPECT_EQ(s.status, Status::converged);
  EXPECT_NEAR(x[0], 1, 1e-9);
  EXPECT_NEAR(x[1], 1, 1e-9);
  EXPECT_DOUBLE_EQ(s.initial_cost, Rosenbrock::cost({-1.2, 1}));
  EXPECT_DOUBLE_EQ(s.final_cost, Rosenbrock::cost(x));
  EXPECT_NEAR(s.reduction, s.initial_cost - s.final_cost, 1e-9);
  EXPECT_EQ(s.accepted + 1, problem.linearisations);
  EXPECT_DOUBLE_EQ(final_system.cost, s.final_cost);
  EXPECT_NEAR(final_system.H(0, 0), 401, 1e-6);
}

TEST(GaussNewton, CostNeverRises) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 200; ++trial) {
    Rosenbrock problem;
    const auto draw = [&] { return static_cast<double>(random() % 8001) / 1000.0 - 4.0; };
    const double x0 = draw(), x1 = draw();
    Eigen::Vector2d x(x0, x1);
    SolveOptions options;
    options.max_iterations = 1 + trial % 30;
    const SolveSummary s = minimise(problem, x, options);
    EXPECT_TRUE(is_ok(s.status));
    for (std::size_t i = 1; i < problem.costs.size(); ++i) ASSERT_LT(problem.costs[i], problem.costs[i - 1]);
    EXPECT_LE(s.iterations, options.max_iterations);
    EXPECT_DOUBLE_EQ(Rosenbrock::cost(x), problem.costs.back());
  }
}

TEST(GaussNewton, StopsAtTheIterationLimit) {
  Rosenbrock problem;
  Eigen::Vector2d x(-1.2, 1);
  SolveOptions options;
  options.max_iterations = 6;
  const SolveSummary s = minimise(problem, x, options);
  EXPECT_EQ(s.status, Status::iteration_limit);
  EXPECT_EQ(s.iterations, 6);
  EXPECT_LT(Rosenbrock::cost(x), Rosenbrock::cost({-1.2, 1}));
  options.max_iterations = 0;
  const Eigen::Vector2d before = x;
  EXPECT_EQ(minimise(problem, x, options).status, Status::iteration_limit);
  EXPECT_EQ(x, before);
}

// y = a x + b with Huber weights; a fifth of the data are gross outliers on one side.
struct Line {
  using State = Eigen::Vector2d;
  static constexpr int kParameters = 2;
  std::vector<Eigen::Vector2d> data;
  double delta = 0.05;

  double term(double r) const { return std::abs(r) < delta ? r * r : delta * (2 * std::abs(r) - delta); }
  System<2> linearise(const State& x) noexcept {
    System<2> s;
    for (const auto& p : data) {
      const double r = x[0] * p[0] + x[1] - p[1];
      s.add(Eigen::RowVector2d(p[0], 1), r, std::min(1.0, delta / std::abs(r)));
      s.cost += term(r);
    }
    return s;
  }
  Evaluation evaluate(const State& x) noexcept {
    Evaluation e;
    for (const auto& p : data) e.cost += term(x[0] * p[0] + x[1] - p[1]);
    return e;
  }
  State retract(const State& x, const Eigen::Vector2d& d) const noexcept { return x + d; }
};

TEST(GaussNewton, FitsALineThroughOutliers) {
  Line problem;
  for (int i = 0; i < 100; ++i) {
    const double u = i / 50.0 - 1;
    problem.data.emplace_back(u, 2 * u - 0.5 + (i % 5 == 0 ? 8.0 : 0.001 * (i % 3 - 1)));
  }
  Eigen::Vector2d x(0, 0);
  SolveOptions options;
  options.max_iterations = 100;
  options.cost_tolerance = 1e-14;
  const SolveSummary s = minimise(problem, x, options);
  EXPECT_EQ(s.status, Status::converged);
  // Each outlier pulls with weight delta: the intercept moves by at most 0.05 * 20 / 80.
  EXPECT_NEAR(x[0], 2, 2e-3);
  EXPECT_NEAR(x[1], -0.5, 0.0131);
  // The weighted gradient vanishes at the minimum.
  EXPECT_LT(problem.linearise(x).b.norm(), 1e-5);
}

TEST(GaussNewton, ReportsRankDeficiency) {
  Line problem;
  problem.data.assign(10, Eigen::Vector2d(0.7, 1));  // One abscissa: slope and intercept are not told apart.
  Eigen::Vector2d x(0, 0);
  EXPECT_EQ(minimise(problem, x).status, Status::rank_deficient);
  EXPECT_EQ(x, Eigen::Vector2d(0, 0));
  problem.data.clear();
  EXPECT_EQ(minimise(problem, x).status, Status::rank_deficient);
}

TEST(GaussNewton, RejectsImpossibleOptions) {
  const auto status = [](auto&& change) {
    SolveOptions options;
    change(options);
    Rosenbrock problem;
    Eigen::Vector2d x(0, 0);
    const Status s = minimise(problem, x, options).status;
    EXPECT_EQ(problem.linearisations, 0);
    return s;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(status([](SolveOptions& o) { o.max_iterations = -1; }), Status::invalid_argument);
  EXPECT_EQ(status([&](SolveOptions& o) { o.step_tolerance = nan; }), Status::invalid_argument);
  EXPECT_EQ(status([&](SolveOptions& o) { o.initial_lambda = nan; }), Status::invalid_argument);
  EXPECT_EQ(status([](SolveOptions& o) { o.initial_lambda = 0; }), Status::invalid_argument);
  EXPECT_EQ(status([](SolveOptions& o) { o.max_lambda = 0; }), Status::invalid_argument);
}

TEST(GaussNewton, ZeroTurnsATestOff) {
  for (double SolveOptions::*member :
       {&SolveOptions::step_tolerance, &SolveOptions::cost_tolerance, &SolveOptions::stall_tolerance,
        &SolveOptions::diagonal_floor, &SolveOptions::rank_tolerance, &SolveOptions::max_lost_fraction}) {
    SolveOptions options;
    options.max_iterations = 100;
    for (const double value : {0.0, -1e-9}) {
      options.*member = value;
      Rosenbrock problem;
      Eigen::Vector2d x(-1.2, 1);
      const Status s = minimise(problem, x, options).status;
      EXPECT_EQ(s == Status::invalid_argument, value < 0);
      if (value == 0) {
        EXPECT_LT((x - Eigen::Vector2d(1, 1)).norm(), 1e-3);
      }
    }
  }
}

// A set that shrinks with the state: residual i is seen while x[0] < i. Losing is charged, and the accepted trials are
// lower on the set of their linearisation although the costs of different sets are not comparable.
struct Shrinking {
  using State = Eigen::Matrix<double, 1, 1>;
  static constexpr int kParameters = 1;
  std::vector<char> seen = std::vector<char>(100, 0);
  double at_linearisation = 0;
  bool monotone = true;

  static bool visible(const State& x, int i) { return x[0] < i + 0.5; }
  System<1> linearise(const State& x) noexcept {
    System<1> s;
    for (std::size_t i = 0; i < 100; ++i) {
      seen[i] = visible(x, static_cast<int>(i));
      if (!seen[i]) continue;
      s.add(Eigen::Matrix<double, 1, 1>(1), x[0] - 30, 1);
      s.cost += (x[0] - 30) * (x[0] - 30);
    }
    at_linearisation = s.cost;
    return s;
  }
  Evaluation evaluate(const State& x) noexcept {
    Evaluation e;
    int lost = 0, n = 0;
    for (std::size_t i = 0; i < 100; ++i) {
      if (!seen[i]) continue;
      ++n;
      if (visible(x, static_cast<int>(i)))
        e.cost += (x[0] - 30) * (x[0] - 30);
      else
        ++lost, e.cost += 1000;
    }
    e.lost_fraction = static_cast<double>(lost) / n;
    return e;
  }
  State retract(const State& x, const State& d) const noexcept { return x + d; }
};

TEST(GaussNewton, JudgesStepsOnTheSetOfTheirLinearisation) {
  Shrinking problem;
  Shrinking::State x(-0.4);
  SolveOptions options;
  options.max_iterations = 200;
  options.step_tolerance = 1e-10;
  const SolveSummary s = minimise(problem, x, options);
  // The full step to 30 would lose 30 of 100 and is refused; shorter steps that lose a few at a time are allowed only
  // while they pay.
  EXPECT_GT(s.accepted, 0);
  EXPECT_GT(s.iterations, s.accepted);
  EXPECT_GT(s.reduction, 0);
  EXPECT_GT(x[0], -0.4);
  EXPECT_LT(x[0], 30.5);
}

static_assert(noexcept(minimise(std::declval<Rosenbrock&>(), std::declval<Eigen::Vector2d&>())),
              "minimise is noexcept");
}  // namespace gauss_newton_test
