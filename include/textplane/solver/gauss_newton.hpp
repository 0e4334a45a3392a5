// minimise(): Gauss-Newton with Levenberg damping for small problems with a fixed number of parameters.
//
// The cost is C(x) = sum_i rho(r_i^2) (no factor 1/2), rho'(0) = 1. A Problem linearises, evaluates and moves:
//
//   struct Problem {
//     using State = ...;                                 // copied; need not be a vector space
//     static constexpr int kParameters = P;              // dimension of the step
//     Linearised linearise(const State& x);              // any type with members
//                                                        //   H = J^T W J (P x P), b = J^T W r (P), cost = C(x), status
//     Evaluation evaluate(const State& x);               // C(x) on the set of residuals of the last linearise()
//     State retract(const State& x, const Eigen::Matrix<double, P, 1>& step) const;
//   };
//
// All functions are noexcept. Residuals come and go with the state (a pixel leaves the image). So a trial is compared
// on the residuals of its linearisation: evaluate() charges those that the trial loses and reports their share. A share
// above `max_lost_fraction` rejects the trial. "The cost never rises" means: every accepted trial costs less than the
// state before it, both on those residuals.
//
// The step is -(H + lambda D)^-1 b with D = max(diag H, floor). lambda follows the gain ratio of actual to predicted
// decrease (Nielsen 1999). No allocation, no exception; a few P x P matrices on the stack.
#ifndef TEXTPLANE_SOLVER_GAUSS_NEWTON_HPP
#define TEXTPLANE_SOLVER_GAUSS_NEWTON_HPP

#include <algorithm>
#include <cmath>

#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// When to stop and how to damp. A tolerance of zero turns its test off.
struct SolveOptions {
  int max_iterations = 20;  ///< Trial steps, rejected ones included.
  /// Converged when the norm of the step (in the units of the parameters) is at most this. That step is not taken.
  double step_tolerance = 1e-6;
  double cost_tolerance = 1e-6;  ///< Converged when an accepted step lowers the cost by at most this share of it.
  /// Where no step lowers the cost: converged if the full step predicted a decrease of at most this share.
  double stall_tolerance = 1e-3;
  double initial_lambda = 1e-4;   ///< First damping, a multiple of the diagonal of H.
  double min_lambda = 1e-12;      ///< Smallest damping.
  double max_lambda = 1e8;        ///< Damping above this counts as a stall.
  double diagonal_floor = 1e-15;  ///< Entries of D are at least this share of the largest one.
  /// H is singular where a Cholesky pivot is at most this share of its diagonal entry.
  double rank_tolerance = 1e-13;
  double max_lost_fraction = 0.1;  ///< A trial that loses a larger share of the residuals is rejected.
};

/// Cost of a trial state on the residuals of the last linearisation.
struct Evaluation {
  double cost = 0;             ///< In the problem's own unit.
  double lost_fraction = 0;    ///< In [0, 1].
  Status status = Status::ok;  ///< Anything but an ok status rejects the trial.
};

/// What a solve did.
///
/// status: converged; iteration_limit; diverged (no step lowered the cost although the full step predicted more than
/// `stall_tolerance`); rank_deficient (H of the initial state is singular); non_finite (NaN or infinity in H, b or the
/// cost of the initial state); invalid_argument (options); or the status of the failed first linearisation.
struct SolveSummary {
  Status status = Status::invalid_argument;  ///< Why it ended.
  double initial_cost = 0;                   ///< At the initial state, on its own residuals.
  /// At the returned state, on its own residuals. Comparable with initial_cost if both states have the same residuals.
  double final_cost = 0;
  /// Sum of the accepted steps' decreases, each on the residuals of its linearisation. Never negative.
  double reduction = 0;
  int iterations = 0;    ///< Trials made.
  int accepted = 0;      ///< Trials accepted.
  double last_step = 0;  ///< Norm of the last step computed.
};

namespace detail {
// A rejection multiplies the damping by this, the next one by twice as much: four in a row make a gradient step.
constexpr double kFirstGrowth = 8.0;

inline bool valid(const SolveOptions& o) noexcept {
  for (const double x : {o.step_tolerance, o.cost_tolerance, o.stall_tolerance, o.initial_lambda, o.min_lambda,
                         o.max_lambda, o.diagonal_floor, o.rank_tolerance, o.max_lost_fraction})
    if (!is_finite(x)) return false;
  return o.max_iterations >= 0 && o.step_tolerance >= 0 && o.cost_tolerance >= 0 && o.stall_tolerance >= 0 &&
         o.initial_lambda > 0 && o.min_lambda > 0 && o.max_lambda > o.min_lambda && o.diagonal_floor >= 0 &&
         o.rank_tolerance >= 0 && o.max_lost_fraction >= 0;
}

// Status of a linearisation: its own, non_finite or rank_deficient. Ldlt's pivot test is independent of units.
template <int P, class Linearised>
Status check(const Linearised& system, double rank_tolerance) noexcept {
  if (!is_ok(system.status)) return system.status;
  if (!all_finite(system.H) || !all_finite(system.b) || !is_finite(system.cost)) return Status::non_finite;
  return Ldlt<double, P>(system.H, rank_tolerance).ok() ? Status::ok : Status::rank_deficient;
}

// The factor of the damping after an accepted step, from its gain ratio.
inline double damping_factor(double decrease, double predicted) noexcept {
  const double gain = predicted > 0.0 ? decrease / predicted : 1.0, x = 2.0 * gain - 1.0;
  return (std::min)((std::max)(1.0 - x * x * x, 0.1), 2.0);
}

// -(H + lambda D)^-1 b and the decrease that the quadratic model predicts for it.
template <int P>
struct DampedStep {
  Eigen::Matrix<double, P, 1> step = Eigen::Matrix<double, P, 1>::Zero();
  double predicted = 0.0, norm = 0.0;
  bool usable = false;
};
template <int P, class Linearised>
DampedStep<P> damped_step(const Linearised& system, double lambda, double diagonal_floor) noexcept {
  DampedStep<P> out;
  double largest = 0.0;
  for (int i = 0; i < P; ++i) largest = system.H(i, i) > largest ? system.H(i, i) : largest;
  FixedMatrix<double, P, P> damped = system.H;
  Eigen::Matrix<double, P, 1> damping;
  for (int i = 0; i < P; ++i) {
    const double floor = diagonal_floor * largest;
    damping[i] = lambda * (system.H(i, i) > floor ? system.H(i, i) : floor);
    damped(i, i) += damping[i];
  }
  const Ldlt<double, P> factor(damped, 0.0);
  if (!factor.ok()) return out;
  out.step = factor.solve(system.b);
  // Model C + 2 b.step + step.H step with (H + D) step = -b: the decrease is -b.step + step.D step.
  double squared_norm = 0.0;
  for (int i = 0; i < P; ++i) {
    out.step[i] = -out.step[i];
    out.predicted += out.step[i] * (damping[i] * out.step[i] - system.b[i]);
    squared_norm += out.step[i] * out.step[i];
  }
  out.norm = std::sqrt(squared_norm);
  out.usable = is_finite(squared_norm) && is_finite(out.predicted);
  return out;
}
}  // namespace detail

/// Minimises `problem` from `state`, in place.
///
/// `state` becomes the best one found: the last accepted trial, or the initial state. A trial that lowers the cost but
/// cannot be linearised (too few residuals, singular, non-finite) is rejected too. So, unless the first linearisation
/// fails, the last linearise() is at the returned state, and `*system`, unless null, receives it: H is the information
/// matrix of the result.
template <class Problem>
SolveSummary minimise(Problem& problem, typename Problem::State& state, const SolveOptions& options = {},
                      decltype(problem.linearise(state))* system = nullptr) noexcept {
  constexpr int P = Problem::kParameters;
  SolveSummary summary;
  if (!detail::valid(options)) return summary;
  auto current = problem.linearise(state);
  summary.status = detail::check<P>(current, options.rank_tolerance);
  if (!is_ok(summary.status)) return summary;
  summary.initial_cost = current.cost;

  const auto finish = [&](Status status) {
    summary.status = status;
    summary.final_cost = current.cost;
    if (system) *system = current;
    return summary;
  };

  double lambda = options.initial_lambda, growth = detail::kFirstGrowth;
  double promise = -1.0;  // Predicted decrease of the first trial of this linearisation; negative before it.
  while (summary.iterations < options.max_iterations) {
    const auto [step, predicted, norm, usable] = detail::damped_step<P>(current, lambda, options.diagonal_floor);
    const bool first = promise < 0.0;
    if (usable) {
      summary.last_step = norm;
      if (first) promise = predicted;
      if (first && norm <= options.step_tolerance) return finish(Status::converged);
    }
    if (lambda > options.max_lambda || (usable && norm <= options.step_tolerance))
      return finish(promise >= 0.0 && promise <= options.stall_tolerance * current.cost ? Status::converged
                                                                                        : Status::diverged);

    ++summary.iterations;
    if (usable) {
      const typename Problem::State trial = problem.retract(state, step);
      const Evaluation e = problem.evaluate(trial);
      if (is_ok(e.status) && is_finite(e.cost) && e.cost < current.cost &&
          e.lost_fraction <= options.max_lost_fraction) {
        const auto next = problem.linearise(trial);
        if (is_ok(detail::check<P>(next, options.rank_tolerance))) {
          const double decrease = current.cost - e.cost;
          const bool flat = decrease <= options.cost_tolerance * current.cost;
          lambda = (std::max)(lambda * detail::damping_factor(decrease, predicted), options.min_lambda);
          growth = detail::kFirstGrowth;
          promise = -1.0;
          summary.reduction += decrease;
          ++summary.accepted;
          state = trial;
          current = next;
          if (flat) return finish(Status::converged);
          continue;
        }
        current = problem.linearise(state);  // The problem has the trial's residuals.
      }
    }
    lambda *= growth;
    growth *= 2.0;
  }
  return finish(Status::iteration_limit);
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_GAUSS_NEWTON_HPP
