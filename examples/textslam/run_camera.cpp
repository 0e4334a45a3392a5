#include "textslam/run_camera.hpp"

#include <algorithm>

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

void know_turns(const RunOptions& options, const std::vector<std::size_t>& frames, Sequence* sequence) {
  if (!options.parameters.estimate_readout) return;
  Progress progress("following turns");
  const auto most = static_cast<std::size_t>(CalibrationOptions().turn_frames);
  const TurnReadout told = readout_of_turns(
      follow_frames(*sequence, frames, most, options.parameters,
                    [&](std::size_t done, std::size_t total) { progress.show(done, total, "for the shutter"); }));
  if (told.determined) sequence->camera.shutter.readout = std::clamp(told.readout, -kLongestReadout, kLongestReadout);
}

}  // namespace textslam
