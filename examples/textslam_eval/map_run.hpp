// Poses localised in a map, judged in the map's own frame: they are not aligned to the truth by themselves, but as the
// run that made the map was.
#ifndef TEXTSLAM_EVAL_MAP_RUN_HPP
#define TEXTSLAM_EVAL_MAP_RUN_HPP

#include <string>
#include <vector>

#include "io/evaluate.hpp"

namespace textslam {

/// A pose is wrong where it is off by more than this share of the depth of the nearest sign within 45 degrees before
/// the camera, or by more than these degrees.
constexpr double kWrongShare = 0.05, kWrongDegrees = 2;

struct LocalisedEvaluation {
  std::string run;
  std::size_t frames = 0;     ///< Of the sequence.
  std::size_t localised = 0;  ///< Frames with a pose.
  int first = -1;             ///< The first of these, from 0; -1: none.
  std::size_t judged = 0;     ///< With a true pose.
  std::size_t wrong = 0;
  ErrorStatistics position;  ///< In the unit of the truth.
  ErrorStatistics rotation;  ///< Degrees.
};

/// `run`: the output folder of `textslam --map`; `truth`: its folder, empty: `sequence` in that of the run. `map_run`:
/// the output folder of the run that made the map, with its truth in `sequence`. Both truths are in one world. Throws
/// InputError for what is missing or broken, or where the map's run cannot be aligned.
LocalisedEvaluation evaluate_localised(const std::string& run, const std::string& truth, const std::string& map_run);

/// A JSON object on one line.
std::string format_localised(const LocalisedEvaluation& evaluation);

}  // namespace textslam

#endif  // TEXTSLAM_EVAL_MAP_RUN_HPP
