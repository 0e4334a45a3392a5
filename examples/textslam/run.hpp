// A run: a sequence through detector and system into an output folder.
#ifndef TEXTSLAM_RUN_HPP
#define TEXTSLAM_RUN_HPP

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "textslam/common/parameters.hpp"
#include "textslam/detect/text_detector.hpp"
#include "textslam/report/summary.hpp"

namespace textslam {

constexpr double kLongestReadout = 0.2;  // s, either way

/// Whether the camera is estimated from the images first, see calibrate/self_calibration.hpp. automatic: where there is
/// no calibration; one that is there is checked after mapping, see calibrate/camera_check.hpp.
enum class Calibrate { automatic, always, never };

struct RunOptions {
  std::string sequence, output;
  SequenceOptions input;  ///< What the sequence itself does not say.
  Calibrate calibrate = Calibrate::automatic;
  DetectorOptions detector;
  std::shared_ptr<TextDetector> own_detector;  ///< If set, in place of `detector`.
  int first = 0;                               ///< Index of the first frame.
  int last = -1;                               ///< Index of the last frame; -1: the sequence's last.
  int every = 1;                               ///< One frame of so many is used.
  bool skip_broken = false;                    ///< Frames that cannot be read are passed over; else the first ends it.
  std::string save_map;                        ///< The map file that is written; empty: none, or `map` again.
  std::string map;                             ///< The map file of earlier sessions; empty: none.
  std::vector<KnownLength> lengths;            ///< Of signs; they make the map metric.
  bool localise = false;                       ///< Frames are only localised in `map`, which stays as it is.
  Parameters parameters;
  std::optional<double> readout;  ///< s, of a rolling shutter; in place of what the camera file says.
  bool report = true;             ///< Write report.html.
  bool json_lines = false;        ///< An object a frame on standard output (frame_line()), then one with the metrics.
  std::vector<std::string> command;  ///< The command line, for the report.
};

struct RunResult {
  RunSummary summary;
  std::string report;        ///< Path of the report; empty where there is none.
  std::string unmapped;      ///< Empty, or one line: why the map of earlier sessions is as it was.
  std::string error;         ///< Empty, or one line: what ended the run early. What came before is written.
  bool interrupted = false;  ///< By a signal: see io/interrupt.hpp.
};

/// Throws InputError if nothing could be computed, std::runtime_error if the output cannot be written.
RunResult run(const RunOptions& options);

}  // namespace textslam

#endif  // TEXTSLAM_RUN_HPP
