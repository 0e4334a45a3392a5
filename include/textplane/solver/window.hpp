// Windowed bundle adjustment: Levenberg-Marquardt over key-frame poses, points and text planes with the Schur
// complement.
//
// window_problem.hpp has the cost, the gauge and the results. Every iteration linearises all terms (window_terms.hpp),
// damps by lambda times the diagonal (Marquardt), eliminates points and planes, and solves the system of the poses, and
// of the camera's parameters where they are unknown, by a block Cholesky factorisation (block_cholesky.hpp). lambda
// follows the gain ratio (Nielsen 1999). The caller fixes the gauge: fixed frames keep every bit, and the distance of
// two frames can be held. The solver finds a missing gauge from the graph of observations and reports it.
//
// Include this header in translation units of one instruction set only: the compiler may keep Eigen's sums of
// fixed-size matrices and members of std::vector as weak symbols outside our ABI namespace.
//
// A trial counts the pixels that its linearisation saw, and charges those that it loses (docs/equations.md). An
// observation that fails in a trial costs as much as uncorrelated patches; one that fails at an accepted state drops
// out with its status.
#ifndef TEXTPLANE_SOLVER_WINDOW_HPP
#define TEXTPLANE_SOLVER_WINDOW_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "textplane/solver/window_check.hpp"
#include "textplane/solver/window_problem.hpp"
#include "textplane/solver/window_schur.hpp"
#include "textplane/solver/window_structure.hpp"
#include "textplane/solver/window_terms.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Memory of solve_window(), to be reused from call to call; for one thread at a time. A call allocates only in its
/// set-up, where its window exceeds every earlier one.
struct WindowWorkspace {
  detail::WindowState current;        ///< The estimate.
  detail::WindowState trial;          ///< The estimate after a step.
  detail::WindowStructure structure;  ///< The unknowns and their couplings.
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
    sum_.status = check_window(w_, o_);
    if (sum_.status != Status::ok) return sum_;
    x_.read(w_);
    if (w_.calibration) {
      const auto parameters = w_.calibration->camera.parameters().size();
      w_.calibration->covariance.setZero(parameters, parameters);
      w_.calibration->status = Status::ok;
    }
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
        if (fresh && predicted <= (std::max)(o_.cost_tolerance * cost_, noise())) return Status::converged;
        fresh = false;
        ++sum_.iterations;
        const double step = move();
        const WindowTrial trial = terms_.evaluate(w_, o_, x_, structure_, y_);
        if (trial.possible && trial.lost_fraction <= o_.max_lost_fraction && trial.cost < cost_) {
          const double decrease = cost_ - trial.cost, before = cost_;
          accept(step);
          if (!is_finite(cost_)) return Status::non_finite;
          if (decrease <= o_.cost_tolerance * before || step <= o_.step_tolerance) return Status::converged;
          const double gain = 2 * (std::min)(decrease / predicted, 1.0) - 1;
          lambda = (std::max)(lambda * (std::max)(1.0 / 3, 1 - gain * gain * gain), 1e-12);
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
        return promised <= (std::max)(kStall * cost_, noise()) ? Status::converged : Status::diverged;
    }
    return Status::iteration_limit;
  }

  // y = x moved by the step. Returns the largest move relative to the scale of its parameter.
  double move() {
    y_.T_w_c = x_.T_w_c;
    y_.landmark = x_.landmark;
    double largest = move_camera();
    for (int c = 0; c < structure_.cameras(); ++c) {
      const Vector6<S> xi = system_.camera_step(c);
      SE3<S>& T = at(y_.T_w_c, at(structure_.frame_of_camera, c));
      T = renormalised(T * se3_exp(xi));
      largest = (std::max)({largest, xi.template head<3>().norm() / length_, xi.template tail<3>().norm()});
    }
    largest = (std::max)(largest, move_velocities());
    if (structure_.scale_a >= 0) restore_scale();
    y_.follow_bases(w_);
    const int points = count(w_.points);
    for (int l = 0; l < structure_.landmarks(); ++l) {
      if (!at(structure_.landmark_free, l)) continue;
      const Vector3<S>& d = system_.landmark_step(l);
      const double size = l < points ? length_ : at(x_.landmark, l).norm();
      at(y_.landmark, l) += d;
      largest = (std::max)(largest, d.norm() / size);
    }
    return largest;
  }

  // The same of the velocities of rows; what a step moves over half the readout counts.
  double move_velocities() {
    y_.rows = x_.rows;
    y_.patch_rows = x_.patch_rows;
    double largest = 0;
    for (int f : structure_.frame_of_velocity) {
      const Vector6<S> step = system_.camera_step(at(structure_.velocity_of_frame, f));
      RowMotion& rows = at(y_.rows, f);
      rows.velocity += step;
      const double time = 0.5 * std::abs(rows.shutter.readout);
      largest =
          (std::max)({largest, time * step.template head<3>().norm() / length_, time * step.template tail<3>().norm()});
    }
    for (int t = 0; t < count(w_.texts); ++t) {
      const int host = at(w_.texts, t).host;
      if (at(structure_.velocity_of_frame, host) >= 0) at(y_.patch_rows, t).velocity = at(y_.rows, host).velocity;
    }
    return largest;
  }

  // The same of the camera's parameters.
  double move_camera() {
    y_.camera = x_.camera;
    y_.camera_possible = true;
    const CalibrationUnknowns& unknowns = structure_.calibration;
    if (unknowns.count() == 0) return 0;
    AnyCamera<double>::Parameters p = x_.camera.parameters();
    double largest = 0;
    for (int i = 0; i < unknowns.count(); ++i) {
      const double step = system_.camera_step(structure_.parameter_block() + i / 6)[i % 6];
      unknowns.move(i, step, &p);
      largest = (std::max)(largest, unknowns.relative(i, step, x_.camera.parameters()));
    }
    y_.camera_possible = is_ok(AnyCamera<double>::make(x_.camera.name(), p, &y_.camera));
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
    std::swap(x_.rows, y_.rows);
    std::swap(x_.patch_rows, y_.patch_rows);
    x_.camera = y_.camera;
    sum_.last_step = step;
    ++sum_.accepted;
    terms_.linearise_texts(w_, o_, x_, structure_);
    cost_ = terms_.accumulate(w_, o_, x_, structure_, system_);
  }

  // Costs below this are rounding errors: 1e-10 sigma an observation, and for texts the kernels' float.
  double noise() const noexcept {
    const int texts = count(w_.text_observations);
    const double rounding = 1e-20 * (count(w_.point_observations) + texts);
    return texts > 0 && !o_.photometric.precise ? (std::max)(rounding, kSinglePrecision * cost_) : rounding;
  }

  void finish() {
    sum_.final_cost = cost_;
    sum_.path = terms_.path();
    x_.write(w_);
    terms_.report(w_, o_, x_, structure_);
    sum_.free_frames = structure_.cameras();
    sum_.free_parameters = structure_.calibration.count();
    for (int l = 0; l < structure_.landmarks(); ++l)
      if (at(structure_.landmark_free, l)) ++(l < count(w_.points) ? sum_.free_points : sum_.free_texts);
    for (auto active : structure_.point_active) sum_.point_observations += active;
    for (auto active : structure_.text_active) sum_.text_observations += active;
    if (o_.covariance && system_.reduce(0)) report_certainty();
  }

  void report_certainty() {
    report_camera();
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
  void report_camera() {
    if (!w_.calibration) return;
    WindowCalibration& out = *w_.calibration;
    const CalibrationUnknowns& unknowns = structure_.calibration;
    for (int b = structure_.parameter_block(); b < structure_.blocks(); ++b)
      if (system_.camera_deficient(b) && is_ok(out.status)) mark(out.status);
    if (!is_ok(out.status)) return;
    for (int i = 0; i < unknowns.count(); ++i) {
      const std::vector<double>& column = system_.covariance_column(structure_.parameter_block() + i / 6, i % 6);
      for (int j = 0; j < unknowns.count(); ++j)
        for (int r = 0; r < out.covariance.rows(); ++r)
          for (int c = 0; c < out.covariance.cols(); ++c)
            out.covariance(r, c) += unknowns.derivative(r, i) * unknowns.derivative(c, j) *
                                    column[static_cast<std::size_t>(6 * structure_.parameter_block() + j)];
    }
    if (!all_finite(out.covariance)) out.covariance.setZero(out.covariance.rows(), out.covariance.cols());
  }
  void mark(Status& status) noexcept {
    status = Status::rank_deficient;
    ++sum_.undetermined;
  }

  // Where no step lowers the cost: converged if the first one predicted a decrease of at most this share.
  static constexpr double kStall = 1e-3;
  // Rounding error of kernels that sum in float, as a share of the cost.
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

/// Adjusts free poses, points and planes of the window in place, and writes the fields marked "out". Statuses: see
/// WindowSummary; unless is_ok(status) or diverged, poses, points and planes stay as they were. Deterministic: the same
/// window gives the same bits, with any workspace. Throws only std::bad_alloc, where it allocates as WindowWorkspace
/// says. Thread-safe for distinct windows and workspaces. S is double, see BasicWindowSchur.
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
