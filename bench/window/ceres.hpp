// solve_window()'s window solved by Ceres, by adapters/ceres_window.hpp: the same terms, robust costs, gauge, start and
// analytic derivatives, so that only the solvers differ.
//
// A point observation is two residuals under ceres::HuberLoss. A text observation is ten residuals made of the kernel's
// sums (TextRows::sums), which costs Ceres a tenth of the time of a hundred pixels with a row each.
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

/// Adjusts the window in place on one thread, landmarks eliminated first. Every element must be usable, as those of
/// SceneWindow are. Ceres follows the options on robust costs, weights, tolerances, damping and the limit of
/// iterations.
CeresResult solve_with_ceres(tp::Window& window, const tp::WindowOptions& options, CeresSolver solver);

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_WINDOW_CERES_HPP
