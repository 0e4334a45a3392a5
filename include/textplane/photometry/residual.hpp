// The photometric residual of a planar text object and its normal equations: fast, and as the double reference.
//
// linearise_*(), evaluate() and residuals() run in float vectors where the target is 8-bit and the cost l2 or Huber
// (simd/residual.hpp states the error), and are those of `reference` otherwise. `reference` is double throughout and slow: the
// definition. A pixel within about 1e-4 px of the image's border or of a pixel line may fall on either side of it in the fast form.
//
// Residual of pixel i (docs/equations.md; the paper's E_text): r_i = I~_host(x_i) - I~_target(K pi(H m~_i)), with
// H = R + t theta^T of T_t_h and I~ = (I - mean) / ||I - mean|| over the visible pixels alone, host side included. So r does
// not change with gain and bias of either image. E = sum r^2 is in [0, 4] and ZNCC = 1 - E / 2.
//
// A pixel is visible when it is not masked, its plane point lies in front of both cameras (theta^T m~ > 0, q_z > 0), it
// projects into [0, w - 1] x [0, h - 1] of the target, and both of its intensities are finite.
//
// Parameters: T_t_h <- Exp(xi) T_t_h, left, xi = (v, omega), v in the unit of t and omega in rad; theta additively, in the
// inverse of that unit. Image gradients are those of the bilinear interpolant.
//
// All functions: noexcept, no allocation, thread-safe for distinct workspaces. Status (results are zero unless is_ok):
//   too_few           fewer than options.min_visible visible pixels (or an empty or wholly masked patch)
//   behind_camera     every pixel lies behind a camera          out_of_view    none is visible, for other reasons too
//   no_contrast       options.min_contrast is not reached on either side
//   non_finite        NaN or infinity in theta, pose or camera, or an overflow
//   invalid_argument  null pointers, an image that is not valid(), focal lengths <= 0, bad options, too small a workspace
#ifndef TEXTPLANE_PHOTOMETRY_RESIDUAL_HPP
#define TEXTPLANE_PHOTOMETRY_RESIDUAL_HPP

#include "textplane/geometry/homography.hpp"
#include "textplane/photometry/residual_autodiff.hpp"
#include "textplane/photometry/residual_kernels.hpp"
#include "textplane/photometry/residual_passes.hpp"
#include "textplane/photometry/residual_types.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
template <int P, class T>
NormalEquations<P> linearise(const BasicPhotometricInput<T>& in, const Vector3<double>& theta, const SE3d& T_t_h,
                             const PhotometricOptions& options, PhotometricWorkspace& workspace) noexcept {
  NormalEquations<P> out;
  out.status = check_input(in, theta, T_t_h, options, workspace);
  if (!is_ok(out.status)) return out;
  const Collected seen = collect<P>(in, theta, T_t_h, nullptr, workspace.visible_flags(), workspace);
  out.status = visibility_status(seen, options.min_visible);
  if (!is_ok(out.status)) return out;
  const IntensityStats stats = normalise(seen.visible, options.min_contrast, workspace);
  out.status = stats.status;
  if (!is_ok(out.status)) return out;

  project<P>(seen.visible, stats.s, options.normalisation, workspace);
  const WeightedCost sum = weigh(seen.visible, options.robust, workspace);
  accumulate<P>(seen.visible, workspace, &out.H, &out.b);
  if (!all_finite(out.H) || !all_finite(out.b) || !is_finite(sum.cost)) {
    out = NormalEquations<P>();
    out.status = Status::non_finite;
    return out;
  }
  out.cost = sum.cost;
  out.error = detail::range_error(sum.error);
  out.zncc = 1.0 - 0.5 * out.error;
  out.visible = seen.visible;
  out.mean = stats.mean;
  out.s = stats.s;
  return out;
}

// Three numbers of p and q.
inline double dot3(const double* p, const double* q) noexcept { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

// The equations for (v, omega, theta) seen through d xi(T_t_h) / d (xi_h, xi_t): relative_pose_jacobians(), without products by
// its zeros, and by the target's, which is -I or the negative of the host's.
// (S is double: a template, so that including the header costs little.)
template <class S>
NormalEquations<15> world_parameters(const NormalEquations<9>& inner, const SE3<S>& T_w_h, const SE3<S>& T_w_t,
                                     PerturbationSide side) noexcept {
  NormalEquations<15> out{Unset()};
  out.status = inner.status;
  if (!is_ok(out.status)) {
    out.clear();
    return out;
  }
  const bool right = side == PerturbationSide::right;
  const SE3<S> T_t_w = T_w_t.inverse(), T = right ? T_t_w * T_w_h : T_t_w;
  const Matrix3<S> upper = product(hat(T.t), T.R);
  // Of the adjoint: columns 0 to 2 are (R_k, 0), columns 3 to 5 are (X_k, R_k). W is its transpose times the pose's rows.
  const S *R = T.R.data(), *X = upper.data(), *H = inner.H.data(), *b = inner.b.data();
  double W[6][9], *to = out.H.data();
  for (int i = 0; i < 3; ++i) {
    for (int c = 0; c < 9; ++c) {
      W[i][c] = dot3(R + 3 * i, H + 9 * c);
      W[3 + i][c] = dot3(X + 3 * i, H + 9 * c) + dot3(R + 3 * i, H + 9 * c + 3);
    }
    out.b[i] = dot3(R + 3 * i, b);
    out.b[3 + i] = dot3(X + 3 * i, b) + dot3(R + 3 * i, b + 3);
    out.b[12 + i] = b[6 + i];
  }
  for (int i = 0; i < 6; ++i) {
    out.b[6 + i] = right ? -b[i] : -out.b[i];
    for (int j = 0; j <= i; ++j)
      to[15 * i + j] = to[15 * j + i] =
          j < 3 ? dot3(W[i], R + 3 * j) : dot3(W[i], X + 3 * j - 9) + dot3(W[i] + 3, R + 3 * j - 9);
  }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      to[15 * i + 6 + j] = to[15 * (6 + j) + i] = right ? -W[i][j] : -to[15 * i + j];
      to[15 * (6 + i) + 6 + j] = right ? H[9 * i + j] : to[15 * i + j];
    }
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 6; ++i) {
      to[15 * i + 12 + k] = to[15 * (12 + k) + i] = W[i][6 + k];
      to[15 * (6 + i) + 12 + k] = to[15 * (12 + k) + 6 + i] = right ? -H[9 * i + 6 + k] : -W[i][6 + k];
    }
    for (int l = 0; l < 3; ++l) to[15 * (12 + l) + 12 + k] = H[9 * (6 + l) + 6 + k];
  }
  std::uint64_t bad = 0;
  for (int i = 0; i < 225; ++i) bad |= not_finite_bit(to[i]);
  for (int i = 0; i < 15; ++i) bad |= not_finite_bit(out.b[i]);
  if (bad >> 63 != 0) {
    out = NormalEquations<15>();
    out.status = Status::non_finite;
    return out;
  }
  out.cost = inner.cost;
  out.error = inner.error;
  out.zncc = inner.zncc;
  out.visible = inner.visible;
  out.mean = inner.mean;
  out.s = inner.s;
  return out;
}
}  // namespace detail

namespace reference {

/// Normal equations for the pose, parameters (v, omega).
template <class T>
NormalEquations<6> linearise_pose(const BasicPhotometricInput<T>& input, const Vector3<double>& theta,
                                  const SE3d& T_t_h, const PhotometricOptions& options,
                                  PhotometricWorkspace& workspace) noexcept {
  return detail::linearise<6>(input, theta, T_t_h, options, workspace);
}

/// Normal equations for the plane, parameters theta.
template <class T>
NormalEquations<3> linearise_plane(const BasicPhotometricInput<T>& input, const Vector3<double>& theta,
                                   const SE3d& T_t_h, const PhotometricOptions& options,
                                   PhotometricWorkspace& workspace) noexcept {
  return detail::linearise<3>(input, theta, T_t_h, options, workspace);
}

/// Normal equations for both, parameters (v, omega, theta).
template <class T>
NormalEquations<9> linearise_pose_plane(const BasicPhotometricInput<T>& input, const Vector3<double>& theta,
                                        const SE3d& T_t_h, const PhotometricOptions& options,
                                        PhotometricWorkspace& workspace) noexcept {
  return detail::linearise<9>(input, theta, T_t_h, options, workspace);
}

/// Normal equations for the world poses of host and target and the plane, parameters (xi_h, xi_t, theta). Each pose is
/// perturbed on the given side: T_w_x <- Exp(xi_x) T_w_x or T_w_x <- T_w_x Exp(xi_x).
///
/// All of it acts through T_t_h = T_w_t^-1 T_w_h and theta, so the sums are those of linearise_pose_plane() seen through the
/// constant d xi(T_t_h) / d (xi_h, xi_t). H therefore has rank 9 at most.
template <class T>
NormalEquations<15> linearise_host_target_plane(const BasicPhotometricInput<T>& input, const Vector3<double>& theta,
                                                const SE3d& T_w_h, const SE3d& T_w_t, PerturbationSide side,
                                                const PhotometricOptions& options,
                                                PhotometricWorkspace& workspace) noexcept {
  const SE3d T_t_h = T_w_t.inverse() * T_w_h;
  return detail::world_parameters(detail::linearise<9>(input, theta, T_t_h, options, workspace), T_w_h, T_w_t, side);
}

/// The cost alone. With `on_set` (a byte a pixel, usually workspace.visible() after a linearisation) a trial step is judged
/// on that set: pixels outside of it are ignored, and each of its pixels that is not visible now costs what an uncorrelated
/// pixel would, rho(2) / N_set in the unit of `cost` (two uncorrelated patches of N pixels have r^2 = 2 / N on average), and
/// is counted in `lost`. error and zncc are of the visible pixels alone. The workspace's visible() stays as it is.
template <class T>
PhotometricCost evaluate(const BasicPhotometricInput<T>& input, const Vector3<double>& theta, const SE3d& T_t_h,
                         const PhotometricOptions& options, PhotometricWorkspace& workspace,
                         const std::uint8_t* on_set = nullptr) noexcept {
  PhotometricCost out;
  out.status = detail::check_input(input, theta, T_t_h, options, workspace);
  if (!is_ok(out.status)) return out;
  const detail::Collected seen = detail::collect<0>(input, theta, T_t_h, on_set, nullptr, workspace);
  out.visible = seen.visible;
  out.lost = on_set ? seen.candidates - seen.visible : 0;
  out.status = detail::visibility_status(seen, options.min_visible);
  if (!is_ok(out.status)) return out;
  out.status = detail::normalise(seen.visible, options.min_contrast, workspace).status;
  if (!is_ok(out.status)) return out;
  const detail::WeightedCost sum = detail::weigh(seen.visible, options.robust, workspace);
  out.cost = sum.cost + options.robust.rho(2.0) * out.lost / seen.candidates;
  out.error = detail::range_error(sum.error);
  out.zncc = 1.0 - 0.5 * out.error;
  return out;
}

/// The residuals themselves, without weights, for other solvers: r receives one number a pixel of the patch (patch.n), and J,
/// unless null, patch.n rows of P derivatives, row-major: P = 3 theta, 6 (v, omega), 9 (v, omega, theta). A pixel that is not
/// visible has residual and row zero; all have unless is_ok(status) and n, r are valid. workspace.visible() tells which.
template <int P, class T>
ResidualSummary residuals(const BasicPhotometricInput<T>& input, const Vector3<double>& theta, const SE3d& T_t_h,
                          const PhotometricOptions& options, PhotometricWorkspace& workspace, double* r,
                          double* J) noexcept {
  static_assert(P == 3 || P == 6 || P == 9, "textplane: P is 3 (theta), 6 (pose) or 9 (pose and theta)");
  ResidualSummary out;
  if (!r || input.patch.n < 0) return out;
  for (int i = 0; i < input.patch.n; ++i) r[i] = 0.0;
  if (J)
    for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(input.patch.n) * P; ++i) J[i] = 0.0;

  out.status = detail::check_input(input, theta, T_t_h, options, workspace);
  if (!is_ok(out.status)) return out;
  const std::uint8_t* visible = workspace.visible();
  const detail::Collected seen = detail::collect<P>(input, theta, T_t_h, nullptr, workspace.visible_flags(), workspace);
  out.visible = seen.visible;
  out.status = detail::visibility_status(seen, options.min_visible);
  if (!is_ok(out.status)) return out;
  const IntensityStats stats = detail::normalise(seen.visible, options.min_contrast, workspace);
  out.status = stats.status;
  if (!is_ok(out.status)) return out;
  out.mean = stats.mean;
  out.s = stats.s;
  if (J) detail::project<P>(seen.visible, stats.s, options.normalisation, workspace);

  const double *residual = workspace.host(), *row = workspace.rows();
  for (int i = 0; i < input.patch.n; ++i) {
    if (!visible[i]) continue;
    r[i] = *residual++;
    if (!J) continue;
    for (int j = 0; j < P; ++j) J[static_cast<std::ptrdiff_t>(i) * P + j] = row[j];
    row += P;
  }
  return out;
}

}  // namespace reference

namespace detail {
// Kernels where they take the call, the reference where not.
template <int P, class T>
NormalEquations<P> fast_linearise(const BasicPhotometricInput<T>& in, const Vector3<double>& theta, const SE3d& T_t_h,
                                  const PhotometricOptions& options, PhotometricWorkspace& workspace) noexcept {
  NormalEquations<P> out{Unset()};
  bool taken = false;
  if constexpr (std::is_same<T, std::uint8_t>::value) {
    taken = kernel_linearise<P>(in, theta, T_t_h, options, workspace, &out);
  }
  if (!taken) out = linearise<P>(in, theta, T_t_h, options, workspace);
  if (!is_ok(out.status)) out.clear();
  return out;
}
}  // namespace detail

/// Normal equations for the pose, parameters (v, omega).
template <class T>
NormalEquations<6> linearise_pose(const BasicPhotometricInput<T>& input, const Vector3<double>& theta,
                                  const SE3d& T_t_h, const PhotometricOptions& options,
                                  PhotometricWorkspace& workspace) noexcept {
  return detail::fast_linearise<6>(input, theta, T_t_h, options, workspace);
}

/// Normal equations for the plane, parameters theta.
template <class T>
NormalEquations<3> linearise_plane(const BasicPhotometricInput<T>& input, const Vector3<double>& theta,
                                   const SE3d& T_t_h, const PhotometricOptions& options,
                                   PhotometricWorkspace& workspace) noexcept {
  return detail::fast_linearise<3>(input, theta, T_t_h, options, workspace);
}

/// Normal equations for both, parameters (v, omega, theta).
template <class T>
NormalEquations<9> linearise_pose_plane(const BasicPhotometricInput<T>& input, const Vector3<double>& theta,
                                        const SE3d& T_t_h, const PhotometricOptions& options,
                                        PhotometricWorkspace& workspace) noexcept {
  return detail::fast_linearise<9>(input, theta, T_t_h, options, workspace);
}

/// Normal equations for the world poses of host and target and the plane: see reference::linearise_host_target_plane().
template <class T>
NormalEquations<15> linearise_host_target_plane(const BasicPhotometricInput<T>& input, const Vector3<double>& theta,
                                                const SE3d& T_w_h, const SE3d& T_w_t, PerturbationSide side,
                                                const PhotometricOptions& options,
                                                PhotometricWorkspace& workspace) noexcept {
  const SE3d T_t_h = T_w_t.inverse() * T_w_h;
  return detail::world_parameters(detail::fast_linearise<9>(input, theta, T_t_h, options, workspace), T_w_h, T_w_t,
                                  side);
}

/// The cost alone: see reference::evaluate().
template <class T>
PhotometricCost evaluate(const BasicPhotometricInput<T>& input, const Vector3<double>& theta, const SE3d& T_t_h,
                         const PhotometricOptions& options, PhotometricWorkspace& workspace,
                         const std::uint8_t* on_set = nullptr) noexcept {
  if constexpr (std::is_same<T, std::uint8_t>::value) {
    PhotometricCost out;
    if (detail::kernel_evaluate(input, theta, T_t_h, options, workspace, on_set, &out)) return out;
  }
  return reference::evaluate(input, theta, T_t_h, options, workspace, on_set);
}

#if defined(TEXTPLANE_EXTERN_KERNELS)
TEXTPLANE_INSTANCE NormalEquations<6> linearise_pose<std::uint8_t>(const BasicPhotometricInput<std::uint8_t>&,
                                                                   const Vector3<double>&, const SE3d&,
                                                                   const PhotometricOptions&,
                                                                   PhotometricWorkspace&) noexcept;
TEXTPLANE_INSTANCE NormalEquations<3> linearise_plane<std::uint8_t>(const BasicPhotometricInput<std::uint8_t>&,
                                                                    const Vector3<double>&, const SE3d&,
                                                                    const PhotometricOptions&,
                                                                    PhotometricWorkspace&) noexcept;
TEXTPLANE_INSTANCE NormalEquations<9> linearise_pose_plane<std::uint8_t>(const BasicPhotometricInput<std::uint8_t>&,
                                                                         const Vector3<double>&, const SE3d&,
                                                                         const PhotometricOptions&,
                                                                         PhotometricWorkspace&) noexcept;
TEXTPLANE_INSTANCE NormalEquations<15> linearise_host_target_plane<std::uint8_t>(
    const BasicPhotometricInput<std::uint8_t>&, const Vector3<double>&, const SE3d&, const SE3d&, PerturbationSide,
    const PhotometricOptions&, PhotometricWorkspace&) noexcept;
TEXTPLANE_INSTANCE PhotometricCost evaluate<std::uint8_t>(const BasicPhotometricInput<std::uint8_t>&,
                                                          const Vector3<double>&, const SE3d&,
                                                          const PhotometricOptions&, PhotometricWorkspace&,
                                                          const std::uint8_t*) noexcept;
#endif

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_HPP
