// The output folder: trajectories, text map, timings and metrics, each file whole or absent.
//
//   trajectory.txt       TUM, camera to world, final poses
//   trajectory_live.txt  each pose as known when its frame was processed, in a world that stays (System::live_world())
//   keyframes.txt        TUM, final poses of the key frames
//   text_map.json        {"texts":[{"id","text","corners","normal","theta","host","observations","zncc"}]}, world frame
//   text_map.ply         text quads as faces, points, colours
//   text_index.json      the texts by their words, for textslam-map, see text_index.hpp
//   timing.json          milliseconds by stage; differs between two equal runs
//   metrics.json         counts; errors where ground truth exists
//   report.html          all of it to look at, see report.hpp; its block `run` differs between two equal runs
//
// Where parts of a sequence were mapped apart and never joined, the outputs are those of the map with most frames, and the
// frames of the others count as lost; metrics.json says so.
#ifndef TEXTSLAM_REPORT_OUTPUTS_HPP
#define TEXTSLAM_REPORT_OUTPUTS_HPP

#include <functional>
#include <string>
#include <vector>

#include "io/evaluate.hpp"
#include "io/sequence.hpp"
#include "textslam/report/evaluate_text.hpp"
#include "textslam/system.hpp"

namespace textslam {

/// The numbers of the closing table.
struct RunSummary {
  std::size_t frames = 0, tracked = 0, tracked_live = 0;
  int first_tracked_live = -1;  ///< Index of the frame at which the map began.
  std::size_t keyframes = 0, points = 0, texts = 0;
  std::vector<LoopRecord> loops;
  std::vector<std::size_t>
      map_frames;               ///< Of each map, that of the outputs first; more than one: they were never joined.
  double approximate_fov = 0;   ///< Degrees, of a camera without calibration; 0: it is calibrated.
  bool has_detections = false;  ///< The sequence has.
  bool has_truth = false;
  TrajectoryEvaluation trajectory, live;
  TextEvaluation text;
  double median_ms = 0;            ///< A frame, detection aside.
  std::vector<double> latency_ms;  ///< Real time: of each frame, from when it came to when its pose was known.
};

/// Final poses, and poses as known live, of the tracked frames.
std::vector<StampedPose> final_trajectory(const System& system);
std::vector<StampedPose> live_trajectory(const System& system);

/// Compares the trajectories with ground truth where the sequence has it; `text` is left to the caller. `frames`: how many
/// the run was to process.
RunSummary summarise(const System& system, const Sequence& sequence, std::size_t frames);

/// The text of metrics.json.
std::string metrics_json(const RunSummary& summary);

/// Writes every file but the report into `folder`, which exists. Where one cannot be written, the others are, and then the first error is
/// thrown: std::runtime_error.
/// `image`: the file of a frame that was processed, in the sequence's folder, by its index.
void write_outputs(const std::string& folder, const System& system, const RunSummary& summary,
                   const std::function<std::string(int)>& image);

/// The table for the terminal.
std::string format_summary(const RunSummary& summary);

/// What the user should know beyond the table, lines without their ends; empty where all is well.
std::vector<std::string> warnings(const RunSummary& summary);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_OUTPUTS_HPP
