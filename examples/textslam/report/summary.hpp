// The numbers of a run, for metrics.json, the report and the table on the terminal. A new number is a line in
// summary.cpp; a line in examples/viewer/provenance.js shows it at the top of the report.
#ifndef TEXTSLAM_REPORT_SUMMARY_HPP
#define TEXTSLAM_REPORT_SUMMARY_HPP

#include <optional>
#include <string>
#include <vector>

#include "io/evaluate.hpp"
#include "io/sequence.hpp"
#include "textslam/calibrate/self_calibration.hpp"
#include "textslam/report/evaluate_poses.hpp"
#include "textslam/report/evaluate_text.hpp"
#include "textslam/report/fields.hpp"
#include "textslam/system/system.hpp"
#include "textslam/text/metric_scale.hpp"

namespace textslam {

struct RunSummary {
  std::size_t frames = 0, tracked = 0, tracked_live = 0;
  int first_tracked_live = -1;  ///< Index of the frame at which the map began.
  std::size_t keyframes = 0, points = 0, texts = 0;
  std::vector<LoopRecord> loops;
  std::vector<std::size_t> map_frames;         ///< Of each separate map, that of the outputs first.
  double approximate_fov = 0;                  ///< Degrees, of a guessed camera; 0: it is calibrated.
  double readout = 0;                          ///< s, of a rolling shutter, as known or estimated; 0: all rows at once.
  bool readout_estimated = false;              ///< From the turns of the camera and the map.
  std::optional<SelfCalibration> calibration;  ///< Where the camera was to be estimated.
  std::optional<CameraModel> true_camera;      ///< Where the sequence has it.
  bool has_detections = false;                 ///< The sequence has.
  std::string detector;                        ///< Its name; empty where none ran.
  std::size_t detected = 0;                    ///< Boxes that it found.
  std::size_t broken = 0;                      ///< Frames that could not be read and were passed over.
  std::vector<std::string> notes;              ///< Of the sequence.
  bool has_truth = false;
  TrajectoryEvaluation trajectory, live;
  PoseErrors final_live, filled_in;  ///< Of the final poses of frames that were live ones, and of the others.
  TextEvaluation text;
  std::optional<MetricScale> metric;  ///< Where the widths of signs were known.
  double reprojection_px = 0;         ///< See reprojection_error(), of the map.
  double median_ms = 0;               ///< A frame, detection aside.
  double p99_ms = 0, longest_ms = 0;  ///< Likewise.
  double median_detect_ms = 0;        ///< A frame that the detector saw.
  std::vector<double> latency_ms;     ///< Real time: of each frame, from its arrival to its pose.
};

/// Whether the trajectory was aligned with ground truth.
bool is_aligned(const RunSummary& summary);

/// Final poses, and poses as known live, of the tracked frames.
std::vector<StampedPose> final_trajectory(const System& system);
std::vector<StampedPose> live_trajectory(const System& system);

/// Compares the trajectories with ground truth if the sequence has it; leaves `text` to the caller. `frames`: how many
/// the run was asked to process.
RunSummary summarise(const System& system, const Sequence& sequence, std::size_t frames);

/// The numbers for metrics.json (file), the report (page) and the terminal (table).
Fields describe(const RunSummary& summary);

/// What the user should know beyond the table: lines without their ends.
std::vector<std::string> warnings(const RunSummary& summary);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_SUMMARY_HPP
