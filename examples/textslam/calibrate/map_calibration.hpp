// Calibration from a map: its key frames, its points and the camera are adjusted together.
//
// The focal length comes first, unless it is known, then one and two coefficients of the lens, and the principal point
// last. What the data do not determine, or what is not farther from the guess than chance puts it, keeps the guess.
#ifndef TEXTSLAM_CALIBRATE_MAP_CALIBRATION_HPP
#define TEXTSLAM_CALIBRATE_MAP_CALIBRATION_HPP

#include <vector>

#include "io/camera_model.hpp"
#include "textslam/calibrate/calibration_window.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// What is known of a camera before the images are looked at, and how a parameter is accepted.
struct CalibrationPriors {
  /// Standard deviation of the focal length, as a share of it. 0: it is known, and held. Else a camera whose focal
  /// length the images do not tell is not determined.
  double focal = 0.5;
  double lens = 0.5;        ///< Of a coefficient of the lens.
  double principal = 0.01;  ///< Of cx and cy, as a share of the image's width.
  /// A parameter is determined where its standard deviation is below this share of its prior's.
  double determined = 0.5;
  /// Square of a parameter's distance from the guess, in variances: 99.9 % of chi-square with 1 degree of freedom.
  double significant = 10.83;
  /// CalibrationWindow::gain() over the camera that the map was made with: with less nothing is determined. 0: any will
  /// do.
  double least_gain = 0;
  CalibrationExtent extent;
};

struct MapCalibration {
  CameraModel camera;
  std::vector<double> sigma;     ///< Standard deviations in the order of the camera's parameters; 0: it kept the guess.
  std::size_t observations = 0;  ///< That fit in the end.
  double reprojection_px = 0;    ///< Of these, rms.
  bool determined = false;       ///< Something is, the focal length too; else `camera` is the one given.
};

/// The largest distance over the image, px, between the pixels that two cameras give the same ray, after the rotation
/// that brings the rays together best: a camera in a map may be turned. Infinite where a ray is out of one's domain.
double camera_distance(const CameraModel& a, const CameraModel& b);

/// The camera with a lens model that calibration can fill: a pinhole becomes radial-tangential without distortion.
CameraModel with_lens(const CameraModel& camera);

/// From a map that was made with `camera`, of whose shutter the map may know better. Priors are about `guess`, of the
/// same model. The map stays as it is.
MapCalibration calibrate(const Map& map, const CameraModel& camera, const CameraModel& guess,
                         const Parameters& parameters, const CalibrationPriors& priors);

}  // namespace textslam

#endif  // TEXTSLAM_CALIBRATE_MAP_CALIBRATION_HPP
