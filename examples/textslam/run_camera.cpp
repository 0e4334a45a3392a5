#include "textslam/run_camera.hpp"

#include "cli/progress.hpp"

namespace textslam {
namespace {

// Gives the sequence the camera that its images tell, where they do.
SelfCalibration estimate_camera(const RunOptions& options, const std::vector<std::size_t>& frames, Sequence* sequence) {
  Progress progress("calibrating");
  Parameters parameters = options.parameters;
  // What the shutter of a fast camera does passes for a lens: where neither is known they are found together. The run
  // does not take the readout over: a truth that knows nothing of rows would call it worse (docs/cameras.md).
  const bool given = options.readout && !parameters.estimate_readout;
  parameters.estimate_readout = sequence->camera_origin != CameraOrigin::file && !given;
  SelfCalibration found =
      self_calibrate(*sequence, frames, parameters, CalibrationOptions(),
                     [&](std::size_t done, std::size_t total) { progress.show(done, total, "by points alone"); });
  if (found.determined) {
    found.camera.fps = sequence->camera.fps;
    found.camera.shutter = sequence->camera.shutter;
    sequence->camera = found.camera;
    sequence->approximate_fov = 0;
  }
  return found;
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

}  // namespace textslam
