// lambda_w: how much a text object's photometric cost counts against reprojection errors in one joint cost.
//
// Points contribute sum rho(|e|^2 / sigma^2) with e in px, a text observation lambda_w * sum rho(r^2) with r the
// difference of two unit-norm patches, of order 1/sqrt(N) (docs/equations.md).
#ifndef TEXTPLANE_SOLVER_WEIGHTING_HPP
#define TEXTPLANE_SOLVER_WEIGHTING_HPP

#include "textplane/config.hpp"
#include "textplane/core/numeric.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// How lambda_w follows from the standard deviations of points and intensities.
enum class Weighting {
  paper,     ///< lambda_w = sigma_rep / sigma_photo, as the paper prints it; every object counts the same, whatever its
             ///< size.
  variance,  ///< lambda_w = N sigma_rep^2 / sigma_photo^2: r sqrt(N) / sigma_photo has unit variance, so costs are
             ///< chi-square.
};

/// Whether a standard deviation is finite and in [1e-50, 1e50], so that its square, its inverse and the ratio of two
/// are numbers.
inline bool valid_sigma(double sigma) noexcept { return is_finite(sigma) && sigma >= 1e-50 && sigma <= 1e50; }

/// lambda_w of an observation with `visible` pixels. `sigma_rep`: standard deviation of a reprojection error whose own
/// sigma is 1, px. `sigma_photo`: standard deviation of a pixel's residual, in units of 1/sqrt(N). Zero for deviations
/// that are not valid_sigma(), and without pixels.
inline double text_weight(Weighting weighting, double sigma_rep, double sigma_photo, int visible) noexcept {
  if (!valid_sigma(sigma_rep) || !valid_sigma(sigma_photo) || visible <= 0) return 0;
  const double ratio = sigma_rep / sigma_photo;
  return weighting == Weighting::paper ? ratio : ratio * ratio * visible;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WEIGHTING_HPP
