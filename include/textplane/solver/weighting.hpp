// lambda_w: how much a text object's photometric cost counts against reprojection errors in one joint cost.
//
// Points contribute sum rho(|e|^2 / sigma^2) with e in px, a text observation lambda_w * sum rho(r^2) with r the
// difference of two unit-norm patches, of order 1/sqrt(N) (docs/equations.md).
#ifndef TEXTPLANE_SOLVER_WEIGHTING_HPP
#define TEXTPLANE_SOLVER_WEIGHTING_HPP

#include "textplane/config.hpp"

TEXTPLANE_BEGIN_NAMESPACE

enum class Weighting {
  paper,     ///< lambda_w = sigma_rep / sigma_photo, as the paper prints it; every object counts the same, whatever its
             ///< size.
  variance,  ///< lambda_w = N sigma_rep^2 / sigma_photo^2: r sqrt(N) / sigma_photo has unit variance, so costs are
             ///< chi-square.
};

/// lambda_w of an observation with `visible` pixels. `sigma_rep`: standard deviation of a reprojection error whose own
/// sigma is 1, px. `sigma_photo`: standard deviation of a pixel's residual, in units of 1/sqrt(N). Zero for arguments
/// that are not positive.
inline double text_weight(Weighting weighting, double sigma_rep, double sigma_photo, int visible) noexcept {
  if (!(sigma_rep > 0) || !(sigma_photo > 0) || visible <= 0) return 0;
  const double ratio = sigma_rep / sigma_photo;
  return weighting == Weighting::paper ? ratio : ratio * ratio * visible;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WEIGHTING_HPP
