#include "textslam/calibrate/camera_check.hpp"

namespace textslam {

std::optional<SelfCalibration> better_camera(const Map& map, const CameraModel& given, const Parameters& parameters,
                                             const CameraCheckOptions& options) {
  const CameraModel start = with_lens(given);
  const MapCalibration found = calibrate(map, start, start, parameters, options.priors);
  if (!found.determined) return std::nullopt;
  SelfCalibration out;
  take_over(found, map.keyframe_ids().size(), &out);
  out.camera.shutter = given.shutter;
  out.start = given;
  out.origin = kCameraFile;
  out.passes = 1;
  return out;
}

}  // namespace textslam
