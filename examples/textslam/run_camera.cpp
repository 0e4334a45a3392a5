#include "textslam/run_camera.hpp"

#include <algorithm>
#include <cmath>

#include "cli/progress.hpp"
#include "textslam/calibrate/frame_pairs.hpp"

namespace textslam {
namespace {

// Gives the sequence the camera that its images tell, where they do.
SelfCalibration estimate_camera(const RunOptions& options, const std::vector<std::size_t>& frames, Sequence* sequence) {
  Progress progress("calibrating");
  const bool knows_shutter = options.readout && !options.parameters.estimate_readout;
  return take_estimated_camera(
      sequence, frames, options.parameters, knows_shutter,
      [&](std::size_t done, std::size_t total) { progress.show(done, total, "by points alone"); });
}

}  // namespace

// A camera file that knows nothing of rows means the middle one by its time stamps.
void know_rows(const RunOptions& options, CameraModel* camera) {
  textplane::RollingShutter& shutter = camera->shutter;
  if (shutter.rows != camera->height) shutter = all_at_once(camera->height);
  if (options.readout) shutter.readout = *options.readout;
}

std::optional<SelfCalibration> know_camera(const RunOptions& options, const std::vector<std::size_t>& frames,
                                           Sequence* sequence) {
  const bool unknown = options.calibrate == Calibrate::automatic && sequence->camera_origin != CameraOrigin::file;
  if (options.calibrate != Calibrate::always && !unknown) return std::nullopt;
  return estimate_camera(options, frames, sequence);
}

bool know_turns(const RunOptions& options, const std::vector<std::size_t>& frames, Sequence* sequence,
                const CalibrationOptions& calibration) {
  const bool asked = options.parameters.estimate_readout;
  CameraModel& camera = sequence->camera;
  if (!asked && (options.readout || camera.knows_readout)) return false;
  const auto counts = [&](double shear) {
    return asked || shear * camera.pinhole().fx >= calibration.least_shear * camera.width;
  };
  Progress progress("following turns");
  std::optional<TurnReadout> slow;  // what a camera told that turns too slowly to look on
  const auto go_on = [&](const std::vector<FramePair>& pairs, std::size_t total) {
    progress.show(pairs.size() + 1, total, "for the shutter");
    if (asked || static_cast<int>(pairs.size()) != calibration.turn_probe_frames) return true;
    const TurnReadout probed = readout_of_turns(pairs);
    // No readout is longer than the time between frames, so that their turn bounds the shear.
    if (!counts(probed.turn / std::sqrt(12))) slow = probed;
    return !slow;
  };
  const auto most = static_cast<std::size_t>(calibration.turn_frames);
  const std::vector<FramePair> pairs = follow_frames(*sequence, frames, most, options.parameters, go_on);
  const TurnReadout told = slow ? *slow : readout_of_turns(pairs);
  const bool takes = told.determined && counts(told.shear);
  if (takes) camera.shutter.readout = std::clamp(told.readout, -kLongestReadout, kLongestReadout);
  return asked || takes;
}

}  // namespace textslam
