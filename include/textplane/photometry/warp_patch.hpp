// Warps: a regular grid of pixels, sampled from an image through a homography. Unwarps a text quad to an upright patch,
// and draws a patch as another view would see it.
//
// out(x, y) = source(q_xy / q_z), q = H (x, y, 1): H maps output pixels to source pixels, scale kept, so q_z > 0 means
// in front (pixel_homography()). Bilinear, domain [0, w - 1] x [0, h - 1] as sample_bilinear(). Output pixels that fall
// outside, or lie behind, receive `fill` and a zero in the mask.
//
// noexcept, no allocation, thread-safe. Status of all functions:
//   ok                at least one output pixel is inside
//   out_of_view       none is; the output is all `fill`
//   non_finite        NaN or infinity in H; nothing is written
//   invalid_argument  an image that is not valid(), or a mask of another size than the output; nothing is written
#ifndef TEXTPLANE_PHOTOMETRY_WARP_PATCH_HPP
#define TEXTPLANE_PHOTOMETRY_WARP_PATCH_HPP

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"
#include "textplane/photometry/sample.hpp"
#include "textplane/simd/warp.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// How a warp went.
struct WarpSummary {
  int inside = 0;                            ///< Output pixels that lie inside the source.
  Status status = Status::invalid_argument;  ///< Whether the warp was possible.
};

namespace detail {
TEXTPLANE_DEFERRED
inline Status check_warp(bool images_valid, int width, int height, const Matrix3<double>& H,
                         const ImageView<std::uint8_t>& mask) noexcept {
  if (!images_valid) return Status::invalid_argument;
  if (mask.data() && (!mask.valid() || mask.width() != width || mask.height() != height))
    return Status::invalid_argument;
  return all_finite(H) ? Status::ok : Status::non_finite;
}

// A grey level as a pixel of type D: rounded to the nearest of [0, 255] for bytes.
template <class D>
D warp_pixel(double value) noexcept {
  if constexpr (std::is_same<D, std::uint8_t>::value) {
    return static_cast<std::uint8_t>(value > 0 ? (value < 255 ? value + 0.5 : 255) : 0);  // NaN: 0
  } else {
    return static_cast<D>(value);
  }
}
}  // namespace detail

namespace reference {

/// The warp in double precision: S is std::uint8_t or float, D std::uint8_t (rounded to nearest), float or double.
template <class S, class D>
WarpSummary warp_patch(const ImageView<const S>& source, const Matrix3<double>& H, const ImageView<D>& out,
                       double fill = 0.0, const ImageView<std::uint8_t>& mask = {}) noexcept {
  WarpSummary summary;
  summary.status = detail::check_warp(source.valid() && out.valid(), out.width(), out.height(), H, mask);
  if (!is_ok(summary.status)) return summary;
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      double q[3];
      for (int k = 0; k < 3; ++k) q[k] = H(k, 0) * x + H(k, 1) * y + H(k, 2);
      double value = fill;
      const bool inside = q[2] > 0.0 && sample_bilinear(source, q[0] / q[2], q[1] / q[2], &value);
      out(x, y) = detail::warp_pixel<D>(value);
      if (mask.data()) mask(x, y) = inside ? 1 : 0;
      summary.inside += inside ? 1 : 0;
    }
  if (summary.inside == 0) summary.status = Status::out_of_view;
  return summary;
}

}  // namespace reference

/// The warp, by the SIMD kernel of the active target: 8-bit source to float or 8-bit, float to float. Differs from the
/// reference by less than 0.01 grey levels where a step in the output is at most two pixels in the source, and agrees
/// with it after rounding unless within 0.01 of a tie. A point within 1e-4 px of the border may count as in or out.
template <class S, class D>
WarpSummary warp_patch(const ImageView<const S>& source, const Matrix3<double>& H, const ImageView<D>& out,
                       float fill = 0.0F, const ImageView<std::uint8_t>& mask = {}) noexcept {
  constexpr bool from_bytes = std::is_same<S, std::uint8_t>::value, to_bytes = std::is_same<D, std::uint8_t>::value;
  static_assert((from_bytes && (to_bytes || std::is_same<D, float>::value)) ||
                    (std::is_same<S, float>::value && std::is_same<D, float>::value),
                "8-bit to float, 8-bit to 8-bit, or float to float");
  WarpSummary summary;
  summary.status = detail::check_warp(source.valid() && out.valid(), out.width(), out.height(), H, mask);
  if (!is_ok(summary.status)) return summary;
  // One row or column, or offsets beyond 32 bits: rare enough for the reference.
  const bool large = source.stride() > (std::numeric_limits<std::int32_t>::max)() / source.height();
  if (source.width() < 2 || source.height() < 2 || large)
    return reference::warp_patch(source, H, out, static_cast<double>(fill), mask);

  simd::WarpArgs args;
  args.source = source.data();
  args.width = source.width();
  args.height = source.height();
  args.source_stride = source.stride();
  args.out = out.data();
  args.out_width = out.width();
  args.out_height = out.height();
  args.out_stride = out.stride();
  args.mask = mask.data();
  args.mask_stride = mask.stride();
  for (int i = 0; i < 9; ++i) args.h[i] = H(i / 3, i % 3);
  args.fill = to_bytes ? static_cast<float>(detail::warp_pixel<std::uint8_t>(static_cast<double>(fill))) : fill;
  if constexpr (to_bytes) {
    summary.inside = simd::warp_u8_u8(args);
  } else if constexpr (from_bytes) {
    summary.inside = simd::warp_u8_f32(args);
  } else {
    summary.inside = simd::warp_f32_f32(args);
  }
  summary.status = summary.inside > 0 ? Status::ok : Status::out_of_view;
  return summary;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_WARP_PATCH_HPP
