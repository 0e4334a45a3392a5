// ZNCC of one patch under many candidate poses: relocalisation, verification of detections, coarse search.
#ifndef TEXTPLANE_PHOTOMETRY_CANDIDATES_HPP
#define TEXTPLANE_PHOTOMETRY_CANDIDATES_HPP

#include <algorithm>
#include <cstdint>

#include "textplane/photometry/residual.hpp"
#include "textplane/photometry/residual_rows.hpp"
#include "textplane/photometry/template_patch.hpp"
#include "textplane/simd/zncc.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
// zncc_candidates() of a request that was checked, between images that take all rows at once. All of zncc is -1.
TEXTPLANE_DEFERRED
void zncc_between_still(ResidualRequest<std::uint8_t> request, const SE3d* T_t_h, int count,
                        PhotometricWorkspace& workspace, float* zncc, const TemplatePatch* prepared) noexcept {
  const PhotometricInput& in = request.input;
  simd::LensFit fit;
  bool fast = prepared && prepared->size() == in.patch.n && !in.patch.mask && kernels_take(request, workspace);
  // One fit for all candidates; where they see the patch in too many places, each has its own, in evaluate().
  if (fast && in.lens) {
    RayBox all;
    const simd::PointBounds& bounds = prepared->model().bounds;
    for (int i = 0; i < count && fast; ++i) {
      RayBox box;
      fast = ray_box(bounds, in.host_camera, plane_homography(request.theta, T_t_h[i]), &box);
      if (i == 0) all = box;
      all.add(box);
    }
    for (int k = 0; k < 2; ++k) all.middle[k] = 0.5 * (all.low[k] + all.high[k]);
    fast = fast && fit_lens(*in.lens, all, &fit);
  }
  if (fast) {
    simd::ZnccArgs args;
    args.base = kernel_args(request, workspace, nullptr, nullptr);
    if (in.lens) args.base.lens = &fit;
    static_assert(sizeof(SE3d) == 12 * sizeof(double), "R column by column, then t");
    args.model = &prepared->model();
    args.pose = count > 0 ? T_t_h->R.data() : nullptr;
    args.count = count;
    args.values = reinterpret_cast<std::int16_t*>(workspace.more_scratch());
    args.zncc = zncc;
    simd::zncc_candidates(args);
  }
  for (int i = 0; i < count; ++i) {
    if (fast && zncc[i] > simd::kZnccUnknown) continue;
    request.T_t_h = T_t_h[i];
    const PhotometricCost cost = evaluate(request, workspace);
    zncc[i] = is_ok(cost.status) ? static_cast<float>(cost.zncc) : -1.0F;
  }
}
}  // namespace detail

/// zncc[i] = ZNCC of the patch in the target under the pose T_t_h[i], over the pixels visible then; -1 where fewer than
/// options.min_visible are or contrast is missing. `prepared`, of in.patch, makes it several times faster where all of
/// the patch is visible; then the bound of simd/zncc.hpp holds, else that of evaluate(). options.robust has no
/// influence. Rolling shutters of host and target count as in evaluate().
///
/// Status::ok, or what is wrong with all candidates (as check of evaluate(): invalid_argument, non_finite); all are -1
/// then. A candidate that is not finite is -1 too. No allocation; the workspace must have room for the patch.
TEXTPLANE_DEFERRED
Status zncc_candidates(const PhotometricInput& in, const Vector3<double>& theta, const SE3d* T_t_h, int count,
                       const PhotometricOptions& options, PhotometricWorkspace& workspace, float* zncc,
                       const TemplatePatch* prepared = nullptr) noexcept {
  if (count < 0 || (count > 0 && (!T_t_h || !zncc))) return Status::invalid_argument;
  for (int i = 0; i < count; ++i) zncc[i] = -1.0F;
  ResidualRequest<std::uint8_t> request{in, theta, SE3d(), options};
  const Status status = detail::check_request(request, workspace);
  if (!is_ok(status)) return status;
  request.options.robust = Robust{RobustKind::l2, 1.0};
  if (!detail::has_rows(in)) {
    detail::zncc_between_still(request, T_t_h, count, workspace, zncc, prepared);
    return Status::ok;
  }
  // Still images have one plane for all candidates, as the host's rows do not depend on the pose.
  constexpr int kAtOnce = 16;
  SE3d still[kAtOnce];
  request.input.patch.bounds = simd::point_bounds(in.patch.x, in.patch.y, in.patch.n);  // once, not in each RowForm
  for (int first = 0; first < count; first += kAtOnce) {
    const int n = (std::min)(count - first, kAtOnce);
    ResidualRequest<std::uint8_t> form;
    for (int i = 0; i < n; ++i) {
      request.T_t_h = T_t_h[first + i];
      form = detail::RowForm<ResidualRequest<std::uint8_t>>(request).request();
      still[i] = form.T_t_h;
    }
    detail::zncc_between_still(form, still, n, workspace, zncc + first, prepared);
  }
  return Status::ok;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_CANDIDATES_HPP
