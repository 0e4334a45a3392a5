#include "window/ceres.hpp"

#include <ceres/solver.h>

#include "stopwatch.hpp"
#include "textplane/adapters/ceres_window.hpp"

namespace textplane_bench {

CeresResult solve_with_ceres(tp::Window& w, const tp::WindowOptions& o, CeresSolver solver) {
  const Stopwatch building;
  tp::adapters::WindowProblem problem(w, o);
  ceres::Solver::Options options = problem.solver_options();
  if (solver == CeresSolver::dense_schur) options.linear_solver_type = ceres::DENSE_SCHUR;

  CeresResult out;
  out.build_ms = building.ms();
  const Stopwatch solving;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem.problem(), &summary);
  out.solve_ms = solving.ms();
  out.cpu_ms = solving.cpu_ms();
  out.converged = summary.termination_type == ceres::CONVERGENCE;
  out.iterations = static_cast<int>(summary.iterations.size()) - 1;  // The first is the start.
  out.final_cost = 2 * summary.final_cost;                           // Ceres halves squares.
  problem.write_back();
  return out;
}

}  // namespace textplane_bench
