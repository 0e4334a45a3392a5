// fit_lens(): a lens near one patch, as the kernels take it (simd/lens.hpp).
#ifndef TEXTPLANE_PHOTOMETRY_LENS_LENS_FIT_HPP
#define TEXTPLANE_PHOTOMETRY_LENS_LENS_FIT_HPP

#include <algorithm>

#include "textplane/core/cameras/lens_map.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/photometry/photometric_input.hpp"
#include "textplane/simd/lens.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {

/// The rays under which a target sees a patch: the box around them, and the ray of its middle.
struct RayBox {
  Vector2<double> middle = {0, 0}, low = {0, 0}, high = {0, 0};

  /// Least and largest r^2 of the box.
  double least_r2() const noexcept {
    const double x = low[0] > 0    ? low[0]
                     : high[0] < 0 ? high[0]
                                   : 0,
                 y = low[1] > 0    ? low[1]
                     : high[1] < 0 ? high[1]
                                   : 0;
    return x * x + y * y;
  }
  double most_r2() const noexcept {
    const double x = (std::max)(-low[0], high[0]), y = (std::max)(-low[1], high[1]);
    return x * x + y * y;
  }
  void add(const RayBox& other) noexcept {
    for (int k = 0; k < 2; ++k) {
      low[k] = (std::min)(low[k], other.low[k]);
      high[k] = (std::max)(high[k], other.high[k]);
    }
  }
};

/// Of the box of a patch, and a pixel more on each side, seen through H. False where a corner is behind, or the box is
/// not known.
TEXTPLANE_DEFERRED
inline bool ray_box(const simd::PointBounds& bounds, const Pinhole<double>& host, const FixedMatrix<double, 3, 3>& H,
                    RayBox* out) noexcept {
  if (bounds.n < 1) return false;
  const Vector3<double> low =
      host.unproject({static_cast<double>(bounds.x_low) - 1, static_cast<double>(bounds.y_low) - 1});
  const Vector3<double> high =
      host.unproject({static_cast<double>(bounds.x_high) + 1, static_cast<double>(bounds.y_high) + 1});
  const double x[2] = {low[0], high[0]}, y[2] = {low[1], high[1]};
  for (int corner = 0; corner < 5; ++corner) {
    const double u = corner < 4 ? x[corner & 1] : 0.5 * (x[0] + x[1]),
                 v = corner < 4 ? y[corner >> 1] : 0.5 * (y[0] + y[1]);
    // Written out: Eigen's product is a function that files built for other CPUs would share.
    double q[3];
    for (int k = 0; k < 3; ++k) q[k] = H(k, 0) * u + H(k, 1) * v + H(k, 2);
    if (!(q[2] > 0)) return false;
    const double inverse = 1 / q[2];
    const Vector2<double> m(q[0] * inverse, q[1] * inverse);
    if (corner == 4) {
      out->middle = m;
    } else {
      if (corner == 0) out->low = out->high = m;
      out->add({m, m, m});
    }
  }
  return all_finite(out->low) && all_finite(out->high);
}

/// The lens over the rays of a box, as far as it has pixels for them. False where no piece of it holds them all.
TEXTPLANE_DEFERRED
inline bool fit_lens(const LensMap& lens, const RayBox& box, simd::LensFit* out) noexcept {
  const double low = box.least_r2(), high = (std::min)(box.most_r2(), lens.max_r2()), at = box.middle.squaredNorm();
  if (!(low < high) || !(at <= lens.max_r2())) return false;
  const LensPiece* piece = lens.piece(low, high);
  if (!piece) return false;
  out->m0[0] = box.middle[0];
  out->m0[1] = box.middle[1];
  out->p[0] = lens.p1();
  out->p[1] = lens.p2();
  out->r0 = at;
  out->low = low;
  out->high = high;
  out->terms = piece->terms;
  // Expanded anew at the middle, so that what float rounds is small.
  const double shift = at - piece->centre;
  for (int k = 0; k <= simd::kLensTerms; ++k) out->c[k] = piece->c[k];
  for (int end = 0; end < piece->terms; ++end)
    for (int k = piece->terms - 1; k >= end; --k) out->c[k] += shift * out->c[k + 1];
  return true;
}

}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_LENS_LENS_FIT_HPP
