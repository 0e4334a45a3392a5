// Ceres: a Window as a ceres::Problem with the cost and variables of solve_window(), to which you can add residuals of
// your own (odometry, inertial, loops).
//
//   WindowProblem problem(window, options);
//   problem.problem().AddResidualBlock(my_cost, nullptr, problem.pose(3), problem.pose(4));
//   ceres::Solver::Options solver = problem.solver_options();
//   ceres::Solve(solver, &problem.problem(), &summary);
//   problem.write_back();
//
// Poses are blocks of the WindowProblem (T_w_c, PoseOrder::quaternion_translation, under PoseManifold). Points and
// planes are the window's own memory, which Ceres moves in place. Terms that solve_window() leaves out at the start are
// left out; fixed ones are constant. Two differences: a step that takes any observation out of view is rejected, and
// fixed frames alone fix the gauge, WindowOptions::scale_frame_a does not.
//
// Ceres reports half of solve_window()'s cost. Window, patches and images must outlive the WindowProblem.
#ifndef TEXTPLANE_ADAPTERS_CERES_WINDOW_HPP
#define TEXTPLANE_ADAPTERS_CERES_WINDOW_HPP

#include <ceres/loss_function.h>
#include <ceres/ordered_groups.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "ceres.hpp"

#ifndef TEXTPLANE_SINGLE_HEADER
#include "textplane/solver/window_check.hpp"
#include "textplane/solver/window_problem.hpp"
#include "textplane/solver/window_structure.hpp"
#endif

TEXTPLANE_BEGIN_NAMESPACE

namespace adapters {

/// A Window as a ceres::Problem: see the head of this file.
class WindowProblem {
 public:
  /// Window, patches and images must outlive the problem.
  WindowProblem(Window& window, const WindowOptions& options, TextRows rows = TextRows::sums)
      : window_(window), options_(options), problem_(ownership()) {
    text_.photometric = options.photometric;
    text_.weighting = options.weighting;
    text_.sigma_rep = options.sigma_rep;
    text_.sigma_photo = options.sigma_photo;
    text_.rows = rows;
    status_ = textplane::detail::check_window(window, options);
    if (is_ok(status_) && !is_supported(window)) status_ = Status::unsupported;
    if (!is_ok(status_)) return;
    if (options_.point_robust.kind != RobustKind::l2) loss_ = std::make_unique<Loss>(options_.point_robust);
    poses_.resize(window.frames.size());
    for (std::size_t f = 0; f < poses_.size(); ++f) {
      pose_to_block(window.frames[f].T_w_c, poses_[f].data());
      problem_.AddParameterBlock(poses_[f].data(), kPoseSize, &manifold_);
      if (window.frames[f].fixed) problem_.SetParameterBlockConstant(poses_[f].data());
    }
    add_points();
    add_texts();
  }
  WindowProblem(const WindowProblem&) = delete;
  WindowProblem& operator=(const WindowProblem&) = delete;

  /// ok; solve_window()'s status for an invalid window or options; or unsupported where the rows of a frame move, for
  /// rigs, and where the camera is an unknown. The problem is empty where this is not ok.
  Status status() const noexcept { return status_; }
  ceres::Problem& problem() noexcept { return problem_; }  ///< Add your own costs to it.
  /// The block of a frame's pose.
  double* pose(int frame) noexcept { return poses_[static_cast<std::size_t>(frame)].data(); }
  int left_out() const noexcept { return left_out_; }  ///< Observations that were left out.

  /// Tolerances, damping and iteration limit of the WindowOptions; SPARSE_SCHUR, one thread, landmarks eliminated
  /// first. Add your own blocks to group 1 of linear_solver_ordering.
  ceres::Solver::Options solver_options() {
    ceres::Solver::Options out;
    out.linear_solver_type = ceres::SPARSE_SCHUR;
    out.max_num_iterations = options_.max_iterations;
    out.function_tolerance = options_.cost_tolerance;
    out.gradient_tolerance = 0;  // solve_window() has none.
    out.parameter_tolerance = options_.step_tolerance;
    out.initial_trust_region_radius = 1 / options_.initial_lambda;
    out.num_threads = 1;
    out.logging_type = ceres::SILENT;
    out.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (auto& pose : poses_) out.linear_solver_ordering->AddElementToGroup(pose.data(), 1);
    for (double* landmark : landmarks_) out.linear_solver_ordering->AddElementToGroup(landmark, 0);
    return out;
  }

  /// Copies the poses into the window.
  void write_back() {
    for (std::size_t f = 0; f < poses_.size(); ++f)
      if (!window_.frames[f].fixed) window_.frames[f].T_w_c = pose_from_block(poses_[f].data());
  }

 private:
  // One camera that is known, with a shutter that takes all rows at once.
  static bool is_supported(const Window& window) noexcept {
    for (const WindowFrame& frame : window.frames)
      if ((frame.rows && frame.rows->active()) || frame.base != -1 || frame.camera) return false;
    return !window.calibration;
  }

  static ceres::Problem::Options ownership() {
    ceres::Problem::Options out;
#if TEXTPLANE_CERES_HAS_MANIFOLD
    out.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
#else
    out.local_parameterization_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
#endif
    out.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return out;
  }

  // A Robust as Ceres wants it.
  struct Loss final : ceres::LossFunction {
    explicit Loss(const Robust& r) : robust(r) {}
    void Evaluate(double r2, double out[3]) const override {
      out[0] = robust.rho(r2), out[1] = robust.weight(r2), out[2] = robust.curvature(r2);
    }
    Robust robust;
  };

  // Adds the landmark and its costs, unless they are too few.
  template <class Add>
  void add_landmark(double* block, bool fixed, int usable, int least, const Add& add) {
    if (usable == 0 || (!fixed && usable < least)) {
      left_out_ += usable;
      return;
    }
    add();
    landmarks_.push_back(block);
    if (fixed) problem_.SetParameterBlockConstant(block);
  }

  void add_points() {
    std::vector<std::vector<std::size_t>> of(window_.points.size());
    for (std::size_t k = 0; k < window_.point_observations.size(); ++k) {
      const WindowPointObservation& o = window_.point_observations[k];
      const Vector3<double> p = window_.frames[static_cast<std::size_t>(o.frame)].T_w_c.inverse() *
                                window_.points[static_cast<std::size_t>(o.point)].p_w;
      if (p[2] > options_.min_depth && is_finite(o.sigma) && o.sigma > 0 && all_finite(p) && all_finite(o.px))
        of[static_cast<std::size_t>(o.point)].push_back(k);
      else
        ++left_out_;
    }
    for (std::size_t p = 0; p < of.size(); ++p) {
      double* block = window_.points[p].p_w.data();
      add_landmark(block, window_.points[p].fixed, static_cast<int>(of[p].size()), 2, [&] {
        for (std::size_t k : of[p]) {
          const WindowPointObservation& o = window_.point_observations[k];
          problem_.AddResidualBlock(new PointCost<>(window_.camera, o.px, o.sigma, options_.min_depth), loss_.get(),
                                    pose(o.frame), block);
        }
      });
    }
  }

  void add_texts() {
    struct Term {
      PhotometricInput input;
      const WindowTextObservation* observation;
    };
    std::vector<std::vector<Term>> of(window_.texts.size());
    const auto pool = std::make_shared<WorkspacePool>();
    PhotometricWorkspace workspace;
    for (const WindowTextObservation& o : window_.text_observations) {
      const WindowText& t = window_.texts[static_cast<std::size_t>(o.text)];
      const WindowFrame &host = window_.frames[static_cast<std::size_t>(t.host)],
                        &target = window_.frames[static_cast<std::size_t>(o.frame)];
      Status status = Status::invalid_argument;
      Term term{{}, &o};
      if (t.patch && t.host != o.frame && o.weight > 0 && is_finite(o.weight)) {
        term.input = photometric_input(*t.patch, options_.text_level, target.image, window_.camera, o.scale_shift);
        workspace.reserve(term.input.patch.n);
        const SE3d T_t_h = target.T_w_c.inverse() * host.T_w_c;
        status = evaluate(ResidualRequest{term.input, t.theta, T_t_h, options_.photometric}, workspace).status;
      }
      if (is_ok(status))
        of[static_cast<std::size_t>(o.text)].push_back(term);
      else
        ++left_out_;
    }
    for (std::size_t t = 0; t < of.size(); ++t) {
      WindowText& text = window_.texts[t];
      add_landmark(text.theta.data(), text.fixed, static_cast<int>(of[t].size()), 1, [&] {
        for (const Term& term : of[t]) {
          TextCostOptions options = text_;
          options.weight = term.observation->weight;
          problem_.AddResidualBlock(new TextCost<>(term.input, options, pool), nullptr, pose(text.host),
                                    pose(term.observation->frame), text.theta.data());
        }
      });
    }
  }

  Window& window_;
  const WindowOptions options_;
  TextCostOptions text_;
  Status status_ = Status::invalid_argument;
  int left_out_ = 0;
  std::vector<std::array<double, kPoseSize>> poses_;
  std::vector<double*> landmarks_;
  PoseManifold<> manifold_;
  std::unique_ptr<ceres::LossFunction> loss_;
  ceres::Problem problem_;  // Destroyed first: it refers to the members above.
};

}  // namespace adapters

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_ADAPTERS_CERES_WINDOW_HPP
