// linearise() by a policy: gradients of the target (forward), the host (template Jacobian), both (ESM), or b by the
// target's and H by the host's (hybrid).
#ifndef TEXTPLANE_PHOTOMETRY_RESIDUAL_POLICY_HPP
#define TEXTPLANE_PHOTOMETRY_RESIDUAL_POLICY_HPP

#include <cstdint>

#include "textplane/photometry/residual.hpp"
#include "textplane/photometry/template_patch.hpp"
#include "textplane/simd/esm.hpp"
#include "textplane/simd/hybrid.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
// Of the sums by (v, omega, theta) those by the unknowns.
template <int P>
void take_parameters(const double* H, const double* b, NormalEquations<P>* out) noexcept {
  constexpr int at = P == 3 ? 6 : 0;
  for (int c = 0; c < P; ++c) {
    out->b[c] = b[at + c];
    for (int r = 0; r < P; ++r) out->H(r, c) = H[9 * (at + r) + at + c];
  }
}

// The policies with the host's gradients, by the kernels; false where they do not take the request or declined.
template <Parameters Unknowns>
bool kernel_linearise_by_host(const PolicyRequest<std::uint8_t>& q, PhotometricWorkspace& workspace,
                              NormalEquations<dof(Unknowns)>* out) noexcept {
  constexpr int P = dof(Unknowns);
  const bool esm = q.policy == LinearisePolicy::esm;
  const PatchView& patch = q.input.patch;
  if ((!esm && q.policy != LinearisePolicy::template_jacobian) || !patch.gx || !patch.gy || !kernels_take(q, workspace))
    return false;
  simd::EsmArgs args{kernel_args(q, workspace, workspace.visible_flags(), nullptr), patch.gx, patch.gy, esm,
                     workspace.more_scratch()};
  simd::LensFit fit;
  if (q.input.lens && !fit_request(q, &args.base, &fit)) return false;
  // The kernels give all of (v, omega, theta).
  double all_H[81], all_b[9];
  double *H = P == 9 ? out->H.data() : all_H, *b = P == 9 ? out->b.data() : all_b;
  simd::ResidualInfo info;
  info.status = Status::unsupported;
  if (!esm && q.prepared && q.prepared->size() == patch.n && !patch.mask)
    info = simd::linearise_template(q.prepared->model(), args.base,
                                    reinterpret_cast<std::int16_t*>(workspace.more_scratch()), H, b);
  // Not all of the patch is visible: the sums of what is.
  if (info.status == Status::unsupported) info = simd::linearise_esm(args, H, b);
  if (!take_info(info, q.options.min_visible, out)) return false;
  if (P != 9 && is_ok(out->status)) take_parameters<P>(H, b, out);
  return true;
}

// The policy hybrid likewise; forward where that is what it means.
template <Parameters Unknowns>
bool kernel_linearise_hybrid(const PolicyRequest<std::uint8_t>& q, PhotometricWorkspace& workspace,
                             NormalEquations<dof(Unknowns)>* out) noexcept {
  constexpr int P = dof(Unknowns);
  const PatchView& patch = q.input.patch;
  if (!takes_hybrid(q, patch.n)) return kernel_linearise<Unknowns>(q, workspace, out);
  if (!kernels_take(q, workspace) || !patch.gx || !patch.gy || q.prepared->size() != patch.n) return false;
  simd::ResidualArgs args = kernel_args(q, workspace, workspace.visible_flags(), nullptr);
  simd::LensFit fit;
  if (q.input.lens && !fit_request(q, &args, &fit)) return false;
  double all_H[81], all_b[9];
  double *H = P == 9 ? out->H.data() : all_H, *b = P == 9 ? out->b.data() : all_b;
  simd::ResidualInfo info;
  simd::linearise_hybrid(q.prepared->model(), args, &info, H, b);
  if (info.status == Status::unsupported && info.visible <= kHybridPixels)
    return kernel_linearise<Unknowns>(q, workspace, out);
  if (!take_info(info, q.options.min_visible, out)) return false;
  if (P != 9 && is_ok(out->status)) take_parameters<P>(H, b, out);
  return true;
}
}  // namespace detail

/// Normal equations with derivatives by a policy: see reference::linearise() of a PolicyRequest. A `prepared` patch
/// makes template_jacobian several times faster where all of the patch is visible. Then sums are of host intensities
/// rounded to 1/64 grey level and target intensities within 0.025 of the interpolant (simd/template.hpp): E and the
/// entries of b, in units of sqrt(H_ii), are within 0.08 / sigma of the reference's, sigma being the lesser standard
/// deviation of the two sides, and H within 3e-4 of sqrt(H_ii H_jj) without weights. Otherwise the bounds are those of
/// simd/residual.hpp, of hybrid's H with that of the template's besides.
template <Parameters Unknowns, class T>
NormalEquations<dof(Unknowns)> linearise(const PolicyRequest<T>& request, PhotometricWorkspace& workspace) noexcept {
  NormalEquations<dof(Unknowns)> out{detail::Unset()};
  if constexpr (Unknowns == Parameters::host_target_plane) {
    detail::world_parameters(linearise<Parameters::pose_plane>(request, workspace), request, &out);
  } else {
    if (detail::has_rows(request.input)) {
      const detail::RowForm<PolicyRequest<T>> still(request);
      out = linearise<Unknowns>(still.request(), workspace);
      still.template pull_back<Unknowns>(&out);
      return out;
    }
    bool taken = false;
    if constexpr (std::is_same<T, std::uint8_t>::value)
      taken = request.policy == LinearisePolicy::forward ? detail::kernel_linearise<Unknowns>(request, workspace, &out)
              : request.policy == LinearisePolicy::hybrid
                  ? detail::kernel_linearise_hybrid<Unknowns>(request, workspace, &out)
                  : detail::kernel_linearise_by_host<Unknowns>(request, workspace, &out);
    if (!taken) out = reference::linearise<Unknowns>(request, workspace);
  }
  if (!is_ok(out.status)) out.clear();
  return out;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_POLICY_HPP
