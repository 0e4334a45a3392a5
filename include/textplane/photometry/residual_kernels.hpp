// The typed side of simd/residual.hpp: which requests the float kernels take, what they are given, and what comes back.
//
// They take 8-bit targets of at least 2 x 2 pixels. The double reference takes all others, and the few cases that float
// does not carry (numbers far out of proportion, a plane through the target's camera centre).
#ifndef TEXTPLANE_PHOTOMETRY_RESIDUAL_KERNELS_HPP
#define TEXTPLANE_PHOTOMETRY_RESIDUAL_KERNELS_HPP

#include <cstdint>

#include "textplane/photometry/lens/lens_fit.hpp"
#include "textplane/photometry/residual_passes.hpp"
#include "textplane/simd/residual.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {

using KernelRequest = ResidualRequest<std::uint8_t>;

/// The target as the kernels read it. Pairs that are not of its size are left out.
inline simd::Image8 kernel_image(const PhotometricInput& in) noexcept {
  const bool fit = in.pairs.data && in.pairs.width == in.target.width() && in.pairs.height == in.target.height();
  const PairView pairs = fit ? in.pairs : PairView();
  return {in.target.data(), in.target.stride(), in.target.width(), in.target.height(), pairs.data, pairs.stride};
}

/// False where the reference must take the call, which also says what is wrong with it. Theta, pose and principal
/// points are not asked: what is not finite there ends in the homography, at which the kernels decline.
TEXTPLANE_SIMD_INLINE bool kernels_take(const KernelRequest& q, const PhotometricWorkspace& workspace) noexcept {
  const PatchView& p = q.input.patch;
  if (!p.x || !p.y || !p.intensity || p.n < 1 || p.n > workspace.capacity() || !q.input.target.valid() ||
      !q.options.valid())
    return false;
  if (q.options.precise) return false;
  const Pinhole<double>&h = q.input.host_camera, &t = q.input.target_camera;
  const std::uint64_t bad = not_finite_bit(h.fx) | not_finite_bit(h.fy) | not_finite_bit(t.fx) | not_finite_bit(t.fy);
  if (bad >> 63 != 0 || !(h.fx > 0 && h.fy > 0 && t.fx > 0 && t.fy > 0)) return false;
  return simd::readable(kernel_image(q.input));
}

/// The arguments of the kernels, for a request that they take. In one expression: zeroing them first takes longer than
/// filling them.
TEXTPLANE_SIMD_INLINE simd::ResidualArgs kernel_args(const KernelRequest& q, PhotometricWorkspace& workspace,
                                                     std::uint8_t* flags, const std::uint8_t* on_set) noexcept {
  const Pinhole<double>&h = q.input.host_camera, &c = q.input.target_camera;
  const PatchView& patch = q.input.patch;
  const double *R = q.T_t_h.R.data(), *t = q.T_t_h.t.data();
  return {patch.x,
          patch.y,
          patch.intensity,
          patch.n,
          patch.mask,
          on_set,
          patch.bounds,
          kernel_image(q.input),
          {R[0], R[3], R[6], R[1], R[4], R[7], R[2], R[5], R[8]},
          {t[0], t[1], t[2]},
          {q.theta[0], q.theta[1], q.theta[2]},
          {h.fx, h.fy, h.cx, h.cy},
          {c.fx, c.fy, c.cx, c.cy},
          nullptr,
          q.options.normalisation == Normalisation::exact,
          q.options.robust.kind,
          q.options.robust.delta,
          q.options.min_contrast,
          q.options.min_visible,
          flags,
          workspace.scratch()};
}

/// Status of a call that the kernels took: the reason why there are too few pixels is in the counts.
inline Status kernel_status(const simd::ResidualInfo& info, int min_visible) noexcept {
  if (info.status != Status::too_few) return info.status;
  return visibility_status({info.candidates, info.behind, info.visible}, min_visible);
}

/// What comes with the sums of the kernels; false where they declined.
inline bool take_info(const simd::ResidualInfo& info, int min_visible, ResidualStats* out) noexcept {
  if (info.status == Status::unsupported) return false;
  out->status = kernel_status(info, min_visible);
  if (!is_ok(out->status)) return true;
  out->cost = info.cost;
  out->error = range_error(info.error);
  out->zncc = 1.0 - 0.5 * out->error;
  out->visible = info.visible;
  out->mean = info.mean;
  out->s = info.s;
  return true;
}

/// Sets args->lens to `fit`, and args->bounds, which the kernels then need not find again. False where no fit holds the
/// lens, and the reference must take the call.
TEXTPLANE_DEFERRED
inline bool fit_request(const KernelRequest& q, simd::ResidualArgs* args, simd::LensFit* fit) noexcept {
  const PatchView& p = q.input.patch;
  if (p.bounds.n != p.n) args->bounds = simd::point_bounds(p.x, p.y, p.n);
  RayBox box;
  if (!ray_box(args->bounds, q.input.host_camera, plane_homography(q.theta, q.T_t_h), &box)) return false;
  args->lens = fit;
  return fit_lens(*q.input.lens, box, fit);
}

/// linearise() by the kernels; false where they do not take the request or declined.
template <Parameters Unknowns>
bool kernel_linearise(const KernelRequest& q, PhotometricWorkspace& workspace,
                      NormalEquations<dof(Unknowns)>* out) noexcept {
  if (!kernels_take(q, workspace)) return false;
  simd::ResidualArgs args = kernel_args(q, workspace, workspace.visible_flags(), nullptr);
  simd::LensFit fit;
  if (q.input.lens && !fit_request(q, &args, &fit)) return false;
  double *H = out->H.data(), *b = out->b.data();
  simd::ResidualInfo info;
  if constexpr (Unknowns == Parameters::plane) simd::linearise_plane(args, &info, H, b);
  if constexpr (Unknowns == Parameters::pose) simd::linearise_pose(args, &info, H, b);
  if constexpr (Unknowns == Parameters::pose_plane) simd::linearise_pose_plane(args, &info, H, b);
  return take_info(info, q.options.min_visible, out);
}

/// evaluate() by the kernels; false where they do not take the request or declined.
TEXTPLANE_DEFERRED
inline bool kernel_evaluate(const KernelRequest& q, PhotometricWorkspace& workspace, const std::uint8_t* on_set,
                            PhotometricCost* out) noexcept {
  if (!kernels_take(q, workspace)) return false;
  simd::ResidualInfo info;
  simd::ResidualArgs args = kernel_args(q, workspace, nullptr, on_set);
  simd::LensFit fit;
  if (q.input.lens && !fit_request(q, &args, &fit)) return false;
  simd::evaluate(args, &info);
  if (info.status == Status::unsupported) return false;
  out->visible = info.visible;
  out->lost = on_set ? info.candidates - info.visible : 0;
  out->status = kernel_status(info, q.options.min_visible);
  if (!is_ok(out->status)) return true;
  if (!is_finite(info.cost) || !is_finite(info.error)) return false;
  out->cost = info.cost + q.options.robust.rho(2.0) * out->lost / info.candidates;
  out->error = range_error(info.error);
  out->zncc = 1.0 - 0.5 * out->error;
  return true;
}

}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_KERNELS_HPP
