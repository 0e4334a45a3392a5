// lambda_w: the weight of a text object's photometric cost beside reprojection errors in one joint cost.
//
// A point adds rho(|e|^2 / sigma^2), e in px. A text observation adds lambda_w sum rho(r^2): r is the difference of two
// unit-norm patches, of order 1/sqrt(N) (docs/equations.md).
#ifndef TEXTPLANE_SOLVER_WEIGHTING_HPP
#define TEXTPLANE_SOLVER_WEIGHTING_HPP

#include "textplane/config.hpp"
#include "textplane/core/numeric.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// How lambda_w follows from the standard deviations of points and intensities.
enum class Weighting {
  paper,     ///< lambda_w = sigma_rep / sigma_photo, as in the paper: objects of every size count the same.
  variance,  ///< lambda_w = N sigma_rep^2 / sigma_photo^2: r sqrt(N) / sigma_photo has unit variance.
};

/// Whether a standard deviation is in [1e-50, 1e50]: its square, its inverse and the ratio of two are then finite.
inline bool valid_sigma(double sigma) noexcept { return is_finite(sigma) && sigma >= 1e-50 && sigma <= 1e50; }
/// The same of a prior: at least 1e-50. Infinity is no prior.
inline bool valid_prior_sigma(double sigma) noexcept { return sigma >= 1e-50; }

/// lambda_w of an observation with `visible` pixels; zero without pixels and for deviations that are not valid_sigma().
/// `sigma_rep`: standard deviation of a reprojection error, px. `sigma_photo`: of a pixel's residual, in 1/sqrt(N).
inline double text_weight(Weighting weighting, double sigma_rep, double sigma_photo, int visible) noexcept {
  if (!valid_sigma(sigma_rep) || !valid_sigma(sigma_photo) || visible <= 0) return 0;
  const double ratio = sigma_rep / sigma_photo;
  return weighting == Weighting::paper ? ratio : ratio * ratio * visible;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WEIGHTING_HPP
