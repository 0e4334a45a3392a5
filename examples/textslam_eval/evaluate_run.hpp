// A run of textslam, or of any system that writes its files, against the truth.
//
//   run     trajectory.txt; if present trajectory_live.txt, text_map.json and metrics.json
//   truth   groundtruth.txt; if present images.txt and truth/, as the renderer writes them; no image is read
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
  std::size_t frames = 0;  ///< That the run was asked to process; 0: unknown.
  std::size_t poses = 0;   ///< In trajectory.txt.
  TrajectoryEvaluation trajectory;
  bool has_live = false;
  TrajectoryEvaluation live;
  TextEvaluation
      text;  ///< Available if the truth has signs, the run has a text map, and the trajectory could be aligned.
  int words_right = 0;  ///< Of the matched texts.
};

/// `truth`: its folder; empty: the run's folder `sequence`, as `textslam --render` writes it. Throws InputError with
/// file and line for what is missing or broken.
RunEvaluation evaluate_run(const std::string& run, const std::string& truth, bool with_scale);

/// Upper ends of the histogram's bins, degrees. The last bin holds all larger angles.
constexpr std::array<double, 7> kAngleBins = {0.25, 0.5, 1, 2, 5, 10, 180};
/// The number of matched texts in each bin.
std::array<int, kAngleBins.size()> angle_histogram(const TextEvaluation& text);

}  // namespace textslam

#endif  // TEXTSLAM_EVAL_EVALUATE_RUN_HPP
