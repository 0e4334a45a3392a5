// Robust costs of the residual kernels.
#ifndef TEXTPLANE_SIMD_ROBUST_HPP
#define TEXTPLANE_SIMD_ROBUST_HPP

#include "textplane/simd/ops.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace simd {

/// The cost rho(e^2) of e = r sqrt(N) and its weight; photometry/robust.hpp has the formulas, and the same numbers.
enum class RobustKind : int { l2 = 0, huber = 1, cauchy = 2, tukey = 3 };

/// True where all pixels have weights other than 1: L2 has none, and Huber's cost for outliers alone.
constexpr bool weighs_all(RobustKind kind) noexcept { return kind == RobustKind::cauchy || kind == RobustKind::tukey; }

}  // namespace simd
TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/robust.inl"
#include "textplane/simd/foreach_target.inl"

#endif  // TEXTPLANE_SIMD_ROBUST_HPP
