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
  std::vector<tp::Vector2<double>> not_text;  ///< px of the first: what the detector finds here is none.
  bool text =
      true;  ///< Patches are what the built-in detector finds; else, where there is little text, random places with as many corners.
};

/// What the truth of a folder of scenes is worth (registration.hpp), px: the mean distance of a match from it, and how far from photograph
/// 0 to j directly is from going by way of another i, at the patches.
struct TruthPrecision {
  double residual = 0, round_trip = 0, largest_round_trip = 0;
};

/// A folder of scene_NNNN folders, each of photographs by a camera that hardly moves. `not_text`: "scene,x,y", scenes counted from 0.
/// Throws InputError.
std::vector<PhotoSet> read_still_scenes(const std::string& folder, const std::vector<std::string>& not_text,
                                        TruthPrecision* precision);
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
