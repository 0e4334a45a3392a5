// The pyramid levels that a coarse-to-fine solve walks, and float pyramids.
#ifndef TEXTPLANE_SOLVER_LEVELS_HPP
#define TEXTPLANE_SOLVER_LEVELS_HPP

#include <algorithm>
#include <array>

#include "textplane/photometry/pyramid.hpp"
#include "textplane/solver/gauss_newton.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// As PyramidView, for embedders that keep float images: level l + 1 is half as wide and high as level l.
struct PyramidViewF {
  std::array<ImageViewF, kMaxPyramidLevels> level;  ///< Finest first; each half the size of the one before.
  int levels = 0;                                   ///< How many of them there are.
};

namespace detail {
struct LevelRange {
  int coarsest = -1, finest = 0;  // Walked downwards; empty where coarsest < finest.
};

// [finest, coarsest] cut to what images and patches have: levels [0, available).
inline LevelRange level_range(int coarsest, int finest, int available) noexcept {
  if (available > kMaxPyramidLevels) available = kMaxPyramidLevels;
  return {coarsest < available ? coarsest : available - 1, finest > 0 ? finest : 0};
}

// Options of a level above the finest: its result is but the start of the next level, whose pixels say more.
inline SolveOptions coarse_options(SolveOptions options) noexcept {
  options.cost_tolerance = std::max(options.cost_tolerance, 1e-3);
  options.step_tolerance = std::max(options.step_tolerance, 1e-5);
  return options;
}
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_LEVELS_HPP
