// Alignment trials: a patch of one photograph found in another from a start that is a few pixels off, by us and by the peers.
#ifndef TEXTPLANE_EXAMPLES_TRIALS_HPP
#define TEXTPLANE_EXAMPLES_TRIALS_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "planar/plane_tracker.hpp"

namespace planar {

/// A photograph, others of the same planar scene, and the true homographies to them (px).
struct PhotoSet {
  std::string first;
  std::vector<std::string> others;
  std::vector<tp::Matrix3<double>> truth;
  bool text =
      true;  ///< Patches are what the built-in detector finds; else, where there is little text, random places with as many corners.
};

/// The five scenes of a folder of scene_NNNN folders, photographed by a camera that stands still. Throws InputError.
std::vector<PhotoSet> read_still_scenes(const std::string& folder);
/// img1.png to img6.png with H1to2p.txt to H1to6p.txt. Throws InputError.
std::vector<PhotoSet> read_oxford(const std::string& folder);

/// One aligner's successes (mean corner error below 1 px) and median time.
struct Score {
  std::string name;
  int successes = 0,
      from_truth = 0;  ///< From the start that is off, and from the truth, which shows how far that can be trusted.
  double milliseconds = 0;
};
struct Trials {
  int count = 0, quads = 0;  ///< Trials, and the different text quads that they were drawn from.
  std::vector<Score> scores;
};

/// `count` trials: a text quad that the built-in detector finds in the first photograph of a set, and another photograph, both at random;
/// the start is a pose whose corners are `offset` px off on average, in a random direction of shift, turn and scale.
Trials run_trials(const std::vector<PhotoSet>& sets, int count, double offset, std::uint64_t seed);

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_TRIALS_HPP
