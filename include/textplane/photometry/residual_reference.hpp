// The double reference of the photometric residual and its normal equations: slow, and the definition of what the
// kernels do.
//
// All functions: noexcept, no allocation, thread-safe for distinct workspaces; what residual.hpp says of r, visibility
// and status holds.
#ifndef TEXTPLANE_PHOTOMETRY_RESIDUAL_REFERENCE_HPP
#define TEXTPLANE_PHOTOMETRY_RESIDUAL_REFERENCE_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/photometry/residual_hybrid.hpp"
#include "textplane/photometry/residual_passes.hpp"
#include "textplane/photometry/residual_rows.hpp"
#include "textplane/photometry/world_parameters.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
// What all functions of the reference begin with. With status ok the workspace holds residuals, normalised target
// intensities, and rows of dI for P parameters.
struct Preamble {
  Status status = Status::invalid_argument;
  Path path = Path::kernel;
  Collected seen;
  IntensityStats target, host;
};
template <int P, class T>
Preamble begin(const ResidualRequest<T>& q, const std::uint8_t* on_set, std::uint8_t* flags,
               PhotometricWorkspace& workspace) noexcept {
  Preamble out;
  out.status = check_request(q, workspace);
  if (!is_ok(out.status)) return out;
  out.path = Path::reference;
  out.seen = collect<P>(q, on_set, flags, workspace);
  out.status = visibility_status(out.seen, q.options.min_visible);
  if (is_ok(out.status))
    out.status = normalise(out.seen.visible, q.options.min_contrast, workspace, &out.target, &out.host);
  return out;
}

// ok, or why derivatives by the policy do not exist. *inverse receives H^-1, which the host's gradients need.
template <class T>
Status check_policy(const PolicyRequest<T>& q, Matrix3<double>* inverse) noexcept {
  if (q.policy == LinearisePolicy::forward) return Status::ok;
  if (q.policy == LinearisePolicy::hybrid && !takes_hybrid(q, q.input.patch.n)) return Status::ok;
  if (q.policy >= LinearisePolicy::automatic) return Status::invalid_argument;
  if (q.input.patch.n > 0 && (!q.input.patch.gx || !q.input.patch.gy)) return Status::invalid_argument;
  return plane_homography_inverse(q.theta, q.T_t_h, inverse);
}

// Replaces the workspace's rows of dr (ESM: averages them with) those of the host's gradients.
template <int P, class T>
void add_host_rows(const PolicyRequest<T>& request, const Matrix3<double>& inverse, double host_s, int count,
                   PhotometricWorkspace& workspace) noexcept {
  const Pinhole<double>& camera = request.input.host_camera;
  const PatchView& patch = request.input.patch;
  const Matrix3<double> H = plane_homography(request.theta, request.T_t_h);
  const std::uint8_t* visible = workspace.visible();
  const double *t = request.T_t_h.t.data(), *residual = workspace.residuals(), *normalised = workspace.intensities();
  double e[kLength<P>] = {}, c[kLength<P>] = {};
  // The first pass sums what the exact normalisation projects out.
  for (int pass = request.options.normalisation == Normalisation::exact ? 0 : 1; pass < 2; ++pass) {
    double* out = workspace.rows();
    for (int i = 0, k = 0; i < patch.n; ++i) {
      if (!visible[i]) continue;
      const Vector3<double> m = camera.unproject({patch.x[i], patch.y[i]});
      const double h = residual[k] + normalised[k];
      const double au = static_cast<double>(patch.gx[i]) * camera.fx, av = static_cast<double>(patch.gy[i]) * camera.fy;
      const double aw = -(au * m[0] + av * m[1]);
      double row[kLength<P>], q[3], a[3];
      for (int j = 0; j < 3; ++j) {
        q[j] = H(j, 0) * m[0] + H(j, 1) * m[1] + H(j, 2);
        a[j] = au * inverse(0, j) + av * inverse(1, j) + aw * inverse(2, j);
      }
      intensity_row<P>(m[0], m[1], q, request.theta.dot(m), a, t, row);
      for (int j = 0; j < P; ++j) {
        if (pass == 0) {
          e[j] += row[j] / count;
          c[j] += h * row[j];
        } else {
          const double mine = -(row[j] - e[j] - h * c[j]) / host_s;
          out[j] = request.policy == LinearisePolicy::esm ? 0.5 * (out[j] + mine) : mine;
        }
      }
      out += P;
      ++k;
    }
  }
}
}  // namespace detail

namespace reference {

/// Normal equations with derivatives by a policy. The cost, the visible set and the status are those of the policy
/// `forward`; besides, invalid_argument for a patch without gradients or the policy `automatic`, non_finite for a
/// gradient that is, behind_camera where the plane passes through the target's camera.
template <Parameters Unknowns, class T>
NormalEquations<dof(Unknowns)> linearise(const PolicyRequest<T>& request, PhotometricWorkspace& workspace) noexcept {
  NormalEquations<dof(Unknowns)> out;
  if constexpr (Unknowns == Parameters::host_target_plane) {
    detail::world_parameters(reference::linearise<Parameters::pose_plane>(request, workspace), request, &out);
    if (!is_ok(out.status)) out.clear();
  } else if (detail::has_rows(request.input)) {
    const detail::RowForm<PolicyRequest<T>> still(request);
    out = reference::linearise<Unknowns>(still.request(), workspace);
    still.template pull_back<Unknowns>(&out);
  } else {
    constexpr int P = dof(Unknowns);
    Matrix3<double> inverse;
    out.status = detail::check_request(request, workspace);
    if (is_ok(out.status)) out.status = detail::check_policy(request, &inverse);
    if (!is_ok(out.status)) return out;
    const auto start = detail::begin<P>(request, nullptr, workspace.visible_flags(), workspace);
    out.status = start.status;
    out.path = start.path;
    if (!is_ok(out.status)) return out;
    const int n = start.seen.visible;
    detail::project<P>(n, start.target.s, request.options.normalisation, workspace);
    const bool hybrid = request.policy == LinearisePolicy::hybrid;
    if (request.policy != LinearisePolicy::forward && !hybrid)
      detail::add_host_rows<P>(request, inverse, start.host.s, n, workspace);
    const detail::WeightedCost sum = detail::weigh(n, request.options.robust, workspace);
    detail::accumulate<P>(n, workspace, &out.H, &out.b);
    if (hybrid && detail::takes_hybrid(request, n)) {
      const double energy = detail::pulled_energy(request, workspace) / (start.target.s * start.target.s);
      out.H = detail::hybrid_matrix<P>(request, inverse, energy, workspace);
    }
    if (!all_finite(out.H) || !all_finite(out.b) || !is_finite(sum.cost)) {
      out.clear();
      out.status = Status::non_finite;
      return out;
    }
    out.cost = sum.cost;
    out.error = detail::range_error(sum.error);
    out.zncc = 1.0 - 0.5 * out.error;
    out.visible = n;
    out.mean = start.target.mean;
    out.s = start.target.s;
  }
  return out;
}

/// Normal equations, by the gradients of the target.
template <Parameters Unknowns, class T>
NormalEquations<dof(Unknowns)> linearise(const ResidualRequest<T>& request, PhotometricWorkspace& workspace) noexcept {
  return reference::linearise<Unknowns>(request.by(LinearisePolicy::forward), workspace);
}

/// The cost alone. With `on_set` (a byte a pixel, usually workspace.visible() after a linearisation) a trial step is
/// judged on that set: pixels outside of it are ignored, and each of its pixels that is not visible now costs what an
/// uncorrelated pixel would, rho(2) / N_set in the unit of `cost` (two uncorrelated patches of N pixels have r^2 = 2 /
/// N on average), and is counted in `lost`. error and zncc are of the visible pixels alone. The workspace's visible()
/// stays as it is.
template <class T>
PhotometricCost evaluate(const ResidualRequest<T>& request, PhotometricWorkspace& workspace,
                         const std::uint8_t* on_set = nullptr) noexcept {
  if (detail::has_rows(request.input))
    return reference::evaluate(detail::RowForm<ResidualRequest<T>>(request).request(), workspace, on_set);
  PhotometricCost out;
  const auto start = detail::begin<0>(request, on_set, nullptr, workspace);
  const detail::Collected& seen = start.seen;
  out.status = start.status;
  out.path = start.path;
  out.visible = seen.visible;
  out.lost = on_set ? seen.candidates - seen.visible : 0;
  if (!is_ok(out.status)) return out;
  const detail::WeightedCost sum = detail::weigh(seen.visible, request.options.robust, workspace);
  out.cost = sum.cost + request.options.robust.rho(2.0) * out.lost / seen.candidates;
  out.error = detail::range_error(sum.error);
  out.zncc = 1.0 - 0.5 * out.error;
  return out;
}

/// The residuals themselves, without weights, for other solvers: r receives one number a pixel of the patch (patch.n),
/// and J, unless null, patch.n rows of dof(Unknowns) derivatives, row-major. A pixel that is not visible has residual
/// and row zero; all have unless is_ok(status) and n, r are valid. workspace.visible() tells which.
template <Parameters Unknowns, class T>
ResidualSummary residuals(const ResidualRequest<T>& request, PhotometricWorkspace& workspace, double* r,
                          double* J) noexcept {
  static_assert(Unknowns != Parameters::host_target_plane, "textplane: residuals() are by pose, plane, or pose_plane");
  constexpr int P = dof(Unknowns);
  ResidualSummary out;
  const int pixels = request.input.patch.n;
  if (detail::has_rows(request.input)) {
    const detail::RowForm<ResidualRequest<T>> still(request);
    out = residuals<Unknowns>(still.request(), workspace, r, J);
    for (int i = 0; J && r && i < pixels; ++i) still.template pull_back_row<P>(J + static_cast<std::ptrdiff_t>(i) * P);
    return out;
  }
  if (!r || pixels < 0) return out;
  for (int i = 0; i < pixels; ++i) r[i] = 0.0;
  if (J)
    for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(pixels) * P; ++i) J[i] = 0.0;

  const auto start = detail::begin<P>(request, nullptr, workspace.visible_flags(), workspace);
  out.status = start.status;
  out.visible = start.seen.visible;
  if (!is_ok(out.status)) return out;
  out.mean = start.target.mean;
  out.s = start.target.s;
  if (J) detail::project<P>(out.visible, out.s, request.options.normalisation, workspace);

  const std::uint8_t* visible = workspace.visible();
  const double *residual = workspace.residuals(), *row = workspace.rows();
  for (int i = 0; i < pixels; ++i) {
    if (!visible[i]) continue;
    r[i] = *residual++;
    if (!J) continue;
    for (int j = 0; j < P; ++j) J[static_cast<std::ptrdiff_t>(i) * P + j] = row[j];
    row += P;
  }
  return out;
}

}  // namespace reference

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_REFERENCE_HPP
