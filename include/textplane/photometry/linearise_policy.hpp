// Whose gradients the normal equations use: the target's (forward), the host's (template Jacobian), or both (ESM).
//
// The residual and its cost are the same for all three, r = I~_host - I~_target; only J differs. With dq as the parameters
// move q = H m~ (docs/equations.md):
//
//   forward            dI = a . dq,            a = dI_target/dq at the warped pixel: the exact derivative of the cost
//   template_jacobian  dI = c . dq,  c = H^-T a_h,  a_h = dI_host/dm~ at the host pixel: where the images match, I_target(H m~)
//                      and I_host(m~) have the same derivatives by m~, and m~ moves by H^-1 dq. Constant but for H^-1
//   esm                the mean of the two normalised rows, which is right to second order near the match
//
// All three vanish together at a perfect match, and away from it the first alone is a gradient: steps of the others must be
// judged by the cost, which the solvers do.
#ifndef TEXTPLANE_PHOTOMETRY_LINEARISE_POLICY_HPP
#define TEXTPLANE_PHOTOMETRY_LINEARISE_POLICY_HPP

#include "textplane/geometry/homography.hpp"
#include "textplane/photometry/residual_passes.hpp"
#include "textplane/photometry/residual_types.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Whose gradients the normal equations use.
enum class LinearisePolicy : std::uint8_t {
  forward,            ///< Gradients of the target: the derivative of the cost itself.
  template_jacobian,  ///< Gradients of the host, prepared once: the cheapest iteration.
  esm,                ///< The mean of both: the widest basin.
  automatic,          ///< A coarse-to-fine solver's choice by level: see policy_at_level().
};

/// What `automatic` means on a pyramid level: ESM on all levels but the finest, where the derivative of the cost itself, forward,
/// ends at its minimum. The other policies are themselves on every level.
constexpr LinearisePolicy policy_at_level(LinearisePolicy policy, int level, int finest_level) noexcept {
  return policy != LinearisePolicy::automatic ? policy
         : level > finest_level               ? LinearisePolicy::esm
                                              : LinearisePolicy::forward;
}

namespace detail {
// Row of dI_host for one pixel by the parameters of H. `inverse` is H^-1, row-major.
template <int P>
void template_row(const Pinhole<double>& host, const double* inverse, double mx, double my, const double* q, double rho,
                  double gx, double gy, const double* t, double* row) noexcept {
  const double au = gx * host.fx, av = gy * host.fy, aw = -(au * mx + av * my);
  double c[3];
  for (int k = 0; k < 3; ++k) c[k] = au * inverse[k] + av * inverse[3 + k] + aw * inverse[6 + k];
  intensity_row<P>(mx, my, q, rho, c, t, row);
}

// Replaces the workspace's rows of dr (policy esm: averages them with) those of the template. The workspace holds residuals
// and normalised target intensities, `visible` the flags of the pixels that these belong to.
template <int P, class T>
void add_template_rows(const BasicPhotometricInput<T>& in, const Vector3<double>& theta, const SE3d& T_t_h,
                       const Matrix3<double>& inverse, double host_s, const PhotometricOptions& options,
                       LinearisePolicy policy, const std::uint8_t* visible, int count,
                       PhotometricWorkspace& workspace) noexcept {
  const Matrix3<double> H = plane_homography(theta, T_t_h);
  const double inv[9] = {inverse(0, 0), inverse(0, 1), inverse(0, 2), inverse(1, 0), inverse(1, 1),
                         inverse(1, 2), inverse(2, 0), inverse(2, 1), inverse(2, 2)};
  const double t[3] = {T_t_h.t[0], T_t_h.t[1], T_t_h.t[2]};
  const double *residual = workspace.host(), *normalised = workspace.target();
  double e[P] = {}, c[P] = {};
  for (int pass = options.normalisation == Normalisation::exact ? 0 : 1; pass < 2; ++pass) {
    double* out = workspace.rows();
    for (int i = 0, k = 0; i < in.patch.n; ++i) {
      if (!visible[i]) continue;
      const Vector3<double> m = in.host_camera.unproject({in.patch.x[i], in.patch.y[i]});
      const double h = residual[k] + normalised[k];
      double row[P], q[3];
      for (int r = 0; r < 3; ++r) q[r] = H(r, 0) * m[0] + H(r, 1) * m[1] + H(r, 2);
      template_row<P>(in.host_camera, inv, m[0], m[1], q, theta.dot(m), in.patch.gx[i], in.patch.gy[i], t, row);
      for (int j = 0; j < P; ++j) {
        if (pass == 0) {
          e[j] += row[j] / count;
          c[j] += h * row[j];
        } else {
          const double mine = -(row[j] - e[j] - h * c[j]) / host_s;
          out[j] = policy == LinearisePolicy::esm ? 0.5 * (out[j] + mine) : mine;
        }
      }
      out += P;
      ++k;
    }
  }
}
}  // namespace detail

namespace reference {

/// Normal equations by a policy, P = 3 theta, 6 (v, omega), 9 (v, omega, theta): the double reference of the fast kernels.
/// LinearisePolicy::forward is linearise_plane(), linearise_pose(), linearise_pose_plane(). The others need the gradients of
/// the patch. Cost, visible set and status as there; besides, invalid_argument for a patch without gradients or the policy
/// `automatic`, non_finite for a gradient that is, behind_camera where the plane passes through the target's camera.
template <int P, class T>
NormalEquations<P> linearise_by(LinearisePolicy policy, const BasicPhotometricInput<T>& in,
                                const Vector3<double>& theta, const SE3d& T_t_h, const PhotometricOptions& options,
                                PhotometricWorkspace& workspace) noexcept {
  NormalEquations<P> out;
  out.status = detail::check_input(in, theta, T_t_h, options, workspace);
  if (!is_ok(out.status)) return out;
  const bool forward = policy == LinearisePolicy::forward;
  Matrix3<double> inverse = Matrix3<double>::Identity();
  if (!forward) {
    out.status = Status::invalid_argument;
    if (policy != LinearisePolicy::template_jacobian && policy != LinearisePolicy::esm) return out;
    if (in.patch.n > 0 && (!in.patch.gx || !in.patch.gy)) return out;
    out.status = plane_homography_inverse(theta, T_t_h, &inverse);
    if (!is_ok(out.status)) return out;
  }
  const std::uint8_t* visible = workspace.visible_flags();
  const detail::Collected seen = detail::collect<P>(in, theta, T_t_h, nullptr, workspace.visible_flags(), workspace);
  out.status = detail::visibility_status(seen, options.min_visible);
  if (!is_ok(out.status)) return out;
  const IntensityStats stats = detail::normalise(seen.visible, options.min_contrast, workspace);
  out.status = stats.status;
  if (!is_ok(out.status)) return out;

  detail::project<P>(seen.visible, stats.s, options.normalisation, workspace);
  if (!forward) {
    const IntensityStats host = intensity_stats(in.patch.intensity, visible, in.patch.n);
    detail::add_template_rows<P>(in, theta, T_t_h, inverse, host.s, options, policy, visible, seen.visible, workspace);
  }
  const detail::WeightedCost sum = detail::weigh(seen.visible, options.robust, workspace);
  detail::accumulate<P>(seen.visible, workspace, &out.H, &out.b);
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

}  // namespace reference

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_LINEARISE_POLICY_HPP
