// PointPatch: the small patch round a point, zero mean and unit norm, with the Jacobian of its intensities.
//
// T~ = (T - mean) / s over the N samples, s = ||T - mean|| (docs/equations.md). For a translation the gradient of T~ is
// J~ = (1/s) (I - 1 1^T/N - T~ T~^T) grad T. J~ is orthogonal to 1 and to T~, so in the inverse-compositional step sum
// J~ (I~ - T~) = (1/s_I) sum J~ I: neither gain nor bias of the target enters.
//
// Neither T~ nor J~ is ever formed. T and grad T are kept as int16 (simd/klt.hpp), and their sums are exact integers;
// mean, norm and projection are applied to these sums.
#ifndef TEXTPLANE_FEATURES_POINT_PATCH_HPP
#define TEXTPLANE_FEATURES_POINT_PATCH_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"
#include "textplane/photometry/sample.hpp"
#include "textplane/photometry/warp_patch.hpp"
#include "textplane/simd/klt.hpp"

TEXTPLANE_BEGIN_NAMESPACE

constexpr int kMaxPatchRadius = 10;  ///< Largest radius of a patch: 21 x 21 samples.

/// A normalised patch of columns x rows samples with gradients, ready to be aligned. The point lies (dx, dy) from the
/// sample at (left, top). Fixed capacity (4 KB), no allocation, freely copied.
///
/// Samples are rounded to 1/32 grey level. Upright samples lie on a grid of 1/64 px, so (dx, dy) is at most 1/128 px.
struct PointPatch {
  int left = 0;                              ///< Samples to the left of the point.
  int top = 0;                               ///< Samples above it.
  int columns = 0;                           ///< Samples in a row.
  int rows = 0;                              ///< Rows of samples.
  float dx = 0;                              ///< From the sample at (left, top) to the point, px.
  float dy = 0;                              ///< Likewise.
  float mean = 0;                            ///< Intensity.
  float s = 0;                               ///< ||T - mean||, intensity.
  float hxx = 0;                             ///< J~^T J~, 1/px^2.
  float hxy = 0;                             ///< Likewise.
  float hyy = 0;                             ///< Likewise.
  float min_eigenvalue = 0;                  ///< Of J~^T J~: the position variance of a unit residual is its inverse.
  Status status = Status::invalid_argument;  ///< That of extract_point_patch().

  // In units of samples.
  double mean_v = 0;     ///< Mean of T.
  double mean_x = 0;     ///< Mean of gx.
  double mean_y = 0;     ///< Mean of gy.
  double norm = 0;       ///< ||T - mean||.
  double along_x = 0;    ///< Share of T - mean in gx.
  double along_y = 0;    ///< Share of T - mean in gy.
  simd::KltPatch patch;  ///< Samples and gradients.

  int count() const noexcept { return columns * rows; }  ///< Number of samples.
  /// Population standard deviation of the intensities.
  float contrast() const noexcept { return count() > 0 ? s / std::sqrt(static_cast<float>(count())) : 0.0F; }

  /// T~ of a sample; the status must be ok.
  double value(int column, int row) const noexcept { return centred(column, row) / norm; }
  /// dT~/dx and dT~/dy, 1/px.
  double jx(int column, int row) const noexcept {
    return (patch.gx[index(column, row)] - mean_x - along_x * centred(column, row)) / norm;
  }
  /// The same along y.
  double jy(int column, int row) const noexcept {
    return (patch.gy[index(column, row)] - mean_y - along_y * centred(column, row)) / norm;
  }

 private:
  static int index(int column, int row) noexcept { return row * simd::kKltStride + column; }
  double centred(int column, int row) const noexcept { return patch.value[index(column, row)] - mean_v; }
};

namespace detail {

// Samples of an image on the grid of 1/64 px, (moved_x, moved_y) px from where they were asked for: at most 1/128.
struct PlacedPatch {
  simd::KltWindow samples;
  float moved_x = 0, moved_y = 0;
};

// columns x rows samples from (left, top) on. False where a sample lies outside the image, and for NaN.
inline bool place_patch(const ImageView8& image, float left, float top, int columns, int rows,
                        PlacedPatch* placed) noexcept {
  const int last_x = image.width() - 1 - columns, last_y = image.height() - 1 - rows;
  if (last_x < 0 || last_y < 0) return false;
  if (!(left >= 0.0F && top >= 0.0F && left <= static_cast<float>(last_x + 1) && top <= static_cast<float>(last_y + 1)))
    return false;
  constexpr int kGrid = simd::kKltSubpixels;
  const int qx = static_cast<int>(left * kGrid + 0.5F), qy = static_cast<int>(top * kGrid + 0.5F);
  // On the last column or row the interpolation uses the cell before it, with weight one.
  const int x = qx / kGrid < last_x ? qx / kGrid : last_x, y = qy / kGrid < last_y ? qy / kGrid : last_y;
  // Bytes after the last sample may be read as long as they belong to the image: its other rows, or gaps between them.
  const std::ptrdiff_t behind = (image.height() - 1 - y - rows) * image.stride() + image.width() - x;
  const int readable = behind < 4096 ? static_cast<int>(behind) : 4096;
  placed->samples = {image.row(y) + x, image.stride(), readable, columns, rows, qx - kGrid * x, qy - kGrid * y};
  placed->moved_x = static_cast<float>(qx) / kGrid - left;
  placed->moved_y = static_cast<float>(qy) / kGrid - top;
  return true;
}

// Mean, norm, projections and Hessian from the sums over the samples.
inline void normalise_point_patch(const simd::KltPatchSums& sums, PointPatch* t) noexcept {
  constexpr double kScale = simd::kKltScale;
  const double n = t->count(), per_n = 1.0 / n;
  t->mean_v = sums.v * per_n;
  t->mean_x = sums.x * per_n;
  t->mean_y = sums.y * per_n;
  const double vv = sums.vv - sums.v * t->mean_v;
  const double vx = sums.vx - sums.v * t->mean_x, vy = sums.vy - sums.v * t->mean_y;
  const double xx = sums.xx - sums.x * t->mean_x, xy = sums.xy - sums.x * t->mean_y, yy = sums.yy - sums.y * t->mean_y;
  t->mean = static_cast<float>(128.0 + t->mean_v / kScale);
  t->norm = vv > 0.0 ? std::sqrt(vv) : 0.0;
  t->s = static_cast<float>(t->norm / kScale);
  if (!(vv > 1e-6 * kScale * kScale * n)) {
    t->status = Status::no_contrast;
    return;
  }
  const double per_vv = 1.0 / vv;
  t->along_x = vx * per_vv;
  t->along_y = vy * per_vv;
  t->hxx = static_cast<float>((xx - vx * t->along_x) * per_vv);
  t->hxy = static_cast<float>((xy - vx * t->along_y) * per_vv);
  t->hyy = static_cast<float>((yy - vy * t->along_y) * per_vv);
  const float difference = t->hxx - t->hyy;
  t->min_eigenvalue = 0.5F * (t->hxx + t->hyy - std::sqrt(difference * difference + 4.0F * t->hxy * t->hxy));
  t->status = Status::ok;
}

// An unwarped patch round (x, y) of the size that `t` holds. One more ring of samples is read.
inline Status extract_upright_patch(const ImageView8& image, float x, float y, PointPatch* t) noexcept {
  const float left = x - static_cast<float>(t->left + 1), top = y - static_cast<float>(t->top + 1);
  PlacedPatch placed;
  if (!place_patch(image, left, top, t->columns + 2, t->rows + 2, &placed)) return t->status = Status::out_of_view;
  t->dx = -placed.moved_x;
  t->dy = -placed.moved_y;
  normalise_point_patch(simd::klt_extract(placed.samples, t->patch), t);
  return t->status;
}

// Samples at centre + A (i, j), |i|, |j| <= reach. All lie inside the image, to rounding. `out` begins with the sample
// of (-reach, -reach); its rows are simd::kKltStride floats apart.
TEXTPLANE_DEFERRED
void sample_affine(const ImageView8& image, const Vector2<float>& centre, const FixedMatrix<float, 2, 2>& A_f,
                   int reach, float* out) noexcept {
  const int side = 2 * reach + 1;
  const FixedMatrix<Real, 2, 2> A = A_f.template cast<Real>();
  const Vector2<Real> first = centre.template cast<Real>() - A * Vector2<Real>::Constant(reach);
  Matrix3<Real> H = Matrix3<Real>::Identity();
  H.template topLeftCorner<2, 2>() = A;
  H.template topRightCorner<2, 1>() = first;
  constexpr std::ptrdiff_t kStride = simd::kKltStride * sizeof(float);
  if (warp_patch(image, H, ImageView<float>(out, side, side, kStride)).inside == side * side) return;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const Vector2<Real> p = first + A * Vector2<Real>(i, j);
      const double x = p[0] > 0 ? p[0] : 0, y = p[1] > 0 ? p[1] : 0;  // sample_inside() extends the last row and column
      double v = 0;
      sample_inside(image, x, y, &v, static_cast<double*>(nullptr), static_cast<double*>(nullptr));
      out[j * simd::kKltStride + i] = static_cast<float>(v > 0 ? (v < 255 ? v : 255) : 0);
    }
}

}  // namespace detail

/// Samples a patch of (2 radius + 1)^2 pixels: its offset (dx, dy) shows `image` at centre + A (dx, dy), bilinearly.
/// `A`: patch offset -> image offset (px). To observe a point of a key frame again, A is d(host pixel)/d(target pixel)
/// between the levels used. Choose the host's level so that |A| is about 1: nothing is filtered here. `radius` in [1,
/// kMaxPatchRadius]. One more ring of samples is read for the gradients (central differences). Returns, and stores in
/// `t->status`: ok; out_of_view where a sample leaves the image; no_contrast; degenerate for a singular A; non_finite;
/// invalid_argument. No allocation; any number of threads.
TEXTPLANE_DEFERRED
Status extract_point_patch(const ImageView8& image, const Vector2<float>& centre, const FixedMatrix<float, 2, 2>& A,
                           int radius, PointPatch* t) noexcept {
  t->left = t->top = t->columns = t->rows = 0;
  t->dx = t->dy = 0;
  if (!image.valid() || radius < 1 || radius > kMaxPatchRadius) return t->status = Status::invalid_argument;
  if (!all_finite(centre) || !all_finite(A)) return t->status = Status::non_finite;
  const float a = A(0, 0), b = A(0, 1), c = A(1, 0), d = A(1, 1);
  if (!(std::abs(a * d - b * c) > 1e-6F)) return t->status = Status::degenerate;
  t->left = t->top = radius;
  t->columns = t->rows = 2 * radius + 1;
  // The patch is a parallelogram in the image: it lies inside where its corners do.
  const float reach = static_cast<float>(radius + 1);
  const float extent_x = reach * (std::abs(a) + std::abs(b)), extent_y = reach * (std::abs(c) + std::abs(d));
  if (!image.contains(centre[0] - extent_x, centre[1] - extent_y) ||
      !image.contains(centre[0] + extent_x, centre[1] + extent_y))
    return t->status = Status::out_of_view;
  float padded[simd::kKltPadded] = {};
  detail::sample_affine(image, centre, A, radius + 1, padded);
  detail::normalise_point_patch(simd::klt_from_grey(padded, t->columns, t->rows, t->patch), t);
  return t->status;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_FEATURES_POINT_PATCH_HPP
