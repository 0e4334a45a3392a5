// Alignment trials: textplane and its peers align a patch of one photograph with another from a start a few pixels off.
#ifndef TEXTPLANE_EXAMPLES_TRIALS_HPP
#define TEXTPLANE_EXAMPLES_TRIALS_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "planar/photo_sets.hpp"
#include "planar/plane_tracker.hpp"

namespace planar {

/// One aligner's successes (mean corner error below 1 px) and median time.
struct Score {
  std::string name;
  int successes = 0;   ///< From the start that is off.
  int from_truth = 0;  ///< From the truth: failures here are errors of the truth.
  double milliseconds = 0;
};
struct Trials {
  int count = 0, quads = 0;  ///< Trials, and the number of quads that they were drawn from.
  std::vector<Score> scores;
};

/// `count` trials: a text quad that the built-in detector finds in the first photograph of a set, and another
/// photograph, both at random; the start is a pose whose corners are `offset` px off on average, in a random direction
/// of shift, turn and scale.
Trials run_trials(const std::vector<PhotoSet>& sets, int count, double offset, std::uint64_t seed);

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_TRIALS_HPP
