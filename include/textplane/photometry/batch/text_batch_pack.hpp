// What goes into a batch (simd/batch.hpp) and comes out: the host pixels of an object into its lane, image, camera and
// options of a call, entries of a result.
#ifndef TEXTPLANE_PHOTOMETRY_BATCH_TEXT_BATCH_PACK_HPP
#define TEXTPLANE_PHOTOMETRY_BATCH_TEXT_BATCH_PACK_HPP

#include <algorithm>
#include <cstddef>

#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/photometry/patch.hpp"
#include "textplane/photometry/residual_request.hpp"
#include "textplane/simd/batch.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
// What is masked or not finite is left out.
inline bool is_usable_pixel(const PatchView& patch, int i) noexcept {
  return (!patch.mask || patch.mask[i]) && is_finite(patch.x[i]) && is_finite(patch.y[i]) &&
         is_finite(patch.intensity[i]);
}

inline int usable_pixels(const PatchView& patch) noexcept {
  int n = 0;
  for (int i = 0; i < patch.n; ++i) n += is_usable_pixel(patch, i);
  return n;
}

// Lane `lane` of a group that is zero there. `pixels`: of the group, from its start on.
inline void pack_lane(const PatchView& p, const Pinhole<double>& host_camera, const Vector3<double>& theta, int lane,
                      simd::BatchGroup* group, float* pixels) noexcept {
  int& n = group->n[lane];
  float x0 = 0, x1 = 0, y0 = 0, y1 = 0;
  for (int i = 0; i < p.n; ++i) {
    if (!is_usable_pixel(p, i)) continue;
    x0 = n ? (std::min)(x0, p.x[i]) : p.x[i];
    x1 = n ? (std::max)(x1, p.x[i]) : p.x[i];
    y0 = n ? (std::min)(y0, p.y[i]) : p.y[i];
    y1 = n ? (std::max)(y1, p.y[i]) : p.y[i];
    ++n;
  }
  const float fx = x0 + 0.5F * (x1 - x0), fy = y0 + 0.5F * (y1 - y0);
  const double hx = static_cast<double>(fx), hy = static_cast<double>(fy);
  group->ru[lane] = (std::max)(static_cast<double>(x1) - hx, hx - static_cast<double>(x0));
  group->rv[lane] = (std::max)(static_cast<double>(y1) - hy, hy - static_cast<double>(y0));
  group->ifx[lane] = 1.0 / host_camera.fx;
  group->ify[lane] = 1.0 / host_camera.fy;
  group->mu[lane] = (hx - host_camera.cx) * group->ifx[lane];
  group->mv[lane] = (hy - host_camera.cy) * group->ify[lane];
  for (int k = 0; k < 3; ++k) group->theta[k][lane] = theta[k];
  if (n == 0) return;  // there may be no pixels at all
  float* out = pixels + lane;
  for (int i = 0; i < p.n; ++i) {
    if (!is_usable_pixel(p, i)) continue;
    out[0] = p.x[i] - fx;
    out[simd::kBatchLanes] = p.y[i] - fy;
    out[2 * simd::kBatchLanes] = p.intensity[i];
    out += 3 * simd::kBatchLanes;
  }
}

// Where BatchArgs::out has an entry of an object.
inline std::ptrdiff_t batch_place(int parameters, int object, int entry) noexcept {
  const std::ptrdiff_t row =
      static_cast<std::ptrdiff_t>(object / simd::kBatchLanes) * simd::batch_entries(parameters) + entry;
  return row * simd::kBatchLanes + object % simd::kBatchLanes;
}
inline std::ptrdiff_t batch_place(int parameters, int object, simd::BatchEntry entry) noexcept {
  return batch_place(parameters, object, parameters * (parameters + 1) / 2 + parameters + static_cast<int>(entry));
}

inline simd::Image8 batch_image(const ImageView8& target) noexcept {
  return {target.data(), target.stride(), target.width(), target.height()};
}

// `T_t_h`: one pose an object.
inline void set_batch_args(const ImageView8& target, const Pinhole<double>& camera, const SE3d* T_t_h,
                           const PhotometricOptions& options, simd::BatchArgs* args) noexcept {
  static_assert(sizeof(SE3d) == 12 * sizeof(double), "R column by column, then t");
  args->pose = T_t_h->R.data();
  args->pose_step = 12;
  args->t_offset = 9;
  args->camera[0] = camera.fx;
  args->camera[1] = camera.fy;
  args->camera[2] = camera.cx;
  args->camera[3] = camera.cy;
  args->target = batch_image(target);
  args->exact = options.normalisation == Normalisation::exact;
  args->robust = options.robust.kind;
  args->delta = options.robust.delta;
  args->min_contrast = options.min_contrast;
  args->min_visible = options.min_visible;
}
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_BATCH_TEXT_BATCH_PACK_HPP
