// ZNCC of one patch under many candidate poses: relocalisation, verification of detections, coarse search.
#ifndef TEXTPLANE_PHOTOMETRY_CANDIDATES_HPP
#define TEXTPLANE_PHOTOMETRY_CANDIDATES_HPP

#include <cstdint>

#include "textplane/photometry/residual.hpp"
#include "textplane/photometry/template_patch.hpp"
#include "textplane/simd/zncc.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// zncc[i] = ZNCC of the patch in the target under the pose T_t_h[i], over the pixels visible then; -1 where fewer than
/// options.min_visible are or contrast is missing. `prepared`, of in.patch, makes it several times faster where all of
/// the patch is visible; then the bound of simd/zncc.hpp holds, else that of evaluate(). options.robust has no
/// influence.
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

  simd::LensFit fit;
  bool fast = prepared && prepared->size() == in.patch.n && !in.patch.mask && detail::kernels_take(request, workspace);
  // One fit for all candidates; where they see the patch in too many places, each has its own, in evaluate().
  if (fast && in.lens) {
    detail::RayBox all;
    const simd::PointBounds& bounds = prepared->model().bounds;
    for (int i = 0; i < count && fast; ++i) {
      detail::RayBox box;
      fast = detail::ray_box(bounds, in.host_camera, plane_homography(theta, T_t_h[i]), &box);
      if (i == 0) all = box;
      all.add(box);
    }
    for (int k = 0; k < 2; ++k) all.middle[k] = 0.5 * (all.low[k] + all.high[k]);
    fast = fast && detail::fit_lens(*in.lens, all, &fit);
  }
  if (fast) {
    simd::ZnccArgs args;
    args.base = detail::kernel_args(request, workspace, nullptr, nullptr);
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
  return Status::ok;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_CANDIDATES_HPP
