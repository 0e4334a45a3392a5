// Warps out of an image behind a lens: unwarps a text quad of a raw image to an upright patch, or rectifies part of it.
//
// out(x, y) = source(pixel of the ray q), q = H (x, y, 1): H maps output pixels to rays of the source's camera, scale
// kept, so q_z > 0 means in front. Else as warp_patch.hpp, statuses included; a camera that is not valid() is
// invalid_argument.
#ifndef TEXTPLANE_PHOTOMETRY_LENS_WARP_LENS_HPP
#define TEXTPLANE_PHOTOMETRY_LENS_WARP_LENS_HPP

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "textplane/core/cameras/camera_view.hpp"
#include "textplane/photometry/lens/lens_fit.hpp"
#include "textplane/photometry/warp_patch.hpp"
#include "textplane/simd/warp_lens.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
TEXTPLANE_DEFERRED
inline Status check_warp(bool images_valid, int width, int height, const CameraView& camera, const Matrix3<double>& H,
                         const ImageView<std::uint8_t>& mask) noexcept {
  return camera.valid() ? check_warp(images_valid, width, height, H, mask) : Status::invalid_argument;
}

// A block of the output in double. Returns how many of its pixels are inside.
template <class D>
int warp_lens_reference(const ImageView8& source, const CameraView& camera, const Matrix3<double>& H,
                        const ImageView<D>& out, int x0, int y0, int x1, int y1, double fill,
                        const ImageView<std::uint8_t>& mask) noexcept {
  int inside = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      Vector3<double> q;
      for (int k = 0; k < 3; ++k) q[k] = H(k, 0) * x + H(k, 1) * y + H(k, 2);
      double value = fill;
      bool in = camera.in_domain(q);
      if (in) {
        const Vector2<double> px = camera.pixel({q[0] / q[2], q[1] / q[2]});
        in = sample_bilinear(source, px[0], px[1], &value);
      }
      out(x, y) = warp_pixel<D>(value);
      if (mask.data()) mask(x, y) = in ? 1 : 0;
      inside += in ? 1 : 0;
    }
  return inside;
}
}  // namespace detail

namespace reference {
/// The warp in double precision: D is std::uint8_t (rounded to nearest), float or double.
template <class D>
WarpSummary warp_patch(const ImageView8& source, const CameraView& camera, const Matrix3<double>& H,
                       const ImageView<D>& out, double fill = 0.0, const ImageView<std::uint8_t>& mask = {}) noexcept {
  WarpSummary summary;
  summary.status = detail::check_warp(source.valid() && out.valid(), out.width(), out.height(), camera, H, mask);
  if (!is_ok(summary.status)) return summary;
  summary.inside = detail::warp_lens_reference(source, camera, H, out, 0, 0, out.width(), out.height(), fill, mask);
  if (summary.inside == 0) summary.status = Status::out_of_view;
  return summary;
}
}  // namespace reference

/// The warp, by the SIMD kernel of the active target: D is std::uint8_t or float. Differs from the reference as
/// warp_patch() without a lens does. Without one H may as well be that of warp_patch(): K H.
template <class D>
WarpSummary warp_patch(const ImageView8& source, const CameraView& camera, const Matrix3<double>& H,
                       const ImageView<D>& out, float fill = 0.0F, const ImageView<std::uint8_t>& mask = {}) noexcept {
  static_assert(std::is_same<D, std::uint8_t>::value || std::is_same<D, float>::value, "8-bit, or float");
  WarpSummary summary;
  summary.status = detail::check_warp(source.valid() && out.valid(), out.width(), out.height(), camera, H, mask);
  if (!is_ok(summary.status)) return summary;
  if (!camera.lens) {
    const Pinhole<double>& c = camera.pinhole;
    Matrix3<double> K;
    K << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1;
    return warp_patch(source, product(K, H), out, fill, mask);
  }
  simd::WarpLensArgs args;
  args.source = {source.data(), source.stride(), source.width(), source.height()};
  args.out_stride = out.stride();
  args.mask_stride = mask.stride();
  args.bytes = std::is_same<D, std::uint8_t>::value;
  args.fill = args.bytes ? static_cast<float>(detail::warp_pixel<std::uint8_t>(static_cast<double>(fill))) : fill;
  for (int i = 0; i < 9; ++i) args.h[i] = H(i / 3, i % 3);
  const double intrinsics[] = {camera.pinhole.fx, camera.pinhole.fy, camera.pinhole.cx, camera.pinhole.cy};
  std::copy_n(intrinsics, 4, args.camera);
  const bool kernels = simd::readable(args.source);
  for (int y = 0; y < out.height(); y += simd::kLensBlockHeight)
    for (int x = 0; x < out.width(); x += simd::kLensBlockWidth) {
      const int x1 = (std::min)(x + simd::kLensBlockWidth, out.width()),
                y1 = (std::min)(y + simd::kLensBlockHeight, out.height());
      const simd::PointBounds bounds{static_cast<float>(x), static_cast<float>(x1 - 1), static_cast<float>(y),
                                     static_cast<float>(y1 - 1), 1};
      detail::RayBox box;
      simd::LensFit fit;
      int inside = -1;
      if (kernels && detail::ray_box(bounds, Pinhole<double>(), H, &box) && detail::fit_lens(*camera.lens, box, &fit)) {
        args.lens = &fit;
        args.x = x;
        args.y = y;
        args.columns = x1 - x;
        args.rows = y1 - y;
        args.out = &out(x, y);
        args.mask = mask.data() ? &mask(x, y) : nullptr;
        inside = simd::warp_lens_block(args);
      }
      if (inside < 0)
        inside = detail::warp_lens_reference(source, camera, H, out, x, y, x1, y1, static_cast<double>(fill), mask);
      summary.inside += inside;
    }
  if (summary.inside == 0) summary.status = Status::out_of_view;
  return summary;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_LENS_WARP_LENS_HPP
