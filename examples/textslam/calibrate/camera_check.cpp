#include "textslam/calibrate/camera_check.hpp"

namespace textslam {

std::optional<SelfCalibration> better_camera(const Map& map, const CameraModel& given, const Parameters& parameters,
                                             const CameraCheckOptions& options) {
  const CameraModel start = with_lens(given);
  const MapCalibration found = calibrate(map, start, start, parameters, options.priors);
  if (!found.determined || found.gain < options.least_gain) return std::nullopt;
  SelfCalibration out;
  out.camera = found.camera;
  out.camera.shutter = given.shutter;
  out.sigma = found.sigma;
  out.determined = true;
  out.start = given;
  out.origin = kCameraFile;
  out.frames = map.keyframe_ids().size();
  out.observations = found.observations;
  out.reprojection_px = found.reprojection_px;
  out.passes = 1;
  return out;
}

}  // namespace textslam
