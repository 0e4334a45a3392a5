// The camera of a run: the sequence's, with what the options say of it, or estimated from its images.
#ifndef TEXTSLAM_RUN_CAMERA_HPP
#define TEXTSLAM_RUN_CAMERA_HPP

#include <optional>
#include <vector>

#include "textslam/calibrate/self_calibration.hpp"
#include "textslam/run.hpp"

namespace textslam {

/// Gives the camera its rows and its readout.
void know_rows(const RunOptions& options, CameraModel* camera);

/// Estimates the camera from these frames where the options ask for it, or where there is no camera file. The sequence
/// gets it where the images tell it. Empty: nothing was to be estimated.
std::optional<SelfCalibration> know_camera(const RunOptions& options, const std::vector<std::size_t>& frames,
                                           Sequence* sequence);

/// Where the readout is to be estimated, or nobody said it: gives the camera the one that the turns in these frames
/// tell, if they do; in the second case only one that counts (CalibrationOptions::least_shear). A map that begins
/// without it may be lost, or take its shape from it, before it can tell. Returns whether the map goes on estimating.
bool know_turns(const RunOptions& options, const std::vector<std::size_t>& frames, Sequence* sequence,
                const CalibrationOptions& calibration = {});

}  // namespace textslam

#endif  // TEXTSLAM_RUN_CAMERA_HPP
