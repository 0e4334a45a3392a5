// TemplatePatch: what the template-Jacobian kernels keep of a host patch.
//
// Preparing costs about as much as ten iterations and is done once per object and level. A patch of n pixels takes 42
// bytes a pixel.
#ifndef TEXTPLANE_PHOTOMETRY_TEMPLATE_PATCH_HPP
#define TEXTPLANE_PHOTOMETRY_TEMPLATE_PATCH_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/core/cache_line.hpp"
#include "textplane/core/status.hpp"
#include "textplane/photometry/patch.hpp"
#include "textplane/simd/template.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Owns the prepared form of one level of one host patch. Movable, not copyable; thread-safe to read.
class TemplatePatch {
 public:
  TemplatePatch() = default;
  TemplatePatch(TemplatePatch&&) = default;             ///< Moves what was prepared.
  TemplatePatch& operator=(TemplatePatch&&) = default;  ///< Moves what was prepared.
  TemplatePatch(const TemplatePatch&) = delete;
  TemplatePatch& operator=(const TemplatePatch&) = delete;

  /// Prepares a patch without a mask and with gradients, else invalid_argument; non_finite where a number is;
  /// no_contrast for constant intensities; too_few for an empty one. ready() tells. Allocates where it holds less than
  /// before.
  Status prepare(const PatchView& patch) {
    ready_ = false;
    if (!patch.x || !patch.y || !patch.intensity || !patch.gx || !patch.gy || patch.mask || patch.n < 0)
      return Status::invalid_argument;
    if (patch.n == 0) return Status::too_few;
    model_ = simd::TemplateModel();
    model_.n = patch.n;
    model_.bounds = simd::point_bounds(patch.x, patch.y, patch.n);
    if (model_.bounds.n != patch.n) return Status::non_finite;
    for (int i = 0; i < patch.n; ++i)
      if (!is_finite(patch.intensity[i]) || !is_finite(patch.gx[i]) || !is_finite(patch.gy[i]))
        return Status::non_finite;
    const std::size_t room =
        (static_cast<std::size_t>(patch.n) + simd::kTemplateBlock - 1) / simd::kTemplateBlock * simd::kTemplateBlock;
    floats_ = cache_lines<float>(5 * room);
    rows_ = cache_lines<std::int16_t>(room * simd::kTemplateColumns);
    set_pixels(patch, room);
    if (!set_intensity(patch, numbers(floats_) + 4 * room)) return Status::no_contrast;
    set_derivatives();
    ready_ = true;
    return Status::ok;
  }

  bool ready() const noexcept { return ready_; }               ///< Whether it was prepared.
  int size() const noexcept { return ready_ ? model_.n : 0; }  ///< Pixels that it was prepared of; 0 before.
  /// For the kernels of simd/template.hpp; ready() must be true.
  const simd::TemplateModel& model() const noexcept { return model_; }

 private:
  static constexpr double kRange = 8191;  // of the int16 columns

  std::int16_t& cell(int pixel, int column) noexcept {
    const int block = pixel / simd::kTemplateBlock, lane = pixel % simd::kTemplateBlock;
    return numbers(rows_)[(block * simd::kTemplateColumns + column) * simd::kTemplateBlock + lane];
  }

  // As the kernels compute it (middle_of()); halves are exact, so that how it is compiled makes no difference.
  static float middle(float low, float high) noexcept {
    const float m = 0.5F * low + 0.5F * high;
    return is_finite(m) ? m : 0.0F;
  }

  void set_pixels(const PatchView& patch, std::size_t room) {
    float *u = numbers(floats_), *v = u + room, *gx = v + room, *gy = gx + room;
    const float hx = middle(model_.bounds.x_low, model_.bounds.x_high),
                hy = middle(model_.bounds.y_low, model_.bounds.y_high);
    for (int i = 0; i < patch.n; ++i) {
      u[i] = patch.x[i] - hx;
      v[i] = patch.y[i] - hy;
      gx[i] = patch.gx[i];
      gy[i] = patch.gy[i];
    }
    model_.u = u;
    model_.v = v;
    model_.gx = gx;
    model_.gy = gy;
    model_.intensity = gy + room;
    model_.rows = numbers(rows_);
  }

  // Column 0: centred on the middle of its range, in 1/64 of the intensity's unit, or coarser for ranges above 255.
  // Exact for 8-bit hosts at integer positions.
  bool set_intensity(const PatchView& patch, float* intensity) {
    double low = static_cast<double>(patch.intensity[0]), high = low;
    for (int i = 0; i < patch.n; ++i) {
      low = (std::min)(low, static_cast<double>(patch.intensity[i]));
      high = (std::max)(high, static_cast<double>(patch.intensity[i]));
    }
    const double middle = std::floor(low + high) / 2, reach = (std::max)(high - middle, middle - low);
    if (!(reach > 0)) return false;
    const double scale = (std::min)(64.0, kRange / reach);
    double sum = 0, squares = 0;
    for (int i = 0; i < patch.n; ++i) {
      const double value = std::floor((static_cast<double>(patch.intensity[i]) - middle) * scale + 0.5);
      const double kept = (std::min)((std::max)(value, -kRange), kRange);
      cell(i, 0) = static_cast<std::int16_t>(kept);
      intensity[i] = static_cast<float>(kept);
      sum += kept;
      squares += kept * kept;
    }
    model_.mean = sum / patch.n;
    const double squared_norm = squares - sum * model_.mean;
    if (!(squared_norm > 0)) return false;
    model_.norm = std::sqrt(squared_norm);
    model_.s = model_.norm / scale;
    return true;
  }

  // Columns 1 to 8 and their sums, of what the rounding left.
  void set_derivatives() {
    double largest[8] = {}, sum[8] = {}, with_host[8] = {};
    double j[8];
    for (int i = 0; i < model_.n; ++i) {
      derivatives(i, j);
      for (int k = 0; k < 8; ++k) largest[k] = (std::max)(largest[k], std::abs(j[k]));
    }
    for (int k = 0; k < 8; ++k) model_.step[k] = largest[k] > 0 ? largest[k] / kRange : 1.0;
    for (int i = 0; i < model_.n; ++i) {
      derivatives(i, j);
      const double h = (static_cast<double>(model_.intensity[i]) - model_.mean) / model_.norm;
      for (int k = 0; k < 8; ++k) {
        const double rounded = std::floor(j[k] / model_.step[k] + 0.5);
        cell(i, k + 1) = static_cast<std::int16_t>(rounded);
        j[k] = rounded * model_.step[k];
        sum[k] += j[k];
        with_host[k] += h * j[k];
        for (int l = 0; l <= k; ++l) model_.S[k][l] += j[k] * j[l];
      }
    }
    for (int k = 0; k < 8; ++k) {
      model_.e[k] = sum[k] / model_.n;
      model_.c[k] = with_host[k];
      for (int l = 0; l < k; ++l) model_.S[l][k] = model_.S[k][l];
    }
    const double scale = 1 / (model_.s * model_.s);
    for (int k = 0; k < 8; ++k)
      for (int l = 0; l < 8; ++l) {
        model_.H_frozen[k][l] = scale * model_.S[k][l];
        model_.H_exact[k][l] =
            scale * (model_.S[k][l] - model_.n * model_.e[k] * model_.e[l] - model_.c[k] * model_.c[l]);
      }
  }

  // [A, Au, Av, B, Bu, Bv, Cu, Cv] with A = gx, B = gy, C = Au + Bv.
  void derivatives(int i, double* j) const noexcept {
    const double u = static_cast<double>(model_.u[i]), v = static_cast<double>(model_.v[i]);
    const double a = static_cast<double>(model_.gx[i]), b = static_cast<double>(model_.gy[i]), c = a * u + b * v;
    const double row[8] = {a, a * u, a * v, b, b * u, b * v, c * u, c * v};
    std::copy_n(row, 8, j);
  }

  std::vector<CacheLine<float>> floats_;
  std::vector<CacheLine<std::int16_t>> rows_;
  simd::TemplateModel model_;
  bool ready_ = false;
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_TEMPLATE_PATCH_HPP
