// Normal equations from the host's gradients, or from the mean of host's and target's (ESM): raw pointers in, sums out.
// photometry/residual_request.hpp says what they are, residual_reference.hpp holds the double reference, and
// docs/equations.md the formulas.
//
// The target's gradient is pulled back to the host, d I_target(H m~) / d host pixel, and both gradients are scaled by
// their side's norm, so that their mean has the form of one: rows j of eight for a homography in host coordinates,
// whose products are 27 sums. The projections, through mean and norm of target and host, and the change to 9 parameters
// happen to the sums, in double. Any visible set and any mask. Error against the reference as that of
// simd/residual.hpp.
#ifndef TEXTPLANE_SIMD_ESM_HPP
#define TEXTPLANE_SIMD_ESM_HPP

#include <cstddef>

#include "textplane/simd/residual.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

/// As ResidualArgs, with the host's gradients.
struct EsmArgs {
  ResidualArgs base;          ///< base.flags must be given.
  const float* gx = nullptr;  ///< n gradients of the host image at its pixels, intensity units a px.
  const float* gy = nullptr;
  bool average = true;       ///< The mean of both sides (ESM); else the host's alone (template Jacobian).
  float* scratch = nullptr;  ///< esm_scratch(n) floats besides those of base.
};

/// Floats of scratch memory for n pixels, besides residual_scratch(n).
constexpr std::size_t esm_scratch(int n) noexcept { return 2 * (static_cast<std::size_t>(n > 0 ? n : 0) + 16); }

}  // namespace simd

TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/host_basis.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/esm.inl"
#include "textplane/simd/foreach_target.inl"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
TEXTPLANE_KERNEL void linearise_esm(const simd::EsmArgs& args, simd::ResidualInfo* out, double* H, double* b) noexcept
    TEXTPLANE_SIMD_BODY(linearise_esm(args, out, H, b));
}  // namespace detail

namespace simd {

/// Normal equations for (v, omega, theta): H (9 x 9) and b (9), status as linearise_pose_plane().
inline ResidualInfo linearise_esm(const EsmArgs& args, double* H, double* b) noexcept {
  ResidualInfo out;
  detail::linearise_esm(args, &out, H, b);
  return out;
}

}  // namespace simd

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_ESM_HPP
