// What linearise(), evaluate() and residuals() answer.
#ifndef TEXTPLANE_PHOTOMETRY_RESIDUAL_RESULT_HPP
#define TEXTPLANE_PHOTOMETRY_RESIDUAL_RESULT_HPP

#include <cstdint>

#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// What computed a result. A solver reports the greater of all its evaluations.
enum class Path : std::uint8_t {
  kernel,     ///< The SIMD kernels; also where a bad argument was found before anything was computed.
  reference,  ///< The slow double reference: float images, PhotometricOptions::precise, numbers beyond float.
};

namespace detail {
struct Unset {};

// E of a sum of squares: what rounding adds does not lead out of [0, 4].
inline double range_error(double sum) noexcept { return sum < 0.0 ? 0.0 : sum > 4.0 ? 4.0 : sum; }
}  // namespace detail

/// What comes with normal equations. All zero unless is_ok(status).
struct ResidualStats {
  double cost = 0.0;                         ///< Sum of rho(N r^2) / N.
  double error = 0.0;                        ///< E = sum of r^2, in [0, 4].
  double zncc = 0.0;                         ///< 1 - E / 2, in [-1, 1].
  int visible = 0;                           ///< N.
  double mean = 0.0;                         ///< Of the target intensities of the visible pixels.
  double s = 0.0;                            ///< ||I - mean|| of the same.
  Status status = Status::invalid_argument;  ///< Whether the sums can be used.
  Path path = Path::kernel;                  ///< What computed them.
};

/// Sums over the visible pixels for P parameters: with residuals r = I~_host - I~_target, their derivatives J (N x P),
/// and the robust weights W, H = J^T W J and b = J^T W r. The Gauss-Newton step is -H^-1 b. All zero unless
/// is_ok(status).
template <int P>
struct NormalEquations : ResidualStats {
  FixedMatrix<double, P, P> H;    ///< J^T W J.
  Eigen::Matrix<double, P, 1> b;  ///< J^T W r.

  NormalEquations() noexcept { clear(); }
  /// Leaves H and b as they are in memory, for callers that fill them at once: zeroing both takes as long as some
  /// kernels.
  explicit NormalEquations(detail::Unset) noexcept {}
  /// H and b become zero.
  void clear() noexcept {
    H.setZero();
    b.setZero();
  }
};

/// Value of the photometric cost. All zero unless is_ok(status), `visible` and `lost` excepted.
struct PhotometricCost {
  double cost = 0.0;   ///< Sum of rho(N r^2) / N over the visible pixels, plus the charge for the lost ones.
  double error = 0.0;  ///< E = sum of r^2 over the visible pixels, in [0, 4].
  double zncc = 0.0;   ///< 1 - E / 2, in [-1, 1].
  int visible = 0;     ///< N.
  int lost = 0;        ///< Pixels of the given set that are not visible now.
  Status status = Status::invalid_argument;  ///< Whether the cost can be used.
  Path path = Path::kernel;                  ///< What computed it.
};

/// What residuals() found out besides the residuals.
struct ResidualSummary {
  int visible = 0;                           ///< N.
  double mean = 0.0;                         ///< Of the target intensities of the visible pixels.
  double s = 0.0;                            ///< ||I - mean|| of the same.
  Status status = Status::invalid_argument;  ///< Whether the residuals can be used.
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_RESULT_HPP
