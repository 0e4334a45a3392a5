// Normal equations whose b is the gradient of the cost, exact, and whose H is the template's times one number: raw
// pointers in, sums out. photometry/residual_request.hpp says what they are (LinearisePolicy::hybrid), and
// docs/equations.md has the formulas.
//
// A pixel takes sampling with gradients, its residual, one factor, and eight sums; the 27 products of rows and all that
// belongs to them are those of the prepared host patch. Error against the reference as that of simd/residual.hpp; of H
// besides that of the template's rounded columns (simd/template.hpp).
#ifndef TEXTPLANE_SIMD_HYBRID_HPP
#define TEXTPLANE_SIMD_HYBRID_HPP

#include "textplane/simd/template.hpp"

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/hybrid.inl"
#include "textplane/simd/foreach_target.inl"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

/// Normal equations for (v, omega, theta): H (9 x 9) and b (9), of which nothing may be used unless the status is ok.
/// `args` are of the pixels that `model` was prepared of. Status::unsupported also where no more than 256 pixels are
/// visible (linearise_pose_plane() is quicker then), or a host intensity is not finite.
TEXTPLANE_KERNEL void linearise_hybrid(const TemplateModel& model, const ResidualArgs& args, ResidualInfo* out,
                                       double* H, double* b) noexcept
    TEXTPLANE_SIMD_BODY(linearise_hybrid(model, args, out, H, b));

}  // namespace simd

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_HYBRID_HPP
