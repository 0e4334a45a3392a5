// A translation unit whose target is fixed at compile time, next to dispatch_test.cpp, whose target is not.
#define TEXTPLANE_TARGET scalar
#include "textplane/simd/dispatch.hpp"

#include "simd/ops/dispatch_support.hpp"

namespace textplane_test {

int fixed_active_target() { return static_cast<int>(textplane::simd::active_target()); }
int fixed_dispatch() { return textplane::simd::dispatched_region(); }
bool fixed_set_target(int target) {
  return textplane::simd::set_target(static_cast<textplane::simd::Target>(target)) == textplane::Status::ok;
}

static_assert(textplane::simd::active_target() == textplane::simd::Target::scalar, "folds at compile time");
static_assert(textplane::simd::compiled(textplane::simd::Target::scalar), "the target that is fixed");
static_assert(!textplane::simd::compiled(textplane::simd::Target::avx2), "no other is compiled");

}  // namespace textplane_test
