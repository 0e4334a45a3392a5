// A self-calibration as the outputs show it.
#ifndef TEXTSLAM_REPORT_CALIBRATION_HPP
#define TEXTSLAM_REPORT_CALIBRATION_HPP

#include <optional>
#include <string>

#include "textslam/calibrate/self_calibration.hpp"
#include "textslam/report/fields.hpp"

namespace textslam {

/// What was assumed, what estimated, and how sure it is; beside the true camera also how far off it is.
void add_calibration(Fields& fields, const SelfCalibration& calibration, const std::optional<CameraModel>& truth);

/// camera.yaml of the camera, with `Camera.sigma.fx` and so on: the standard deviations of what was estimated.
std::string camera_yaml(const CameraModel& camera, const std::optional<SelfCalibration>& calibration);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_CALIBRATION_HPP
