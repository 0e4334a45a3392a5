// The camera as an unknown of a window: one model, shared by all frames, whose parameters have priors.
#ifndef TEXTPLANE_SOLVER_WINDOW_CALIBRATION_HPP
#define TEXTPLANE_SOLVER_WINDOW_CALIBRATION_HPP

#include <cmath>

#include "textplane/core/cameras/any_camera.hpp"
#include "textplane/core/status.hpp"
#include "textplane/solver/weighting.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A camera to be estimated. Points decide on it, with the poses and the scene: the window's cost gains
/// sum_i ((p_i - mean_i) / sigma_i)^2 over the parameters p that are free. Rays of at most 90 degrees off the axis
/// count. Texts have no part in it: see WindowTextObservation::status.
struct WindowCalibration {
  static constexpr int kMost = AnyCamera<double>::kMaxParameters;  ///< Parameters of a model.
  /// One row and column for each parameter, without a heap.
  using Covariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMost, kMost>;

  AnyCamera<double> camera;  ///< In: the start. Out: the estimate.
  /// Means of the priors, in the order of camera.parameters(); empty: the start's.
  AnyCamera<double>::Parameters mean;
  /// Their standard deviations, in the same order: px for the first four. 0 holds a parameter; others are
  /// valid_prior_sigma().
  AnyCamera<double>::Parameters sigma;
  /// fx and fy keep the ratio that they start with. fx's sigma is that of both.
  bool one_focal_length = true;

  /// Out: marginal covariance of the parameters under the gauge of the solve; zero where one is held, and where
  /// WindowOptions::covariance is not asked for or it does not exist.
  Covariance covariance;
  /// Out. ok; rank_deficient: the observations leave a combination of the free parameters open, damping alone moved it.
  Status status = Status::ok;

  /// Holds all parameters of the camera.
  TEXTPLANE_DEFERRED
  void hold() { sigma.setZero(camera.parameters().size()); }
};

namespace detail {

/// The free parameters of a WindowCalibration as unknowns, in blocks of six.
class CalibrationUnknowns {
 public:
  using Parameters = AnyCamera<double>::Parameters;

  /// Null: there are none. invalid_argument where the camera is not valid(), sigma or the mean has another length or a
  /// number that is none, or a sigma is out of its domain; then there are none.
  TEXTPLANE_DEFERRED
  Status set(const WindowCalibration* calibration) noexcept {
    count_ = 0;
    if (!calibration) return Status::ok;
    const Parameters start = calibration->camera.parameters(), &sigma = calibration->sigma;
    if (!calibration->camera.valid() || sigma.size() != start.size()) return Status::invalid_argument;
    for (int i = 0; i < sigma.size(); ++i)
      if (sigma[i] != 0 && !valid_prior_sigma(sigma[i])) return Status::invalid_argument;
    mean_ = calibration->mean.size() > 0 ? calibration->mean : start;
    if (mean_.size() != start.size() || !all_finite(mean_)) return Status::invalid_argument;
    ratio_ = calibration->one_focal_length ? start[1] / start[0] : 0;
    for (int i = 0; i < sigma.size(); ++i) {
      if (!(sigma[i] > 0) || (i == 1 && ratio_ > 0)) continue;
      parameter_[count_] = i;
      information_[count_++] = 1 / (sigma[i] * sigma[i]);
    }
    return Status::ok;
  }

  int count() const noexcept { return count_; }             ///< Unknowns.
  int blocks() const noexcept { return (count_ + 5) / 6; }  ///< Of six unknowns, the last one padded.
  double information(int unknown) const noexcept { return information_[unknown]; }  ///< Of the prior.

  /// d parameter / d unknown.
  double derivative(int parameter, int unknown) const noexcept {
    if (parameter == parameter_[unknown]) return 1;
    return parameter == 1 && parameter_[unknown] == 0 ? ratio_ : 0;
  }
  /// How far an unknown is from its prior's mean.
  double offset(int unknown, const Parameters& now) const noexcept {
    return now[parameter_[unknown]] - mean_[parameter_[unknown]];
  }
  /// A step of an unknown against the parameter's scale: the focal length for the first four.
  double relative(int unknown, double step, const Parameters& now) const noexcept {
    return std::abs(parameter_[unknown] < 4 ? step / now[0] : step);
  }
  /// p <- p moved by a step of an unknown.
  void move(int unknown, double step, Parameters* p) const noexcept {
    for (int i = 0; i < p->size(); ++i) (*p)[i] += derivative(i, unknown) * step;
  }
  /// Columns of block b from d pixel / d parameters; zero where the block is padded.
  template <class S>
  FixedMatrix<S, 2, 6> columns(const typename AnyCamera<S>::ParameterJacobian& J, int b) const noexcept {
    FixedMatrix<S, 2, 6> out = FixedMatrix<S, 2, 6>::Zero();
    for (int k = 0; k < 6 && 6 * b + k < count_; ++k)
      for (int r = 0; r < 2; ++r) {
        out(r, k) = J(r, parameter_[6 * b + k]);
        if (parameter_[6 * b + k] == 0 && ratio_ > 0) out(r, k) += ratio_ * J(r, 1);
      }
    return out;
  }

 private:
  int count_ = 0;
  int parameter_[WindowCalibration::kMost] = {};
  double information_[WindowCalibration::kMost] = {};
  Parameters mean_;   // of the priors
  double ratio_ = 0;  // fy / fx where it is kept, else 0
};

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_CALIBRATION_HPP
