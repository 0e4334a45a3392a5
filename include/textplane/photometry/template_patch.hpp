// TemplatePatch: what the template-Jacobian kernels keep of a host patch, and linearise_by(), the normal equations of any
// policy by the fast kernels.
//
// Preparing costs about as much as ten iterations and is done once per object and level. A patch of n pixels takes 42 bytes a
// pixel.
#ifndef TEXTPLANE_PHOTOMETRY_TEMPLATE_PATCH_HPP
#define TEXTPLANE_PHOTOMETRY_TEMPLATE_PATCH_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/core/cache_line.hpp"
#include "textplane/photometry/linearise_policy.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/simd/template.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Owns the prepared form of one level of one host patch. Movable, not copyable; thread-safe to read.
class TemplatePatch {
 public:
  TemplatePatch() = default;
  /// Moves what was prepared.
  TemplatePatch(TemplatePatch&&) = default;
  /// Moves what was prepared.
  TemplatePatch& operator=(TemplatePatch&&) = default;
  TemplatePatch(const TemplatePatch&) = delete;
  TemplatePatch& operator=(const TemplatePatch&) = delete;

  /// Prepares a patch without a mask and with gradients, else invalid_argument; non_finite where a number is; no_contrast for
  /// constant intensities; too_few for an empty one. ready() tells. Allocates where it holds less than before.
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

  /// Whether it was prepared.
  bool ready() const noexcept { return ready_; }
  /// Pixels that it was prepared of; 0 before.
  int size() const noexcept { return ready_ ? model_.n : 0; }
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

  // Column 0: centred on the middle of its range, in 1/64 of the intensity's unit, or coarser for ranges above 255. Exact for
  // 8-bit hosts at integer positions.
  bool set_intensity(const PatchView& patch, float* intensity) {
    double low = static_cast<double>(patch.intensity[0]), high = low;
    for (int i = 0; i < patch.n; ++i) {
      low = std::min(low, static_cast<double>(patch.intensity[i]));
      high = std::max(high, static_cast<double>(patch.intensity[i]));
    }
    const double middle = std::floor(low + high) / 2, reach = std::max(high - middle, middle - low);
    if (!(reach > 0)) return false;
    const double scale = std::min(64.0, kRange / reach);
    double sum = 0, squares = 0;
    for (int i = 0; i < patch.n; ++i) {
      const double value = std::floor((static_cast<double>(patch.intensity[i]) - middle) * scale + 0.5);
      const double kept = std::min(std::max(value, -kRange), kRange);
      cell(i, 0) = static_cast<std::int16_t>(kept);
      intensity[i] = static_cast<float>(kept);
      sum += kept;
      squares += kept * kept;
    }
    model_.mean = sum / patch.n;
    const double spread = squares - sum * model_.mean;
    if (!(spread > 0)) return false;
    model_.norm = std::sqrt(spread);
    model_.s = model_.norm / scale;
    return true;
  }

  // Columns 1 to 8 and their sums, of what the rounding left.
  void set_derivatives() {
    double largest[8] = {}, sum[8] = {}, with_host[8] = {};
    double j[8];
    for (int i = 0; i < model_.n; ++i) {
      derivatives(i, j);
      for (int k = 0; k < 8; ++k) largest[k] = std::max(largest[k], std::abs(j[k]));
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
    for (int k = 0; k < 8; ++k) j[k] = row[k];
  }

  std::vector<CacheLine<float>> floats_;
  std::vector<CacheLine<std::int16_t>> rows_;
  simd::TemplateModel model_;
  bool ready_ = false;
};

namespace detail {
// The block of P parameters out of (v, omega, theta).
template <int P>
void take_block(const double* H, const double* b, NormalEquations<P>* out) noexcept {
  const int at = P == 3 ? 6 : 0;
  for (int c = 0; c < P; ++c) {
    out->b[c] = b[at + c];
    for (int r = 0; r < P; ++r) out->H(r, c) = H[9 * (at + r) + at + c];
  }
}

// False where the kernels declined.
template <int P>
bool kernel_linearise_by(LinearisePolicy policy, const PhotometricInput& in, const Vector3<double>& theta,
                         const SE3d& T_t_h, const PhotometricOptions& options, PhotometricWorkspace& workspace,
                         const TemplatePatch* prepared, NormalEquations<P>* out) noexcept {
  if (!kernels_take(in, options, workspace)) return false;
  const bool esm = policy == LinearisePolicy::esm;
  const simd::EsmArgs args{kernel_args(in, theta, T_t_h, options, workspace, workspace.visible_flags(), nullptr),
                           in.patch.gx, in.patch.gy, esm, workspace.more_scratch()};
  double block_H[81], block_b[9];
  double *H = P == 9 ? out->H.data() : block_H, *b = P == 9 ? out->b.data() : block_b;
  simd::ResidualInfo info;
  info.status = Status::out_of_view;
  if (!esm && prepared && prepared->size() == in.patch.n && !in.patch.mask)
    info = simd::linearise_template(prepared->model(), args.base,
                                    reinterpret_cast<std::int16_t*>(workspace.more_scratch()), H, b);
  // Not all of the patch is visible: the sums of what is.
  if (info.status == Status::out_of_view) info = simd::linearise_esm(args, H, b);
  if (declined(info)) return false;
  take_info(info, options.min_visible, out);
  if (P != 9 && is_ok(out->status)) take_block<P>(H, b, out);
  return true;
}

// The policies with the host's gradients. (A function with one variable to return: it is made where the caller wants it.)
template <int P>
NormalEquations<P> linearise_by_host(LinearisePolicy policy, const PhotometricInput& in, const Vector3<double>& theta,
                                     const SE3d& T_t_h, const PhotometricOptions& options,
                                     PhotometricWorkspace& workspace, const TemplatePatch* prepared) noexcept {
  const bool known = policy == LinearisePolicy::template_jacobian || policy == LinearisePolicy::esm;
  NormalEquations<P> out{Unset()};
  if (!known || !in.patch.gx || !in.patch.gy ||
      !kernel_linearise_by<P>(policy, in, theta, T_t_h, options, workspace, prepared, &out))
    out = reference::linearise_by<P>(policy, in, theta, T_t_h, options, workspace);
  if (!is_ok(out.status)) out.clear();
  return out;
}
}  // namespace detail

/// As reference::linearise_by(), by the SIMD kernels. `prepared`, if given, must be of in.patch; it makes template_jacobian
/// several times faster where all of the patch is visible. Then sums are of host intensities rounded to 1/64 grey level and
/// target intensities within 0.025 of the interpolant (simd/template.hpp): E and the entries of b, in units of sqrt(H_ii), are
/// within 0.08 / sigma of the reference's, sigma being the lesser standard deviation of the two sides, and H within 3e-4 of
/// sqrt(H_ii H_jj) without weights. Otherwise the bounds are those of simd/residual.hpp.
template <int P>
NormalEquations<P> linearise_by(LinearisePolicy policy, const PhotometricInput& in, const Vector3<double>& theta,
                                const SE3d& T_t_h, const PhotometricOptions& options, PhotometricWorkspace& workspace,
                                const TemplatePatch* prepared = nullptr) noexcept {
  static_assert(P == 3 || P == 6 || P == 9, "theta, pose, or pose and theta");
  if (policy == LinearisePolicy::forward) {
    if constexpr (P == 3) return linearise_plane(in, theta, T_t_h, options, workspace);
    if constexpr (P == 6) return linearise_pose(in, theta, T_t_h, options, workspace);
    if constexpr (P == 9) return linearise_pose_plane(in, theta, T_t_h, options, workspace);
  }
  return detail::linearise_by_host<P>(policy, in, theta, T_t_h, options, workspace, prepared);
}
/// Float images have no kernels of their own: by the reference, and nothing prepared is used.
template <int P>
NormalEquations<P> linearise_by(LinearisePolicy policy, const PhotometricInputF& in, const Vector3<double>& theta,
                                const SE3d& T_t_h, const PhotometricOptions& options, PhotometricWorkspace& workspace,
                                const TemplatePatch* = nullptr) noexcept {
  return reference::linearise_by<P>(policy, in, theta, T_t_h, options, workspace);
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_TEMPLATE_PATCH_HPP
