// Whether a calibration is that of the camera that took the images, by the map that was made with it.
#ifndef TEXTSLAM_CALIBRATE_CAMERA_CHECK_HPP
#define TEXTSLAM_CALIBRATE_CAMERA_CHECK_HPP

#include <optional>

#include "textslam/calibrate/self_calibration.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

struct CameraCheckOptions {
  /// Of a calibration: the focal length is held, as errors of the shutter pass for it; the principal point is known to
  /// half a per cent of the width; what is left of a lens is small. So many key frames and points take less time than
  /// their frames took.
  CalibrationPriors priors = {0, 0.05, 0.005, 0.5, 10.83, 0.01, {300, 150}};
  /// Of the frames that were tracked live with the camera given: where a map with the better one has fewer, that of the
  /// camera given stays.
  double least_live = 0.95;
};

/// The camera that explains the map's points better than `given`, with which the map was made. Empty: there is none, or
/// the map does not tell. `parameters`: at_size().
std::optional<SelfCalibration> better_camera(const Map& map, const CameraModel& given, const Parameters& parameters,
                                             const CameraCheckOptions& options = {});

}  // namespace textslam

#endif  // TEXTSLAM_CALIBRATE_CAMERA_CHECK_HPP
