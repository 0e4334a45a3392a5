// The typed side of simd/residual.hpp: which calls the float kernels take, what they are given, and what comes back.
//
// They take 8-bit targets of at least 2 x 2 pixels with l2 or Huber. All else, and the few cases that float does not carry
// (numbers far out of proportion, a plane through the target's camera centre), is the double reference's.
#ifndef TEXTPLANE_PHOTOMETRY_RESIDUAL_KERNELS_HPP
#define TEXTPLANE_PHOTOMETRY_RESIDUAL_KERNELS_HPP

#include "textplane/core/se3.hpp"
#include "textplane/photometry/residual_passes.hpp"
#include "textplane/photometry/residual_types.hpp"
#include "textplane/simd/residual.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {

/// Fills the arguments of the kernels. False where the reference must take the call. The input has passed check_input().
TEXTPLANE_SIMD_INLINE bool kernel_args(const PhotometricInput& in, const Vector3<double>& theta, const SE3d& T_t_h,
                        const PhotometricOptions& options, PhotometricWorkspace& workspace,
                        simd::ResidualArgs* a) noexcept {
  if (options.precise || (options.robust.kind != RobustKind::huber && options.robust.kind != RobustKind::l2))
    return false;
  a->target.data = in.target.data();
  a->target.stride = in.target.stride();
  a->target.width = in.target.width();
  a->target.height = in.target.height();
  if (in.pairs.data && in.pairs.width == a->target.width && in.pairs.height == a->target.height) {
    a->target.pairs = in.pairs.data;
    a->target.pair_stride = in.pairs.stride;
  }
  if (!simd::readable(a->target) || in.patch.n < 1) return false;
  a->x = in.patch.x;
  a->y = in.patch.y;
  a->intensity = in.patch.intensity;
  a->mask = in.patch.mask;
  a->n = in.patch.n;
  a->bounds = in.patch.bounds;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) a->R[3 * r + c] = T_t_h.R(r, c);
    a->t[r] = T_t_h.t[r];
    a->theta[r] = theta[r];
  }
  const Pinhole<double>&h = in.host_camera, &t = in.target_camera;
  a->host_camera[0] = h.fx;
  a->host_camera[1] = h.fy;
  a->host_camera[2] = h.cx;
  a->host_camera[3] = h.cy;
  a->target_camera[0] = t.fx;
  a->target_camera[1] = t.fy;
  a->target_camera[2] = t.cx;
  a->target_camera[3] = t.cy;
  a->exact = options.normalisation == Normalisation::exact;
  a->huber = options.robust.kind == RobustKind::huber;
  a->delta = options.robust.delta;
  a->min_contrast = options.min_contrast;
  a->min_visible = options.min_visible;
  a->scratch = workspace.scratch();
  return true;
}

/// rank_deficient is how the kernels decline.
inline bool declined(const simd::ResidualInfo& info) noexcept { return info.status == Status::rank_deficient; }

/// Status of a call that the kernels took: the reason why there are too few pixels is in the counts.
inline Status kernel_status(const simd::ResidualInfo& info, int min_visible) noexcept {
  if (info.status != Status::too_few) return info.status;
  return visibility_status({info.candidates, info.behind, info.visible}, min_visible);
}

/// All but H and b, for a call that the kernels took.
template <int P>
void take_info(const simd::ResidualInfo& info, int min_visible, NormalEquations<P>* out) noexcept {
  out->status = kernel_status(info, min_visible);
  if (!is_ok(out->status)) return;
  out->cost = info.cost;
  out->error = info.error;
  out->zncc = 1.0 - 0.5 * info.error;
  out->visible = info.visible;
  out->mean = info.mean;
  out->s = info.s;
}

template <int P>
simd::ResidualInfo kernel_sums(const simd::ResidualArgs& args, double* H, double* b) noexcept {
  if constexpr (P == 3) return simd::linearise_plane(args, H, b);
  if constexpr (P == 6) return simd::linearise_pose(args, H, b);
  if constexpr (P == 9) return simd::linearise_pose_plane(args, H, b);
}

/// linearise() by the kernels; false where they declined, and then *out is to be made anew.
template <int P>
bool kernel_linearise(const PhotometricInput& in, const Vector3<double>& theta, const SE3d& T_t_h,
                      const PhotometricOptions& options, PhotometricWorkspace& workspace,
                      NormalEquations<P>* out) noexcept {
  simd::ResidualArgs args;
  if (!kernel_args(in, theta, T_t_h, options, workspace, &args)) return false;
  args.flags = workspace.visible_flags();
  const simd::ResidualInfo info = kernel_sums<P>(args, out->H.data(), out->b.data());
  if (declined(info)) return false;
  take_info(info, options.min_visible, out);
  return true;
}

/// evaluate() by the kernels; false where they declined.
inline bool kernel_evaluate(const PhotometricInput& in, const Vector3<double>& theta, const SE3d& T_t_h,
                            const PhotometricOptions& options, PhotometricWorkspace& workspace,
                            const std::uint8_t* on_set, PhotometricCost* out) noexcept {
  simd::ResidualArgs args;
  if (!kernel_args(in, theta, T_t_h, options, workspace, &args)) return false;
  args.on_set = on_set;
  const simd::ResidualInfo info = simd::evaluate(args);
  if (declined(info)) return false;
  out->visible = info.visible;
  out->lost = on_set ? info.candidates - info.visible : 0;
  out->status = kernel_status(info, options.min_visible);
  if (!is_ok(out->status)) return true;
  if (!is_finite(info.cost) || !is_finite(info.error)) return false;
  out->cost = info.cost + options.robust.rho(2.0) * out->lost / info.candidates;
  out->error = info.error;
  out->zncc = 1.0 - 0.5 * info.error;
  return true;
}

}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_KERNELS_HPP
