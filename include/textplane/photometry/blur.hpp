// Blur that makes two views of a plane alike.
//
// A camera blurs by its own pixels: on the plane, the view from farther away or at a steeper slant is blurred more, and
// in another direction. Text strokes are a few pixels wide, so intensities then differ most beside edges, and the plane
// that fits best is turned by degrees. match_blur() says what each view lacks; the other functions apply it.
#ifndef TEXTPLANE_PHOTOMETRY_BLUR_HPP
#define TEXTPLANE_PHOTOMETRY_BLUR_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"
#include "textplane/photometry/patch.hpp"

TEXTPLANE_BEGIN_NAMESPACE

using Matrix2d = FixedMatrix<double, 2, 2>;  ///< A covariance, px^2.

/// Covariances, px^2 of each image, of the Gaussian filters that bring host and target to one blur on the plane.
struct BlurMatch {
  Matrix2d host = Matrix2d::Zero();    ///< Covariance of the host's filter, px^2 of the host.
  Matrix2d target = Matrix2d::Zero();  ///< Covariance of the target's filter, px^2 of the target.
};

/// What each view lacks. `A`: d target px / d host px on the plane. The variances (px^2 of each image) describe the
/// blur of the views: about half a pixel squared for a sharp lens, and 1/6 more for a target that is sampled
/// bilinearly. Seen in the host, the target's blur is V_t M with M = (A^T A)^-1. The common blur B has the eigenvectors
/// of M and, along each, `spread` times the larger variance. host = B - V_h I, target = A B A^T - V_t I. With a spread
/// above 1 (2 is a good one) a filter of known shape outweighs the unknown part of the blur.
///
/// degenerate where A cannot be inverted or is one of no image (entries of A or M beyond 1e100), non_finite also where
/// the covariances would not be numbers, invalid_argument for a negative variance or a spread below 1; *out is then
/// untouched.
template <class S = double>  // instantiated where it is called: including the header costs little
Status match_blur(const Matrix2d& A, double host_variance, double target_variance, double spread,
                  BlurMatch* out) noexcept {
  if (!all_finite(A) || !is_finite(host_variance) || !is_finite(target_variance) || !is_finite(spread))
    return Status::non_finite;
  if (!(host_variance >= 0) || !(target_variance >= 0) || !(spread >= 1)) return Status::invalid_argument;
  const double det = A(0, 0) * A(1, 1) - A(0, 1) * A(1, 0);
  if (!(std::abs(det) > 1e-9) || !is_finite(1 / (det * det))) return Status::degenerate;
  using Matrix = FixedMatrix<S, 2, 2>;
  Matrix inverse, A_transposed;
  inverse << A(1, 1) / det, -A(0, 1) / det, -A(1, 0) / det, A(0, 0) / det;
  const Matrix transposed = inverse.transpose();
  const Matrix M = product(inverse, transposed);
  // The squares of larger numbers are none, and eigenvalues are made of them.
  for (int i = 0; i < 4; ++i)
    if (!(std::abs(A(i / 2, i % 2)) <= 1e100) || !(std::abs(M(i / 2, i % 2)) <= 1e100)) return Status::degenerate;
  const SymmetricEigen<S, 2> seen = symmetric_eigen<S, 2>(M);
  Matrix common = Matrix::Zero();
  for (int k = 0; k < 2; ++k) {
    const double variance = spread * (std::max)(host_variance, target_variance * seen.values[k]);
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) common(i, j) += variance * seen.vectors(i, k) * seen.vectors(j, k);
  }
  A_transposed << A(0, 0), A(1, 0), A(0, 1), A(1, 1);
  BlurMatch match{common, product(product<S>(A, common), A_transposed)};
  for (int i = 0; i < 2; ++i) {
    match.host(i, i) -= host_variance;
    match.target(i, i) -= target_variance;
  }
  if (!all_finite(match.host) || !all_finite(match.target)) return Status::non_finite;
  *out = match;
  return Status::ok;
}

/// A Gaussian filter on the pixel grid, of a covariance in px^2 (variances are cut at 0 from below and at kMaxVariance
/// from above along the principal axes; what is not finite counts as 0). Weights are means over a pixel and sum to 1.
/// No allocation.
class BlurKernel {
 public:
  static constexpr int kMaxRadius = 8;         ///< px, of the widest kernel.
  static constexpr double kMaxVariance = 9.0;  ///< px^2, of the widest kernel.

  /// The kernel of a covariance in px^2.
  template <class S = double>  // instantiated where it is called: including the header costs little
  explicit BlurKernel(const Matrix2d& covariance) noexcept {
    FixedMatrix<S, 2, 2> finite = covariance;
    if (!all_finite(finite)) finite.setZero();
    // The squares of such numbers are none; the eigenvectors do not depend on the unit.
    double most = 0;
    for (int i = 0; i < 4; ++i) most = (std::max)(most, std::abs(finite(i / 2, i % 2)));
    const double unit = most > 1e100 ? most / 1e100 : 1;
    const SymmetricEigen<S, 2> axes = symmetric_eigen(scaled(1 / unit, finite));
    // The mean over a pixel is a blur, too.
    constexpr double kPixel = 1.0 / 12, kLeast = 1e-3;
    double precision[2];
    for (int k = 0; k < 2; ++k)
      precision[k] = 1.0 / (std::max)((std::min)(unit * axes.values[k], kMaxVariance) - kPixel, kLeast);
    radius_ = (std::min)(kMaxRadius,
                         static_cast<int>(std::ceil(2.7 * std::sqrt(1.0 / (std::min)(precision[0], precision[1])))));
    double sum = 0.0, raw[kSide * kSide];
    for (int y = -radius_; y <= radius_; ++y)
      for (int x = -radius_; x <= radius_; ++x) sum += raw[index(x, y)] = mean(x, y, axes, precision);
    for (int i = 0; i < width() * width(); ++i) weights_[i] = static_cast<float>(raw[i] / sum);
  }

  int radius() const noexcept { return radius_; }                          ///< px: weights beyond it are zero.
  int width() const noexcept { return 2 * radius_ + 1; }                   ///< px: weights in a row.
  float at(int x, int y) const noexcept { return weights_[index(x, y)]; }  ///< |x|, |y| <= radius().

 private:
  static constexpr int kSide = 2 * kMaxRadius + 1;

  int index(int x, int y) const noexcept { return (y + radius_) * width() + x + radius_; }

  template <class S>
  static double mean(int x, int y, const SymmetricEigen<S, 2>& axes, const double* precision) noexcept {
    constexpr int kParts = 4;
    double sum = 0;
    for (int j = 0; j < kParts; ++j)
      for (int i = 0; i < kParts; ++i) {
        const double dx = x + (i + 0.5) / kParts - 0.5, dy = y + (j + 0.5) / kParts - 0.5;
        double exponent = 0;
        for (int k = 0; k < 2; ++k) {
          const double along = axes.vectors(0, k) * dx + axes.vectors(1, k) * dy;
          exponent += along * along * precision[k];
        }
        sum += std::exp(-0.5 * exponent);
      }
    return sum;
  }

  int radius_ = 0;
  float weights_[kSide * kSide] = {};
};

/// Filters images; keeps the memory that this takes. Beyond the image its border pixels go on.
class BlurFilter {
 public:
  /// Writes the filtered pixels [x0, x1) x [y0, y1) of `from` to the same places of `to`, rounded. What of the
  /// rectangle lies outside the image is left out. The rest of `to` stays. invalid_argument for views that are not
  /// valid() or not of one size. Allocates while it meets a larger rectangle than before.
  Status operator()(const ImageView8& from, const BlurKernel& kernel, int x0, int y0, int x1, int y1,
                    const ImageView<std::uint8_t>& to) {
    if (!from.valid() || !to.valid() || to.width() != from.width() || to.height() != from.height())
      return Status::invalid_argument;
    x0 = (std::max)(x0, 0), y0 = (std::max)(y0, 0), x1 = (std::min)(x1, from.width()),
    y1 = (std::min)(y1, from.height());
    if (x0 >= x1 || y0 >= y1) return Status::ok;
    load(from, kernel.radius(), x0, y0, x1, y1);
    for (int y = y0; y < y1; ++y) {
      std::uint8_t* row = to.row(y);
      for (int x = x0; x < x1; x += kBlock) {
        float sum[kBlock];
        block(kernel, x - x0, y - y0, sum);
        for (int k = 0; k < kBlock && x + k < x1; ++k) row[x + k] = static_cast<std::uint8_t>(sum[k] + 0.5F);
      }
    }
    return Status::ok;
  }

  /// The intensities of a patch's level, taken anew from the filtered host image; gradients stay. It must have
  /// been taken at whole pixels of `host`, as select_pixels() gives them; those outside keep their intensity.
  Status operator()(const ImageView8& host, const BlurKernel& kernel, PatchLevel* level) {
    if (!host.valid()) return Status::invalid_argument;
    const std::size_t n = level->x.size();
    int x0 = host.width(), y0 = host.height(), x1 = 0, y1 = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Vector2<float> px = level->taken(i);
      if (!host.contains(px[0], px[1])) continue;
      const int x = static_cast<int>(px[0]), y = static_cast<int>(px[1]);
      x0 = (std::min)(x0, x), y0 = (std::min)(y0, y), x1 = (std::max)(x1, x + 1), y1 = (std::max)(y1, y + 1);
    }
    if (x0 >= x1) return Status::ok;
    load(host, kernel.radius(), x0, y0, x1, y1);
    const int across = (x1 - x0 + kBlock - 1) / kBlock * kBlock;
    reserve(static_cast<std::size_t>(across) * static_cast<std::size_t>(y1 - y0), &filtered_);
    for (int y = y0; y < y1; ++y)
      for (int x = 0; x < across; x += kBlock)
        block(kernel, x, y - y0, &filtered_[static_cast<std::size_t>((y - y0) * across + x)]);
    for (std::size_t i = 0; i < n; ++i) {
      const Vector2<float> px = level->taken(i);
      if (!host.contains(px[0], px[1])) continue;
      const int x = static_cast<int>(px[0]) - x0, y = static_cast<int>(px[1]) - y0;
      level->intensity[i] = filtered_[static_cast<std::size_t>(y * across + x)];
    }
    return Status::ok;
  }

 private:
  static constexpr int kBlock = 8;  // pixels filtered at a time: compilers make vectors of them

  // Made anew, not grown: the function that grows a vector would be shared between translation units (see config.hpp).
  static void reserve(std::size_t n, std::vector<float>* memory) {
    if (memory->size() < n) *memory = std::vector<float>(n);
  }

  // The rectangle and what the filter reaches around it, as floats; rows are padded to whole blocks.
  void load(const ImageView8& from, int radius, int x0, int y0, int x1, int y1) {
    stride_ = (x1 - x0 + kBlock - 1) / kBlock * kBlock + 2 * radius;
    const int rows = y1 - y0 + 2 * radius;
    reserve(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows), &grey_);
    for (int y = 0; y < rows; ++y) {
      const std::uint8_t* row = from.row((std::min)((std::max)(y0 - radius + y, 0), from.height() - 1));
      float* to = &grey_[static_cast<std::size_t>(y * stride_)];
      for (int x = 0; x < stride_; ++x)
        to[x] = static_cast<float>(row[(std::min)((std::max)(x0 - radius + x, 0), from.width() - 1)]);
    }
  }

  void block(const BlurKernel& kernel, int x, int y, float* sum) const noexcept {
    for (int k = 0; k < kBlock; ++k) sum[k] = 0.0F;
    const int r = kernel.radius();
    for (int dy = 0; dy <= 2 * r; ++dy) {
      const float* row = &grey_[static_cast<std::size_t>((y + dy) * stride_ + x)];
      for (int dx = 0; dx <= 2 * r; ++dx) {
        const float weight = kernel.at(dx - r, dy - r);
        for (int k = 0; k < kBlock; ++k) sum[k] += weight * row[dx + k];
      }
    }
  }

  std::vector<float> grey_, filtered_;
  int stride_ = 0;
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_BLUR_HPP
