// Options that residuals and solvers share.
#include "core/core.hpp"
#include "textplane/photometry/residual_request.hpp"
#include "textplane/solver/pose_terms.hpp"

namespace binding {
namespace of_options {

void bind_enums(py::module_& m) {
  py::enum_<tp::Normalisation>(m, "Normalisation", "How derivatives treat mean and norm of the target's intensities.")
      .value("exact", tp::Normalisation::exact)
      .value("frozen", tp::Normalisation::frozen);
  py::enum_<tp::LinearisePolicy>(m, "LinearisePolicy", "Whose gradients the derivatives use: docs/policy.md.")
      .value("forward", tp::LinearisePolicy::forward)
      .value("template_jacobian", tp::LinearisePolicy::template_jacobian)
      .value("esm", tp::LinearisePolicy::esm)
      .value("hybrid", tp::LinearisePolicy::hybrid)
      .value("automatic", tp::LinearisePolicy::automatic);
  py::enum_<tp::RobustKind>(m, "RobustKind", "A robust cost.")
      .value("l2", tp::RobustKind::l2)
      .value("huber", tp::RobustKind::huber)
      .value("cauchy", tp::RobustKind::cauchy)
      .value("tukey", tp::RobustKind::tukey);
  py::enum_<tp::Weighting>(m, "Weighting", "How texts weigh against points.")
      .value("paper", tp::Weighting::paper)
      .value("variance", tp::Weighting::variance);
}

void bind_solve_options(py::module_& m) {
  using O = tp::SolveOptions;
  auto o = options_class<O>(m, "SolveOptions", "When a solver stops and how it damps.");
  option(o, "max_iterations", &O::max_iterations, "int: Trial steps, rejected ones included.");
  option(o, "step_tolerance", &O::step_tolerance, "float: Converged at a step of this norm.");
  option(o, "cost_tolerance", &O::cost_tolerance, "float: Converged where a step lowers the cost by this share of it.");
  option(o, "stall_tolerance", &O::stall_tolerance, "float: Predicted decrease of a stall that counts as converged.");
  option(o, "initial_lambda", &O::initial_lambda, "float: First damping, a multiple of the diagonal of H.");
  option(o, "min_lambda", &O::min_lambda, "float: Smallest damping.");
  option(o, "max_lambda", &O::max_lambda, "float: Damping above this counts as a stall.");
  option(o, "diagonal_floor", &O::diagonal_floor, "float: Least share of the largest entry of the diagonal.");
  option(o, "rank_tolerance", &O::rank_tolerance, "float: Share of its diagonal entry at which a pivot is zero.");
  option(o, "max_lost_fraction", &O::max_lost_fraction, "float: Share of lost residuals that rejects a trial.");
}

void bind(py::module_& m) {
  bind_enums(m);
  auto robust = options_class<tp::Robust>(m, "Robust", "A robust cost of a residual.");
  option(robust, "kind", &tp::Robust::kind, "RobustKind: Which cost.");
  option(robust, "delta", &tp::Robust::delta, "float: Where it leaves the quadratic, in the unit of the residual.");
  using O = tp::PhotometricOptions;
  auto o = options_class<O>(m, "PhotometricOptions", "Settings of the photometric residual.");
  option(o, "normalisation", &O::normalisation, "Normalisation: Of the derivatives.");
  option(o, "robust", &O::robust, "Robust: On r sqrt(N): its delta is in units of 1/sqrt(N).");
  option(o, "min_visible", &O::min_visible, "int: Fewer visible pixels are Status.too_few.");
  option(o, "min_contrast", &O::min_contrast, "float: Least standard deviation of either side, grey levels.");
  option(o, "precise", &O::precise, "bool: All in double, by the slow reference.");
  bind_solve_options(m);
}

}  // namespace of_options
}  // namespace binding
