// The pyramid levels that a coarse-to-fine solve walks, and float pyramids.
#ifndef TEXTPLANE_SOLVER_LEVELS_HPP
#define TEXTPLANE_SOLVER_LEVELS_HPP

#include <array>

#include "textplane/photometry/pyramid.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// As PyramidView, for embedders that keep float images: level l + 1 is half as wide and high as level l.
struct PyramidViewF {
  std::array<ImageViewF, kMaxPyramidLevels> level;
  int levels = 0;
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
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_LEVELS_HPP
