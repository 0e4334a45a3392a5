// Normalised intensities: mean and norm of a set of pixels, and the correlation of two sets.
#ifndef TEXTPLANE_PHOTOMETRY_ZNCC_HPP
#define TEXTPLANE_PHOTOMETRY_ZNCC_HPP

#include <cmath>
#include <cstdint>

#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// mean and s = ||I - mean|| = sigma sqrt(n), sigma the population standard deviation, of n intensities. The normalised
/// intensity is (I - mean) / s: zero mean, unit norm.
struct IntensityStats {
  double mean = 0.0;                ///< Of the intensities.
  double s = 0.0;                   ///< Norm of the intensities less their mean.
  int n = 0;                        ///< How many intensities.
  Status status = Status::too_few;  ///< Whether they have contrast enough.
};

/// Statistics of those of the n values whose mask byte is not zero (a null mask: all of them).
///
/// Status::too_few below `min_n` (at least one) values, no_contrast where sigma is at most `min_contrast` or is lost in
/// the rounding of the mean, non_finite where a counted value is, invalid_argument for a negative n or a null pointer
/// with n > 0. mean and s are zero unless the status is ok.
template <class T>
IntensityStats intensity_stats(const T* values, const std::uint8_t* mask, int n, int min_n = 1,
                               double min_contrast = 0.0) noexcept {
  IntensityStats out;
  if (n < 0 || (n > 0 && values == nullptr)) {
    out.status = Status::invalid_argument;
    return out;
  }
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    if (mask && !mask[i]) continue;
    sum += static_cast<double>(values[i]);
    ++out.n;
  }
  if (out.n < 1 || out.n < min_n) return out;
  const double count = out.n, mean = sum / count;
  double squares = 0.0;
  for (int i = 0; i < n; ++i) {
    if (mask && !mask[i]) continue;
    const double d = static_cast<double>(values[i]) - mean;
    squares += d * d;
  }
  if (!is_finite(squares)) {
    out.status = Status::non_finite;
    return out;
  }
  const double sigma = std::sqrt(squares / count);
  if (!(sigma > min_contrast) || !(sigma > 1e-12 * std::abs(mean))) {
    out.status = Status::no_contrast;
    return out;
  }
  out.mean = mean;
  out.s = std::sqrt(squares);
  out.status = Status::ok;
  return out;
}

/// Zero-mean normalised cross-correlation of a and b over the n pixels whose mask byte is not zero (a null mask: all):
/// the sum of the products of their normalised intensities, in [-1, 1] up to rounding. With E the squared distance of
/// the normalised patches it is 1 - E / 2. Zero, with the reason in `status` where asked for, if either side has no
/// intensity_stats().
template <class A, class B>
double zncc(const A* a, const B* b, const std::uint8_t* mask, int n, Status* status = nullptr) noexcept {
  const IntensityStats sa = intensity_stats(a, mask, n), sb = intensity_stats(b, mask, n);
  const Status worst = is_ok(sa.status) ? sb.status : sa.status;
  if (status) *status = worst;
  if (!is_ok(worst)) return 0.0;
  double product = 0.0;
  for (int i = 0; i < n; ++i) {
    if (mask && !mask[i]) continue;
    product += (static_cast<double>(a[i]) - sa.mean) * (static_cast<double>(b[i]) - sb.mean);
  }
  return product / (sa.s * sb.s);
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_ZNCC_HPP
