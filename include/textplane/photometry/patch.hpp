// TextPatch: the pixels of a text object in its host image, on every pyramid level.
#ifndef TEXTPLANE_PHOTOMETRY_PATCH_HPP
#define TEXTPLANE_PHOTOMETRY_PATCH_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/core/cameras/camera_view.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/geometry/row_warp.hpp"
#include "textplane/photometry/pyramid.hpp"
#include "textplane/photometry/sample.hpp"
#include "textplane/simd/sample.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// n host pixels of one pyramid level, as arrays that somebody else owns: positions in px of that level, intensities
/// there, and optionally a byte each that is zero for pixels to be left out (null: all count). gx, gy: the host image's
/// gradient there, in intensity units a px, which template_jacobian and esm need (null: these policies are not
/// possible).
struct PatchView {
  const float* x = nullptr;            ///< Columns, px of the level.
  const float* y = nullptr;            ///< Rows, px of the level.
  const float* intensity = nullptr;    ///< Grey levels of the host there.
  const std::uint8_t* mask = nullptr;  ///< Zero: the pixel is left out; null: none is.
  int n = 0;                           ///< Number of pixels.
  const float* gx = nullptr;           ///< Gradient along x, grey levels a px; null: not known.
  const float* gy = nullptr;           ///< Gradient along y, likewise.
  simd::PointBounds bounds = {};       ///< Of x and y, where known: saves the kernels a look at them.
};

/// The host pixels of one pyramid level. x, y and intensity have one length, the others that length too or none.
struct PatchLevel {
  std::vector<float> x;          ///< Columns, px of the level.
  std::vector<float> y;          ///< Rows, px of the level.
  std::vector<float> intensity;  ///< Grey levels of the host there.
  std::vector<float> gx;         ///< Its gradient along x, grey levels a px.
  std::vector<float> gy;         ///< Likewise along y.
  std::vector<float> taken_x;    ///< Columns in the image behind a lens; none: x itself.
  std::vector<float> taken_y;    ///< Rows likewise.
  simd::PointBounds bounds;      ///< Of x and y. Whoever changes these in place calls find_bounds(), or clears it.

  /// Sets `bounds` by the positions.
  void find_bounds() noexcept { bounds = simd::point_bounds(x.data(), y.data(), static_cast<int>(x.size())); }

  /// Where pixel i lies in the host image as it was taken.
  Vector2<float> taken(std::size_t i) const noexcept {
    return taken_x.size() == x.size() ? Vector2<float>(taken_x[i], taken_y[i]) : Vector2<float>(x[i], y[i]);
  }

  /// Valid until the vectors change.
  PatchView view() const noexcept {
    const bool gradients = gx.size() == x.size() && gy.size() == x.size();
    return {x.data(),
            y.data(),
            intensity.data(),
            nullptr,
            static_cast<int>(x.size()),
            gradients ? gx.data() : nullptr,
            gradients ? gy.data() : nullptr,
            bounds};
  }
};

/// Gradient of the host at one of its pixels (x, y): the symmetric difference of the bilinear interpolant over one px,
/// one side of it at the image's border. Unlike the interpolant's own gradient it favours no side at integer positions.
/// The image must contain (x, y); zero along an axis of one pixel.
inline void host_gradient(const ImageView8& image, float x, float y, float* gx, float* gy) noexcept {
  const float left = (std::max)(x - 0.5F, 0.0F), right = (std::min)(x + 0.5F, static_cast<float>(image.width() - 1));
  const float up = (std::max)(y - 0.5F, 0.0F), down = (std::min)(y + 0.5F, static_cast<float>(image.height() - 1));
  float a = 0, b = 0;
  *gx = sample_bilinear(image, right, y, &b) && sample_bilinear(image, left, y, &a) && right > left
            ? (b - a) / (right - left)
            : 0.0F;
  *gy = sample_bilinear(image, x, down, &b) && sample_bilinear(image, x, up, &a) && down > up ? (b - a) / (down - up)
                                                                                              : 0.0F;
}

/// The host side of a text object. It holds all that a target image is compared with: the host image may go. All
/// positions are those of the undistorted image, whose camera is a pinhole; behind a lens they are not whole numbers.
struct TextPatch {
  std::vector<PatchLevel> levels;            ///< Finest first.
  Quad<double> quad;                         ///< px of level 0, clockwise from the text's top left.
  Pinhole<double> camera;                    ///< Of the host, level 0.
  double area = 0;                           ///< px^2 that it covers in the host image as it was taken.
  PatchRows rows;                            ///< By the rows of the camera view that it was made with.
  Status status = Status::invalid_argument;  ///< Of its making.

  /// Pyramid levels that it has pixels of.
  int level_count() const noexcept { return static_cast<int>(levels.size()); }
  /// Pixels of the level that has most.
  int max_pixels() const noexcept {
    std::size_t most = 0;
    for (const PatchLevel& level : levels) most = level.x.size() > most ? level.x.size() : most;
    return static_cast<int>(most);
  }
};

namespace detail {
// Position and gradient of a pixel of one level behind a lens, in the undistorted image. False where it has no ray.
TEXTPLANE_DEFERRED
inline bool straighten(const CameraView& camera, float* x, float* y, float* gx, float* gy) noexcept {
  const Vector2<double> px(static_cast<double>(*x), static_cast<double>(*y));
  Vector3<double> ray;
  if (!is_ok(camera.unproject(px, &ray))) return false;
  FixedMatrix<double, 2, 2> D;
  camera.lens->distort({ray[0], ray[1]}, &D);
  const Pinhole<double>& c = camera.pinhole;
  const double a = static_cast<double>(*gx) * c.fx, b = static_cast<double>(*gy) * c.fy;
  *gx = static_cast<float>((a * D(0, 0) + b * D(1, 0)) / c.fx);
  *gy = static_cast<float>((a * D(0, 1) + b * D(1, 1)) / c.fy);
  const Vector2<double> straight = c.pixel({ray[0], ray[1]});
  *x = static_cast<float>(straight[0]);
  *y = static_cast<float>(straight[1]);
  return is_finite(*x) && is_finite(*y);
}
}  // namespace detail

/// The patch of given pixels: pixels[l] holds positions in px of level l, integer or not, where the host is sampled
/// bilinearly, its gradient by host_gradient(). Positions outside the image, without a ray, and NaN are dropped. Levels
/// beyond those of `host` are ignored. `quad` and pixels are those of the image as it was taken.
///
/// Status::too_few where no level has `min_pixels` (the paper's 15) left, non_finite for a NaN quad, degenerate where a
/// corner of it has no ray, invalid_argument for an empty pyramid, no pixel lists or a camera that is not valid().
/// Allocates.
TEXTPLANE_DEFERRED
TextPatch patch_from_pixels(const PyramidView& host, const CameraView& camera, const Quad<double>& quad,
                            const std::vector<std::vector<Vector2<float>>>& pixels, int min_pixels = 15) {
  TextPatch patch;
  patch.quad = quad;
  patch.camera = camera.pinhole;
  const int levels = (std::min)({host.levels, kMaxPyramidLevels, static_cast<int>(pixels.size())});
  if (levels < 1 || !camera.valid()) return patch;
  if (!all_finite(quad)) {
    patch.status = Status::non_finite;
    return patch;
  }
  patch.area = std::abs(area(quad));
  for (Vector2<double>& corner : patch.quad.corner) {
    if (!camera.lens) break;
    Vector3<double> ray;
    patch.status = camera.unproject(corner, &ray);
    if (!is_ok(patch.status)) return patch;
    corner = camera.pinhole.pixel({ray[0], ray[1]});
  }

  if (camera.rows) patch.rows = patch_rows(*camera.rows, camera, camera.pinhole.unproject(centroid(patch.quad)));
  patch.levels.resize(static_cast<std::size_t>(levels));
  std::size_t most = 0;
  for (std::size_t l = 0; l < patch.levels.size(); ++l) {
    PatchLevel& level = patch.levels[l];
    const CameraView level_camera = camera.at_level(static_cast<int>(l));
    // Made at their full size and cut: an append that grows is a function of the standard library, shared between
    // translation units with different instruction sets.
    const std::size_t candidates = pixels[l].size();
    for (std::vector<float>* values : {&level.x, &level.y, &level.intensity, &level.gx, &level.gy}) {
      *values = std::vector<float>(candidates);
    }
    if (camera.lens) level.taken_x = level.taken_y = std::vector<float>(candidates);
    std::size_t n = 0;
    for (const Vector2<float>& px : pixels[l]) {
      if (!sample_bilinear(host.level[l], px[0], px[1], &level.intensity[n])) continue;
      level.x[n] = px[0];
      level.y[n] = px[1];
      host_gradient(host.level[l], px[0], px[1], &level.gx[n], &level.gy[n]);
      if (camera.lens) {
        level.taken_x[n] = px[0];
        level.taken_y[n] = px[1];
        if (!detail::straighten(level_camera, &level.x[n], &level.y[n], &level.gx[n], &level.gy[n])) continue;
      }
      ++n;
    }
    for (std::vector<float>* values :
         {&level.x, &level.y, &level.intensity, &level.gx, &level.gy, &level.taken_x, &level.taken_y}) {
      if (!values->empty()) values->erase(values->begin() + static_cast<std::ptrdiff_t>(n), values->end());
    }
    level.find_bounds();
    most = (std::max)(most, level.x.size());
  }
  patch.status = static_cast<int>(most) < (std::max)(min_pixels, 1) ? Status::too_few : Status::ok;
  return patch;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_PATCH_HPP
