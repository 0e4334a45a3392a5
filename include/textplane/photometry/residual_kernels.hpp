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

/// The pairs of the target, where they are of its size.
inline PairView matching_pairs(const PhotometricInput& in) noexcept {
  const bool fit = in.pairs.data && in.pairs.width == in.target.width() && in.pairs.height == in.target.height();
  return fit ? in.pairs : PairView();
}

/// False where the reference must take the call, which also says what is wrong with it. Of theta, pose and principal points
/// nothing is asked here: what is not finite there ends in the homography, at which the kernels decline.
TEXTPLANE_SIMD_INLINE bool kernels_take(const PhotometricInput& in, const PhotometricOptions& options,
                                        const PhotometricWorkspace& workspace) noexcept {
  const PatchView& p = in.patch;
  if (!p.x || !p.y || !p.intensity || p.n < 1 || p.n > workspace.capacity() || !in.target.valid() || !options.valid())
    return false;
  if (options.precise || (options.robust.kind != RobustKind::huber && options.robust.kind != RobustKind::l2))
    return false;
  const Pinhole<double>&h = in.host_camera, &t = in.target_camera;
  const std::uint64_t bad = not_finite_bit(h.fx) | not_finite_bit(h.fy) | not_finite_bit(t.fx) | not_finite_bit(t.fy);
  if (bad >> 63 != 0 || !(h.fx > 0 && h.fy > 0 && t.fx > 0 && t.fy > 0)) return false;
  const PairView pairs = matching_pairs(in);
  return simd::readable(
      {in.target.data(), in.target.stride(), in.target.width(), in.target.height(), pairs.data, pairs.stride});
}

/// The arguments of the kernels, for a call that they take. In one expression: zeroing them first takes longer than filling them.
TEXTPLANE_SIMD_INLINE simd::ResidualArgs kernel_args(const PhotometricInput& in, const Vector3<double>& theta,
                                                     const SE3d& T_t_h, const PhotometricOptions& options,
                                                     PhotometricWorkspace& workspace, std::uint8_t* flags,
                                                     const std::uint8_t* on_set) noexcept {
  const Pinhole<double>&h = in.host_camera, &c = in.target_camera;
  const PairView pairs = matching_pairs(in);
  const double *R = T_t_h.R.data(), *t = T_t_h.t.data();
  return {in.patch.x,
          in.patch.y,
          in.patch.intensity,
          in.patch.n,
          in.patch.mask,
          on_set,
          in.patch.bounds,
          {in.target.data(), in.target.stride(), in.target.width(), in.target.height(), pairs.data, pairs.stride},
          {R[0], R[3], R[6], R[1], R[4], R[7], R[2], R[5], R[8]},
          {t[0], t[1], t[2]},
          {theta[0], theta[1], theta[2]},
          {h.fx, h.fy, h.cx, h.cy},
          {c.fx, c.fy, c.cx, c.cy},
          options.normalisation == Normalisation::exact,
          static_cast<simd::RobustKind>(options.robust.kind),
          options.robust.delta,
          options.min_contrast,
          options.min_visible,
          flags,
          workspace.scratch()};
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
  out->error = range_error(info.error);
  out->zncc = 1.0 - 0.5 * out->error;
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

/// linearise() by the kernels; false where they do not take the call or declined, and then *out is to be made anew.
template <int P>
bool kernel_linearise(const PhotometricInput& in, const Vector3<double>& theta, const SE3d& T_t_h,
                      const PhotometricOptions& options, PhotometricWorkspace& workspace,
                      NormalEquations<P>* out) noexcept {
  if (!kernels_take(in, options, workspace)) return false;
  const simd::ResidualArgs args = kernel_args(in, theta, T_t_h, options, workspace, workspace.visible_flags(), nullptr);
  const simd::ResidualInfo info = kernel_sums<P>(args, out->H.data(), out->b.data());
  if (declined(info)) return false;
  take_info(info, options.min_visible, out);
  return true;
}

/// evaluate() by the kernels; false where they do not take the call or declined.
inline bool kernel_evaluate(const PhotometricInput& in, const Vector3<double>& theta, const SE3d& T_t_h,
                            const PhotometricOptions& options, PhotometricWorkspace& workspace,
                            const std::uint8_t* on_set, PhotometricCost* out) noexcept {
  if (!kernels_take(in, options, workspace)) return false;
  const simd::ResidualInfo info = simd::evaluate(kernel_args(in, theta, T_t_h, options, workspace, nullptr, on_set));
  if (declined(info)) return false;
  out->visible = info.visible;
  out->lost = on_set ? info.candidates - info.visible : 0;
  out->status = kernel_status(info, options.min_visible);
  if (!is_ok(out->status)) return true;
  if (!is_finite(info.cost) || !is_finite(info.error)) return false;
  out->cost = info.cost + options.robust.rho(2.0) * out->lost / info.candidates;
  out->error = range_error(info.error);
  out->zncc = 1.0 - 0.5 * out->error;
  return true;
}

}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_KERNELS_HPP
