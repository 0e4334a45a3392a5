// Windowed bundle adjustment: Levenberg-Marquardt over key-frame poses, points and text planes with the Schur
// complement.
//
// window_problem.hpp says what is minimised, what must be fixed, and what comes back. The method: every iteration
// linearises all terms (window_terms.hpp), damps by lambda times the diagonal (Marquardt), eliminates points and
// planes, and solves the cameras' system by a block Cholesky factorisation of our own (block_cholesky.hpp). lambda
// follows the gain ratio (Nielsen 1999). The gauge is the caller's: frames flagged fixed stay constant bit for bit, and
// the distance of two frames can be held; a gauge that is missing is counted from the graph of observations and
// reported, never left to the damping.
//
// No decomposition of Eigen's is instantiated, and products are written out (core/numeric.hpp), but sums of fixed-size
// matrices and std::vector members are, and the compiler may keep them as weak symbols outside of our ABI namespace:
// include this header in translation units of one instruction set only.
//
// A text term is judged on the visible set of its linearisation, lost pixels charged (docs/equations.md). An
// observation that cannot be evaluated in a trial costs what uncorrelated patches would; one that fails at an accepted
// state drops out with its status.
#ifndef TEXTPLANE_SOLVER_WINDOW_HPP
#define TEXTPLANE_SOLVER_WINDOW_HPP

#include <algorithm>
#include <cmath>

#include "textplane/solver/window_problem.hpp"
#include "textplane/solver/window_schur.hpp"
#include "textplane/solver/window_structure.hpp"
#include "textplane/solver/window_terms.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Memory of solve_window(), to be reused from call to call: a call allocates only where its window exceeds every
/// earlier one, and then in its set-up. Not to be shared by two threads at a time.
struct WindowWorkspace {
  detail::WindowState current;        ///< The estimate.
  detail::WindowState trial;          ///< The one that a step leads to.
  detail::WindowStructure structure;  ///< Which unknowns there are and how they meet.
  detail::WindowTerms terms;          ///< The linearised texts.
  detail::WindowSchur system;         ///< The normal equations.
};

namespace detail {

/// S is double, as in BasicWindowSchur.
template <class S>
class WindowSolver {
 public:
  WindowSolver(Window& window, const WindowOptions& options, WindowWorkspace& workspace)
      : w_(window),
        o_(options),
        x_(workspace.current),
        y_(workspace.trial),
        structure_(workspace.structure),
        terms_(workspace.terms),
        system_(workspace.system) {}

  WindowSummary run() {
    sum_.status = WindowStructure::check(w_, o_);
    if (sum_.status != Status::ok) return sum_;
    x_.read(w_);
    terms_.prepare(w_, o_, x_);
    sum_.status = structure_.build(w_, o_);
    sum_.gauge_freedom = structure_.gauge_freedom;
    if (sum_.status != Status::ok) {
      terms_.report(w_, o_, x_, structure_);
      return sum_;
    }
    length_ = terms_.mean_depth(w_, o_, x_, structure_);
    cost_ = sum_.initial_cost = terms_.accumulate(w_, o_, x_, structure_, system_);
    sum_.status = is_finite(cost_) ? iterate() : Status::non_finite;
    finish();
    return sum_;
  }

 private:
  Status iterate() {
    double lambda = o_.initial_lambda, growth = 2, promised = 0;
    bool fresh = true;  // No step has been tried since the last linearisation.
    while (sum_.iterations < o_.max_iterations) {
      if (system_.reduce(lambda) && system_.solve()) {
        const double predicted = system_.predicted_decrease();
        if (fresh) promised = predicted;
        if (fresh && predicted <= std::max(o_.cost_tolerance * cost_, noise())) return Status::converged;
        fresh = false;
        ++sum_.iterations;
        const double step = move();
        const WindowTrial trial = terms_.evaluate(w_, o_, x_, structure_, y_);
        if (trial.possible && trial.lost_fraction <= o_.max_lost_fraction && trial.cost < cost_) {
          const double decrease = cost_ - trial.cost, before = cost_;
          accept(step);
          if (!is_finite(cost_)) return Status::non_finite;
          if (decrease <= o_.cost_tolerance * before || step <= o_.step_tolerance) return Status::converged;
          const double gain = 2 * std::min(decrease / predicted, 1.0) - 1;
          lambda = std::max(lambda * std::max(1.0 / 3, 1 - gain * gain * gain), 1e-12);
          growth = 2;
          fresh = true;
          continue;
        }
        if (step <= o_.step_tolerance) return Status::converged;
      } else {
        ++sum_.iterations;
      }
      lambda *= growth;
      growth *= 2;
      if (!(lambda <= o_.max_lambda))
        return promised <= std::max(kStall * cost_, noise()) ? Status::converged : Status::diverged;
    }
    return Status::iteration_limit;
  }

  // y = x moved by the step of the system. Returns the largest move relative to the scale of its parameter.
  double move() {
    y_.T_w_c = x_.T_w_c;
    y_.landmark = x_.landmark;
    double largest = 0;
    for (int c = 0; c < structure_.cameras(); ++c) {
      const Vector6<S> xi = system_.camera_step(c);
      SE3<S>& T = at(y_.T_w_c, at(structure_.frame_of_camera, c));
      T = renormalised(T * se3_exp(xi));
      largest = std::max({largest, xi.template head<3>().norm() / length_, xi.template tail<3>().norm()});
    }
    if (structure_.scale_a >= 0) restore_scale();
    const int points = count(w_.points);
    for (int l = 0; l < structure_.landmarks(); ++l) {
      if (!at(structure_.landmark_free, l)) continue;
      const Vector3<S>& d = system_.landmark_step(l);
      const double size = l < points ? length_ : at(x_.landmark, l).norm();
      at(y_.landmark, l) += d;
      largest = std::max(largest, d.norm() / size);
    }
    return largest;
  }

  // The linear system holds the distance to first order; this does it exactly.
  void restore_scale() noexcept {
    SE3<S>&a = at(y_.T_w_c, structure_.scale_a), &b = at(y_.T_w_c, structure_.scale_b);
    const Vector3<S> offset = b.t - a.t;
    const double stretch = structure_.scale_distance / offset.norm();
    if (at(structure_.camera_of_frame, structure_.scale_b) >= 0)
      b.t = a.t + stretch * offset;
    else
      a.t = b.t - stretch * offset;
  }

  void accept(double step) {
    std::swap(x_.T_w_c, y_.T_w_c);
    std::swap(x_.landmark, y_.landmark);
    sum_.last_step = step;
    ++sum_.accepted;
    terms_.linearise_texts(w_, o_, x_, structure_);
    cost_ = terms_.accumulate(w_, o_, x_, structure_, system_);
  }

  // Costs below this are rounding: 1e-10 sigma an observation, and of texts the single precision of the kernels.
  double noise() const noexcept {
    const int texts = count(w_.text_observations);
    const double rounding = 1e-20 * (count(w_.point_observations) + texts);
    return texts > 0 && !o_.photometric.precise ? std::max(rounding, kSinglePrecision * cost_) : rounding;
  }

  void finish() {
    sum_.final_cost = cost_;
    sum_.path = terms_.path();
    x_.write(w_);
    terms_.report(w_, o_, x_, structure_);
    sum_.free_frames = structure_.cameras();
    for (int l = 0; l < structure_.landmarks(); ++l)
      if (at(structure_.landmark_free, l)) ++(l < count(w_.points) ? sum_.free_points : sum_.free_texts);
    for (auto active : structure_.point_active) sum_.point_observations += active;
    for (auto active : structure_.text_active) sum_.text_observations += active;
    if (o_.covariance && system_.reduce(0)) report_certainty();
  }

  void report_certainty() {
    for (int c = 0; c < structure_.cameras(); ++c)
      if (system_.camera_deficient(c)) mark(at(w_.frames, at(structure_.frame_of_camera, c)).status);
    const int points = count(w_.points);
    for (int l = 0; l < structure_.landmarks(); ++l) {
      if (!at(structure_.landmark_free, l)) continue;
      if (system_.landmark_deficient(l)) mark(l < points ? at(w_.points, l).status : at(w_.texts, l - points).status);
      if (l < points) continue;
      WindowText& t = at(w_.texts, l - points);
      t.information = system_.information(l);
      if (t.status != Status::ok) continue;
      t.covariance = system_.covariance(l);
      if (!all_finite(t.covariance)) t.covariance.setZero();
    }
  }
  void mark(Status& status) noexcept {
    status = Status::rank_deficient;
    ++sum_.undetermined;
  }

  // Where no step lowers the cost: converged if the first one promised at most this share of it.
  static constexpr double kStall = 1e-3;
  // Share of the cost that rounding makes in kernels that sum in float.
  static constexpr double kSinglePrecision = 1e-7;

  Window& w_;
  const WindowOptions& o_;
  WindowState &x_, &y_;
  WindowStructure& structure_;
  BasicWindowTerms<S>& terms_;
  BasicWindowSchur<S>& system_;
  WindowSummary sum_;
  double cost_ = 0, length_ = 1;
};

}  // namespace detail

/// Adjusts the window in place: free poses, points and planes move, and the fields marked "out" are written. See
/// WindowSummary for the statuses; unless is_ok(status) or diverged, poses, points and planes are as they were.
/// Deterministic: the same window gives the same bits, whatever the workspace held before. Allocates as WindowWorkspace
/// says (and throws std::bad_alloc like any container); never throws otherwise. One thread; calls on different windows
/// and workspaces may run at the same time. (S is double: a template, so that including the header costs little.)
template <class S = double>
WindowSummary solve_window(Window& window, const WindowOptions& options, WindowWorkspace& workspace) {
  return detail::WindowSolver<S>(window, options, workspace).run();
}
/// \overload
template <class S = double>
WindowSummary solve_window(Window& window, const WindowOptions& options = {}) {
  WindowWorkspace workspace;
  return solve_window<S>(window, options, workspace);
}

TEXTPLANE_INSTANCE(WindowSummary solve_window<double>(Window&, const WindowOptions&, WindowWorkspace&));
TEXTPLANE_INSTANCE(WindowSummary solve_window<double>(Window&, const WindowOptions&));

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_HPP
