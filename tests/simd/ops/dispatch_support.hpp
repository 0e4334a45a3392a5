// A kernel that only says which region it was compiled in.
#ifndef TEXTPLANE_TESTS_SIMD_OPS_DISPATCH_SUPPORT_HPP
#define TEXTPLANE_TESTS_SIMD_OPS_DISPATCH_SUPPORT_HPP

#include "textplane/simd/ops.hpp"

#define TEXTPLANE_SIMD_KERNEL "simd/ops/dispatch_kernel.inl"
#include "textplane/simd/foreach_target.inl"

TEXTPLANE_BEGIN_NAMESPACE
namespace simd {
inline int dispatched_region() noexcept { TEXTPLANE_SIMD_DISPATCH(region_number()) }
inline int dispatched_lanes() noexcept { TEXTPLANE_SIMD_DISPATCH(lane_count()) }
}  // namespace simd
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_TESTS_SIMD_OPS_DISPATCH_SUPPORT_HPP
