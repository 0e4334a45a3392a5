// The pyramid levels of a coarse-to-fine solve, and float pyramids.
#ifndef TEXTPLANE_SOLVER_LEVELS_HPP
#define TEXTPLANE_SOLVER_LEVELS_HPP

#include <algorithm>
#include <array>

#include "textplane/photometry/pyramid.hpp"
#include "textplane/solver/gauss_newton.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A PyramidView of float images.
struct PyramidViewF {
  std::array<ImageViewF, kMaxPyramidLevels> level;  ///< Finest first; each is half as wide and high as the one before.
  int levels = 0;                                   ///< Number of levels.
};

namespace detail {
struct LevelRange {
  int coarsest = -1, finest = 0;  // Empty where coarsest < finest.
};

// [finest, coarsest] within the levels [0, available) that images and patches have.
inline LevelRange level_range(int coarsest, int finest, int available) noexcept {
  if (available > kMaxPyramidLevels) available = kMaxPyramidLevels;
  return {coarsest < available ? coarsest : available - 1, finest > 0 ? finest : 0};
}

// Options of a coarse level: its result is only the start of the next one.
inline SolveOptions coarse_options(SolveOptions options) noexcept {
  options.cost_tolerance = (std::max)(options.cost_tolerance, 1e-3);
  options.step_tolerance = (std::max)(options.step_tolerance, 1e-5);
  return options;
}

// Minimises coarse to fine. *system: of the finest level. Iterations, status, cost and path go to *fit.
template <class Problem, class System, class Fit>
void minimise_levels(Problem& problem, typename Problem::State& state, LevelRange range, const SolveOptions& options,
                     System* system, Fit* fit) noexcept {
  for (int level = range.coarsest; level >= range.finest; --level) {
    problem.set_level(level);
    *system = System();
    const SolveOptions solve = level == range.finest ? options : coarse_options(options);
    const SolveSummary summary = minimise(problem, state, solve, system);
    fit->iterations += summary.iterations;
    fit->status = summary.status;
    fit->cost = summary.final_cost;
  }
  fit->path = problem.path();
}
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_LEVELS_HPP
