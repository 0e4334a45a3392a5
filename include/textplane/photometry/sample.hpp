// Bilinear interpolation with the gradient of the interpolant itself.
//
// The interpolant is continuous, its gradient jumps at pixel lines: on a line it is that of the cell to the right
// (below), on the last column (row) that of the cell to the left (above).
#ifndef TEXTPLANE_PHOTOMETRY_SAMPLE_HPP
#define TEXTPLANE_PHOTOMETRY_SAMPLE_HPP

#include <type_traits>

#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
// Value part of x, towards zero. Dual numbers without a conversion to int (ceres::Jet) keep the value in a member `a`.
template <class S>
int truncated(const S& x) noexcept {
  if constexpr (std::is_constructible<int, const S&>::value) {
    return static_cast<int>(x);
  } else {
    return static_cast<int>(x.a);
  }
}

// The caller has made sure that the image is valid() and contains (x, y). Reads no pixel outside the image.
template <class T, class S>
void sample_inside(const ImageView<const T>& image, const S& x, const S& y, S* value, S* gx, S* gy) noexcept {
  int x0 = truncated(x), y0 = truncated(y);
  if (x0 > image.width() - 2) x0 = image.width() > 1 ? image.width() - 2 : 0;
  if (y0 > image.height() - 2) y0 = image.height() > 1 ? image.height() - 2 : 0;
  const int step = image.width() > 1 ? 1 : 0;
  const T* upper = image.row(y0) + x0;
  const T* lower = image.row(image.height() > 1 ? y0 + 1 : y0) + x0;

  const S i00 = static_cast<S>(upper[0]), i10 = static_cast<S>(upper[step]);
  const S i01 = static_cast<S>(lower[0]), i11 = static_cast<S>(lower[step]);
  const S dx = x - static_cast<S>(x0), dy = y - static_cast<S>(y0);
  const S along = i10 - i00, down = i01 - i00, twist = i11 - i10 - down;
  *value = i00 + dx * along + dy * (down + dx * twist);
  if (gx) *gx = along + dy * twist;
  if (gy) *gy = down + dx * twist;
}
}  // namespace detail

/// Bilinear interpolant of the image at (x, y), in the image's units, and (where asked for) its gradient in units a px.
///
/// Domain [0, width - 1] x [0, height - 1], borders included. False, and nothing written, outside of it, for NaN, and
/// for an image that is not valid(). T: std::uint8_t or float. S: float, double, or a dual number, whose derivative
/// then is that of the interpolant. Non-finite pixels of a float image give a non-finite value.
template <class T, class S>
bool sample_bilinear(const ImageView<const T>& image, S x, S y, S* value, S* gx = nullptr, S* gy = nullptr) noexcept {
  if (!image.valid() || !image.contains(x, y)) return false;
  detail::sample_inside(image, x, y, value, gx, gy);
  return true;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_SAMPLE_HPP
