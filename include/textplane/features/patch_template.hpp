// PatchTemplate: a small patch, zero mean and unit norm, with the Jacobian of the normalised intensities.
//
// T~ = (T - mean) / s over the N samples, s = ||T - mean|| (docs/equations.md). For a translation the gradient
// of the normalised patch is J~ = (1/s) (I - 1 1^T/N - T~ T~^T) grad T. J~ is orthogonal to 1 and to T~, so in the
// inverse-compositional step sum J~ (I~ - T~) = (1/s_I) sum J~ I: neither gain nor bias of the target enters.
#ifndef TEXTPLANE_FEATURES_PATCH_TEMPLATE_HPP
#define TEXTPLANE_FEATURES_PATCH_TEMPLATE_HPP

#include <cmath>
#include <cstdint>
#include <cstring>

#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"
#include "textplane/photometry/sample.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Largest half width of a template: 21 x 21 samples.
constexpr int kMaxPatchHalf = 10;

/// A normalised patch with gradients, ready to be aligned: a rectangle of columns x rows samples, of which the one at
/// (left, top) is the point itself. Fixed capacity (6 KB), no allocation, freely copied. Rows are `stride` floats apart
/// (16 or 24); the columns past `columns` hold zeros.
struct PatchTemplate {
  static constexpr int kCapacity = 21 * 24;

  int left = 0, top = 0, columns = 0, rows = 0;
  int stride = 0;
  float mean = 0;                   ///< Intensity.
  float s = 0;                      ///< ||T - mean||, intensity.
  float hxx = 0, hxy = 0, hyy = 0;  ///< J~^T J~, 1/px^2.
  float min_eigenvalue = 0;         ///< Of J~^T J~: the position variance of a unit residual is its inverse.
  Status status = Status::invalid_argument;
  float value[kCapacity];  ///< T~
  float jx[kCapacity];     ///< dT~/dx, 1/px.
  float jy[kCapacity];

  int count() const noexcept { return columns * rows; }
  /// Population standard deviation of the intensities.
  float contrast() const noexcept { return count() > 0 ? s / std::sqrt(static_cast<float>(count())) : 0.0F; }
};

namespace detail {

// Floats in a row of a patch so many columns wide: constants, so that loops over rows have constant trip counts.
constexpr int patch_stride(int columns) noexcept { return columns <= 15 ? 16 : 24; }

// A window of samples at a constant sub-pixel offset, inside the image: first sample at (x + fx, y + fy); the pixels
// x .. x + columns, y .. y + rows all exist.
struct SampleWindow {
  int x = 0, y = 0;
  float fx = 0, fy = 0;
};

// False where a sample of the window whose first one is at (left, top) falls outside the image, or for NaN.
inline bool place_window(const ImageView8& image, float left, float top, int columns, int rows,
                         SampleWindow* window) noexcept {
  const int last_x = image.width() - 1 - columns, last_y = image.height() - 1 - rows;
  if (last_x < 0 || last_y < 0) return false;
  if (!(left >= 0.0F && top >= 0.0F && left <= static_cast<float>(last_x + 1) && top <= static_cast<float>(last_y + 1)))
    return false;
  window->x = static_cast<int>(left);
  window->y = static_cast<int>(top);
  // On the last column or row the interpolation uses the cell before it, with weight one.
  if (window->x > last_x) window->x = last_x;
  if (window->y > last_y) window->y = last_y;
  window->fx = left - static_cast<float>(window->x);
  window->fy = top - static_cast<float>(window->y);
  return true;
}

// Pointer to `lanes` + 1 readable bytes that start with pixels x .. x + columns of a row: the row itself, or near the
// right border a zero-padded copy.
inline const std::uint8_t* window_row(const ImageView8& image, int x, int y, int columns, int lanes,
                                      std::uint8_t* padded) noexcept {
  const std::uint8_t* row = image.row(y) + x;
  if (x + lanes < image.width()) return row;
  std::memcpy(padded, row, static_cast<std::size_t>(columns + 1));
  return padded;
}

// Interpolation along x of one row.
template <int Lanes>
inline void lerp_row(const std::uint8_t* p, float fx, float* out) noexcept {
  for (int i = 0; i < Lanes; ++i) {
    const float a = static_cast<float>(p[i]), b = static_cast<float>(p[i + 1]);
    out[i] = a + fx * (b - a);
  }
}

// Patch with a border of one sample for the differences; its rows are 8 floats longer than those of the template.
struct PaddedPatch {
  float value[(2 * kMaxPatchHalf + 3) * (patch_stride(2 * kMaxPatchHalf + 1) + 8)];
};

// Bilinear samples, whole rows at constant sub-pixel weights, of a window of columns x rows that begins at (left, top).
// False where it leaves the image.
template <int Pitch>
bool sample_padded(const ImageView8& image, float left, float top, int columns, int rows, PaddedPatch* patch) noexcept {
  SampleWindow window;
  if (!place_window(image, left, top, columns, rows, &window)) return false;
  std::uint8_t padded[Pitch + 1] = {};
  float upper[Pitch], lower[Pitch];
  lerp_row<Pitch>(window_row(image, window.x, window.y, columns, Pitch, padded), window.fx, upper);
  for (int y = 0; y < rows; ++y) {
    lerp_row<Pitch>(window_row(image, window.x, window.y + y + 1, columns, Pitch, padded), window.fx, lower);
    float* out = patch->value + y * Pitch;
    for (int i = 0; i < Pitch; ++i) out[i] = upper[i] + window.fy * (lower[i] - upper[i]);
    for (int i = 0; i < Pitch; ++i) upper[i] = lower[i];
  }
  return true;
}

// Fills mean, s, value, gradient and Hessian from the samples. The loops run over whole padded rows with constant trip
// counts, which compilers vectorise at -O2; sums are kept per column and the padding columns left out at the end.
template <int Lanes>
void normalise_template(const PaddedPatch& patch, PatchTemplate* t) noexcept {
  constexpr int pitch = Lanes + 8;
  const int columns = t->columns, rows = t->rows;
  float column[Lanes] = {};
  for (int y = 0; y < rows; ++y) {
    const float* row = patch.value + (y + 1) * pitch + 1;
    for (int i = 0; i < Lanes; ++i) column[i] += row[i];
  }
  float sum = 0;
  for (int i = 0; i < columns; ++i) sum += column[i];
  const float n = static_cast<float>(t->count());
  const float mean = sum / n;
  t->mean = mean;

  float mask[Lanes];
  for (int i = 0; i < Lanes; ++i) mask[i] = i < columns ? 1.0F : 0.0F;
  float c_vv[Lanes] = {}, c_x[Lanes] = {}, c_y[Lanes] = {}, c_vx[Lanes] = {}, c_vy[Lanes] = {};
  for (int y = 0; y < rows; ++y) {
    const float* above = patch.value + y * pitch + 1;
    const float* row = above + pitch;
    const float* below = row + pitch;
    float* value = t->value + y * Lanes;
    float* jx = t->jx + y * Lanes;
    float* jy = t->jy + y * Lanes;
    for (int i = 0; i < Lanes; ++i) {
      const float v = mask[i] * (row[i] - mean);
      const float gx = mask[i] * 0.5F * (row[i + 1] - row[i - 1]);
      const float gy = mask[i] * 0.5F * (below[i] - above[i]);
      value[i] = v;
      jx[i] = gx;
      jy[i] = gy;
      c_vv[i] += v * v;
      c_x[i] += gx;
      c_y[i] += gy;
      c_vx[i] += v * gx;
      c_vy[i] += v * gy;
    }
  }
  float vv = 0, mx = 0, my = 0, vx = 0, vy = 0;
  for (int i = 0; i < columns; ++i) {
    vv += c_vv[i];
    mx += c_x[i];
    my += c_y[i];
    vx += c_vx[i];
    vy += c_vy[i];
  }
  t->s = std::sqrt(vv);
  if (!(vv > 1e-6F * n)) {
    t->status = Status::no_contrast;
    return;
  }
  const float inverse = 1.0F / t->s;
  mx /= n;
  my /= n;
  vx /= vv;
  vy /= vv;
  float c_xx[Lanes] = {}, c_xy[Lanes] = {}, c_yy[Lanes] = {};
  for (int y = 0; y < rows; ++y) {
    float* value = t->value + y * Lanes;
    float* jx = t->jx + y * Lanes;
    float* jy = t->jy + y * Lanes;
    for (int i = 0; i < Lanes; ++i) {
      const float v = value[i];
      const float x = inverse * (jx[i] - mask[i] * mx - v * vx), yy = inverse * (jy[i] - mask[i] * my - v * vy);
      value[i] = v * inverse;
      jx[i] = x;
      jy[i] = yy;
      c_xx[i] += x * x;
      c_xy[i] += x * yy;
      c_yy[i] += yy * yy;
    }
  }
  t->hxx = t->hxy = t->hyy = 0;
  for (int i = 0; i < columns; ++i) {
    t->hxx += c_xx[i];
    t->hxy += c_xy[i];
    t->hyy += c_yy[i];
  }
  const float difference = t->hxx - t->hyy;
  t->min_eigenvalue = 0.5F * (t->hxx + t->hyy - std::sqrt(difference * difference + 4.0F * t->hxy * t->hxy));
  t->status = Status::ok;
}

inline void normalise_template(const PaddedPatch& patch, PatchTemplate* t) noexcept {
  if (t->stride == 16) {
    normalise_template<16>(patch, t);
  } else {
    normalise_template<24>(patch, t);
  }
}

// An unwarped template round (x, y) of the extents that `t` holds; one more ring of samples is read.
inline Status extract_upright_template(const ImageView8& image, float x, float y, PatchTemplate* t) noexcept {
  PaddedPatch patch;
  const float left = x - static_cast<float>(t->left + 1), top = y - static_cast<float>(t->top + 1);
  t->stride = patch_stride(t->columns);
  const bool inside = t->stride == 16 ? sample_padded<24>(image, left, top, t->columns + 2, t->rows + 2, &patch)
                                      : sample_padded<32>(image, left, top, t->columns + 2, t->rows + 2, &patch);
  if (!inside) return t->status = Status::out_of_view;
  normalise_template(patch, t);
  return t->status;
}

}  // namespace detail

/// Samples a template of (2 half + 1)^2 pixels: its offset (dx, dy) shows `image` at centre + A (dx, dy), bilinearly.
/// `A`: template offset -> image offset (px); to re-observe a point of a key frame, d(host pixel)/d(target pixel)
/// scaled to the levels used. Choose the level of the source so that |A| is about 1: nothing is filtered here. `half`
/// in [1, kMaxPatchHalf]. One more ring of samples is read for the gradients (central differences). Returns, and stores
/// in `t->status`: ok; out_of_view where a sample leaves the image; no_contrast; degenerate for a singular A;
/// non_finite; invalid_argument. No allocation; any number of threads.
inline Status extract_template(const ImageView8& image, const Vector2<float>& centre, const Eigen::Matrix2f& A,
                               int half, PatchTemplate* t) noexcept {
  t->left = t->top = t->columns = t->rows = t->stride = 0;
  if (!image.valid() || half < 1 || half > kMaxPatchHalf) return t->status = Status::invalid_argument;
  if (!all_finite(centre) || !all_finite(A)) return t->status = Status::non_finite;
  const float a = A(0, 0), b = A(0, 1), c = A(1, 0), d = A(1, 1);
  if (!(std::abs(a * d - b * c) > 1e-6F)) return t->status = Status::degenerate;
  t->left = t->top = half;
  t->columns = t->rows = 2 * half + 1;
  t->stride = detail::patch_stride(t->columns);
  // The window's image is a parallelogram: it lies inside where its corners do.
  const float reach = static_cast<float>(half + 1);
  const float extent_x = reach * (std::abs(a) + std::abs(b)), extent_y = reach * (std::abs(c) + std::abs(d));
  if (!image.contains(centre[0] - extent_x, centre[1] - extent_y) ||
      !image.contains(centre[0] + extent_x, centre[1] + extent_y))
    return t->status = Status::out_of_view;
  detail::PaddedPatch patch;
  std::memset(patch.value, 0, sizeof patch.value);
  for (int j = -half - 1; j <= half + 1; ++j) {
    float* out = patch.value + (j + half + 1) * (t->stride + 8);
    for (int i = -half - 1; i <= half + 1; ++i) {
      const float fi = static_cast<float>(i), fj = static_cast<float>(j);
      const float x = centre[0] + a * fi + b * fj, y = centre[1] + c * fi + d * fj;
      // Rounding may leave a corner a hair outside; sample_inside() then extends the last cell.
      detail::sample_inside<std::uint8_t, float>(image, x, y, out + i + half + 1, nullptr, nullptr);
    }
  }
  detail::normalise_template(patch, t);
  return t->status;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_FEATURES_PATCH_TEMPLATE_HPP
