// The window of solve_window() given to Ceres by adapters/ceres_window.hpp: the same terms, robust costs, gauge and start, with
// analytic derivatives, so that solvers are compared and not ways of differentiating.
//
// A point observation is two residuals under ceres::HuberLoss, a text observation ten that have the kernel's own sums
// (TextRows::sums). That costs Ceres a tenth of what a row for each of a hundred pixels would.
#ifndef TEXTPLANE_BENCH_WINDOW_CERES_HPP
#define TEXTPLANE_BENCH_WINDOW_CERES_HPP

#include "textplane/solver/window_problem.hpp"

namespace textplane_bench {

namespace tp = textplane;

enum class CeresSolver { sparse_schur, dense_schur };

struct CeresResult {
  bool converged = false;
  int iterations = 0;  ///< Steps tried.
  double final_cost = 0;
  double build_ms = 0;              ///< Making the ceres::Problem.
  double solve_ms = 0, cpu_ms = 0;  ///< ceres::Solve() alone: elapsed, and of the processor.
};

/// Adjusts the window in place, landmarks eliminated first, on one thread. Every element of it must be usable, as those
/// of SceneWindow are; of the options robust costs, weights, tolerances, damping and the limit of iterations count.
CeresResult solve_with_ceres(tp::Window& window, const tp::WindowOptions& options, CeresSolver solver);

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_WINDOW_CERES_HPP
