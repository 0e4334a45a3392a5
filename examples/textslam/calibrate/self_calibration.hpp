// Self-calibration: the camera of a sequence from its images alone.
//
// The sequence is mapped by points with a first guess of the camera, the map gives a better one (map_calibration.hpp),
// and so on until the camera stays. Where nothing is known of it, the guesses are a few angles of view.
#ifndef TEXTSLAM_CALIBRATE_SELF_CALIBRATION_HPP
#define TEXTSLAM_CALIBRATE_SELF_CALIBRATION_HPP

#include <functional>
#include <string>
#include <vector>

#include "io/sequence.hpp"
#include "textslam/calibrate/map_calibration.hpp"

namespace textslam {

struct CalibrationOptions {
  CalibrationPriors priors;
  /// Degrees, horizontal: what is tried in turn where nothing is known, the most likely first.
  std::vector<double> guesses = {60, 85, 45};
  double assumed_focal = 0.5;  ///< Standard deviation of the focal length of these, as a share of it.
  double given_focal = 0.2;    ///< The same of a camera that a file, EXIF data or the user gave.
  int probe_frames = 200;      ///< Mapped with each guess; the best one goes on.
  int most_frames = 900;       ///< Mapped to refine it.
  int passes = 6;              ///< At most, of mapping and calibrating.
  int turn_frames = 400;       ///< At most, of which the turns tell the readout that a map begins with.
  int turn_probe_frames = 60;  ///< After so many it is known whether the camera turns fast enough to look on.
  /// Of the image's width, rms over the rows: what a readout that nobody asked for must move. With less a map without
  /// it tracks as well, and is the one that truths made without it agree with.
  double least_shear = 0.004;
  double converged_px = 0.1;     ///< camera_distance() of two passes that ends them.
  double converged_sigma = 0.1;  ///< So does a focal length that moved by less than this share of its deviation.
  /// Of the frames mapped that must be tracked for a guess to count.
  double least_tracked = 0.3;
};

constexpr const char* kCameraFile = "the camera file";  ///< SelfCalibration::origin of a calibration.

/// What was assumed, and what came of it.
struct SelfCalibration {
  CameraModel camera;         ///< The estimate; the start where `determined` is false.
  std::vector<double> sigma;  ///< Standard deviations in the order of its parameters; 0: it kept its start.
  bool determined = false;
  CameraModel start;             ///< What it began with,
  std::string origin;            ///< and where that came from, for people.
  std::size_t frames = 0;        ///< Mapped in the last pass.
  std::size_t observations = 0;  ///< Of points, that fit the estimate,
  double reprojection_px = 0;    ///< and how well, rms.
  int passes = 0;                ///< Over the frames, after the first guess was found.
};

/// Gives it what a map determined, that was made of so many frames.
void take_over(const MapCalibration& found, std::size_t frames, SelfCalibration* out);

/// `frames` are indices of the sequence's frames, in order. It begins with the sequence's camera. `progress` is called
/// with the frames mapped and how many there are in this pass. Throws InputError for a frame that cannot be read.
SelfCalibration self_calibrate(const Sequence& sequence, const std::vector<std::size_t>& frames,
                               const Parameters& parameters, const CalibrationOptions& options,
                               const std::function<void(std::size_t, std::size_t)>& progress);

/// Gives the sequence the camera that its images tell, where they do. `knows_shutter`: the camera's readout is not to
/// be estimated with it.
SelfCalibration take_estimated_camera(Sequence* sequence, const std::vector<std::size_t>& frames, Parameters parameters,
                                      bool knows_shutter,
                                      const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace textslam

#endif  // TEXTSLAM_CALIBRATE_SELF_CALIBRATION_HPP
