// A run of textslam, or of any system that writes its files, against the truth.
//
//   run     trajectory.txt; trajectory_live.txt, text_map.json and metrics.json where they exist
//   truth   groundtruth.txt; images.txt and truth/ where they exist: what the renderer writes, images aside
#ifndef TEXTSLAM_EVAL_EVALUATE_RUN_HPP
#define TEXTSLAM_EVAL_EVALUATE_RUN_HPP

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "io/evaluate.hpp"
#include "io/evaluate_signs.hpp"

namespace textslam {

struct RunEvaluation {
  std::string run;         ///< Its folder, as given.
  std::size_t frames = 0;  ///< That the run was to process; 0: neither metrics.json nor images.txt says.
  std::size_t poses = 0;   ///< Of trajectory.txt.
  TrajectoryEvaluation trajectory;
  bool has_live = false;
  TrajectoryEvaluation live;
  TextEvaluation
      text;  ///< Available where the truth has signs, the run a text map, and the trajectory could be aligned.
  int words_right = 0;  ///< Of the matched texts.
};

/// `truth`: its folder; empty: the folder `sequence` of the run, where `textslam --render` puts it. Throws InputError, with
/// file and line, for what is missing or broken.
RunEvaluation evaluate_run(const std::string& run, const std::string& truth, bool with_scale);

/// Upper ends of the histogram's bins of angles in degrees, the last without one.
constexpr std::array<double, 7> kAngleBins = {0.25, 0.5, 1, 2, 5, 10, 180};
/// How many of the matched texts fall in each bin: above the end of the bin before, and not above its own.
std::array<int, kAngleBins.size()> angle_histogram(const TextEvaluation& text);

}  // namespace textslam

#endif  // TEXTSLAM_EVAL_EVALUATE_RUN_HPP
