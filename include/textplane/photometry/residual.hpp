// The photometric residual of a planar text object and its normal equations. `reference` has the same in double
// (residual_reference.hpp): slow, and the definition.
//
// linearise() and evaluate() run in float vectors where the target is 8-bit (simd/residual.hpp states the error), and
// are those of `reference` otherwise; Path in the result tells. A pixel within about 1e-4 px of the image's border or
// of a pixel line may fall on either side of it in the fast form.
//
// Residual of pixel i (docs/equations.md; the paper's E_text): r_i = I~_host(x_i) - I~_target(K pi(H m~_i)), with H = R
// + t theta^T of T_t_h and I~ = (I - mean) / ||I - mean|| over the visible pixels alone, on the host's side, too. So r
// does not change with gain and bias of either image. E = sum r^2 is in [0, 4] and ZNCC = 1 - E / 2.
//
// A pixel is visible when it is not masked, its plane point lies in front of both cameras (theta^T m~ > 0, q_z > 0), it
// projects into [0, w - 1] x [0, h - 1] of the target, and both of its intensities are finite. Image gradients are
// those of the bilinear interpolant. Parameters names the unknowns, their order, units and perturbation.
//
// All functions: noexcept, no allocation, thread-safe for distinct workspaces. Status (results are zero unless is_ok):
//   too_few           fewer than options.min_visible visible pixels (or an empty or wholly masked patch)
//   behind_camera     every pixel lies behind a camera          out_of_view    none is visible, for other reasons too
//   no_contrast       options.min_contrast is not reached on either side
//   non_finite        NaN or infinity in theta, pose or camera, or an overflow
//   invalid_argument  null pointers, an image that is not valid(), focal lengths <= 0, bad options, small workspace
#ifndef TEXTPLANE_PHOTOMETRY_RESIDUAL_HPP
#define TEXTPLANE_PHOTOMETRY_RESIDUAL_HPP

#include <cstdint>

#include "textplane/photometry/residual_kernels.hpp"
#include "textplane/photometry/residual_reference.hpp"
#include "textplane/photometry/residual_rows.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Normal equations of a request, for dof(Unknowns) unknowns:
///
///   auto sums = linearise<Parameters::pose>(ResidualRequest{input, theta, T_t_h, options}, workspace);
template <Parameters Unknowns, class T>
NormalEquations<dof(Unknowns)> linearise(const ResidualRequest<T>& request, PhotometricWorkspace& workspace) noexcept {
  NormalEquations<dof(Unknowns)> out{detail::Unset()};
  if constexpr (Unknowns == Parameters::host_target_plane) {
    detail::world_parameters(linearise<Parameters::pose_plane>(request, workspace), request, &out);
  } else {
    if (detail::has_rows(request.input)) {
      const detail::RowForm<ResidualRequest<T>> still(request);
      out = linearise<Unknowns>(still.request(), workspace);
      still.template pull_back<Unknowns>(&out);
      return out;
    }
    bool taken = false;
    if constexpr (std::is_same<T, std::uint8_t>::value)
      taken = detail::kernel_linearise<Unknowns>(request, workspace, &out);
    if (!taken) out = reference::linearise<Unknowns>(request, workspace);
  }
  if (!is_ok(out.status)) out.clear();
  return out;
}

/// The same by a policy, ResidualRequest::by(): residual_policy.hpp defines it.
template <Parameters Unknowns, class T>
NormalEquations<dof(Unknowns)> linearise(const PolicyRequest<T>& request, PhotometricWorkspace& workspace) noexcept;

/// The cost alone: see reference::evaluate().
template <class T>
PhotometricCost evaluate(const ResidualRequest<T>& request, PhotometricWorkspace& workspace,
                         const std::uint8_t* on_set = nullptr) noexcept {
  if (detail::has_rows(request.input))
    return evaluate(detail::RowForm<ResidualRequest<T>>(request).request(), workspace, on_set);
  if constexpr (std::is_same<T, std::uint8_t>::value) {
    PhotometricCost out;
    if (detail::kernel_evaluate(request, workspace, on_set, &out)) return out;
  }
  return reference::evaluate(request, workspace, on_set);
}

TEXTPLANE_INSTANCE(NormalEquations<6> linearise<Parameters::pose>(const ResidualRequest<std::uint8_t>&,
                                                                  PhotometricWorkspace&) noexcept);
TEXTPLANE_INSTANCE(NormalEquations<3> linearise<Parameters::plane>(const ResidualRequest<std::uint8_t>&,
                                                                   PhotometricWorkspace&) noexcept);
TEXTPLANE_INSTANCE(NormalEquations<9> linearise<Parameters::pose_plane>(const ResidualRequest<std::uint8_t>&,
                                                                        PhotometricWorkspace&) noexcept);
TEXTPLANE_INSTANCE(NormalEquations<15> linearise<Parameters::host_target_plane>(const ResidualRequest<std::uint8_t>&,
                                                                                PhotometricWorkspace&) noexcept);
TEXTPLANE_INSTANCE(PhotometricCost evaluate(const ResidualRequest<std::uint8_t>&, PhotometricWorkspace&,
                                            const std::uint8_t*) noexcept);

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_HPP
