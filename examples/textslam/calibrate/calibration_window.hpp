// A map's key frames and points as a window that its camera can be a part of, and what the window tells of the camera.
#ifndef TEXTSLAM_CALIBRATE_CALIBRATION_WINDOW_HPP
#define TEXTSLAM_CALIBRATE_CALIBRATION_WINDOW_HPP

#include <memory>
#include <utility>
#include <vector>

#include "textplane/solver/window.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// How much of a map counts; 0: all of it.
struct CalibrationExtent {
  std::size_t keyframes = 0;     ///< The first ones.
  std::size_t observations = 0;  ///< Of a key frame, in the mean: where there are more, points are left out evenly.
};

/// The camera without the observations of one part of the sequence.
struct LeftOut {
  int part;
  textplane::AnyCamera<double> camera;
};

/// Key frames in the order of time: the first is the fixed one. The map is not needed after construction.
class CalibrationWindow {
 public:
  CalibrationWindow(const Map& map, const Parameters& parameters, const CalibrationExtent& extent);

  /// Solves for the parameters whose sigma is not zero. The window keeps the result where it is one.
  bool solve(textplane::WindowCalibration* calibration);
  /// Variance of an observation's error, in units of its sigma, from the residuals and what they had to fit.
  double variance() const;
  /// Variances of the parameters by the covariance, which takes all errors as independent.
  std::vector<double> variances(const textplane::WindowCalibration& solved) const;
  /// Solves without one part of the sequence after another. A part without which there is no camera is not in it.
  std::vector<LeftOut> leave_out(const textplane::WindowCalibration& solved) const;
  /// Variances by a jackknife over these: shutter and blur move all points of a frame alike.
  static std::vector<double> jackknife(const textplane::WindowCalibration& solved, const std::vector<LeftOut>& parts);
  /// The share by which calibration lowers the Huber cost, by cross-validation: each part of the sequence by itself,
  /// with the camera that the others tell and with `held`; the median of the parts. Errors that look like a lens in one
  /// part only do not lower it, and a part that came apart does not decide. Zero where no part can tell.
  double gain(const std::vector<LeftOut>& parts, const textplane::AnyCamera<double>& held) const;
  /// Removes observations by their last errors.
  void remove_outliers();
  /// Observations that fit, and the rms of their errors, px.
  std::pair<std::size_t, double> fit() const;

 private:
  void add_points(const Map& map, const std::vector<int>& ids, const std::vector<int>& slot, double sigma,
                  std::size_t most_observations);
  int part_of(int frame) const;
  // Frames and observations of one part; points that it sees often enough.
  textplane::Window only(int part) const;

  textplane::Window window_;
  std::vector<std::shared_ptr<const textplane::RowMotion>> rows_;  // of its frames
  textplane::WindowOptions options_;
};

}  // namespace textslam

#endif  // TEXTSLAM_CALIBRATE_CALIBRATION_WINDOW_HPP
