// Run-time dispatch: which target the kernels run on.
//
// On first use the best target that both CPU and operating system support is chosen, or the one that the environment
// variable TEXTPLANE_FORCE_TARGET names (scalar, sse41, avx2, avx512, neon, simd128). A name that is unknown, or that
// this machine cannot run, leaves the best target in charge, and forced_target_status() tells. set_target changes it
// later, for the whole process. Defining the macro TEXTPLANE_TARGET as such a name (-DTEXTPLANE_TARGET=avx2) fixes the
// target of a translation unit at compile time: its calls go straight to that kernel, the others are not compiled,
// neither environment nor set_target change it, and the caller promises a CPU that has it.
//
// State: one constant-initialised atomic, shared by all translation units of a program whatever their flags.
#ifndef TEXTPLANE_SIMD_DISPATCH_HPP
#define TEXTPLANE_SIMD_DISPATCH_HPP

#include <atomic>
#include <cstdlib>

#include "textplane/config.hpp"
#include "textplane/core/status.hpp"
#include "textplane/simd/cpu.hpp"
#include "textplane/simd/targets.hpp"

// Outside the inline namespace, which differs with the flags: a program has one state.
namespace textplane {
namespace process {
/// The number of the active target, or -1 before the first use.
inline std::atomic<int> simd_target{-1};
}  // namespace process
}  // namespace textplane

TEXTPLANE_BEGIN_NAMESPACE
namespace simd {

/// True when this translation unit holds kernels for `target` and this machine runs them.
inline bool supported(Target target) noexcept { return compiled(target) && detail::cpu_runs(target); }

/// The widest supported target, of two alike the later one; where TEXTPLANE_TARGET fixes one, that.
inline Target best_target() noexcept {
#if defined(TEXTPLANE_TARGET)
  return Target::TEXTPLANE_TARGET;
#else
  Target best = Target::scalar;
  for (int i = 0; i < kTargetCount; ++i) {
    const Target target = static_cast<Target>(i);
    if (supported(target) && lanes(target) >= lanes(best)) best = target;
  }
  return best;
#endif
}

/// Finds the target called `name` ("scalar", "sse41", "avx2", "avx512", "neon", "simd128"). False, and `target`
/// unchanged, for a null pointer and any other name.
inline bool target_from_string(const char* name, Target& target) noexcept {
  if (name == nullptr) return false;
  for (int i = 0; i < kTargetCount; ++i) {
    const char* expected = to_string(static_cast<Target>(i));
    const char* given = name;
    while (*expected != '\0' && *expected == *given) ++expected, ++given;
    if (*expected == '\0' && *given == '\0') {
      target = static_cast<Target>(i);
      return true;
    }
  }
  return false;
}

/// What became of TEXTPLANE_FORCE_TARGET: `ok` when it is unset, empty, or names a supported target; `invalid_argument`
/// otherwise, and then best_target() was chosen. Reads the environment: not beside a thread that changes it.
inline Status forced_target_status() noexcept {
#if defined(_MSC_VER)
#pragma warning(suppress : 4996)
#endif
  const char* name = std::getenv("TEXTPLANE_FORCE_TARGET");
  if (name == nullptr || *name == '\0') return Status::ok;
  Target target = Target::scalar;
  return target_from_string(name, target) && supported(target) ? Status::ok : Status::invalid_argument;
}

/// Chooses the target on first use. Threads that arrive together agree; a set_target that comes between wins.
inline Target choose_target() noexcept {
#if defined(_MSC_VER)
#pragma warning(suppress : 4996)
#endif
  const char* name = std::getenv("TEXTPLANE_FORCE_TARGET");
  Target target = Target::scalar;
  if (!target_from_string(name, target) || !supported(target)) target = best_target();
  int expected = -1;
  const int chosen = static_cast<int>(target);
  const bool first = process::simd_target.compare_exchange_strong(expected, chosen, std::memory_order_relaxed);
  return first ? target : static_cast<Target>(expected);
}

#if defined(TEXTPLANE_TARGET)

static_assert(compiled(Target::TEXTPLANE_TARGET), "this compiler cannot build the target that TEXTPLANE_TARGET names");

/// The target that kernels called from this translation unit run on: fixed by TEXTPLANE_TARGET.
constexpr Target active_target() noexcept { return Target::TEXTPLANE_TARGET; }

/// `ok` for the fixed target, `invalid_argument` for any other.
inline Status set_target(Target target) noexcept {
  return target == active_target() ? Status::ok : Status::invalid_argument;
}

#else

/// The target that kernels called from this translation unit run on. Thread safe, no allocation; after the first call
/// one relaxed load.
inline Target active_target() noexcept {
  const int state = process::simd_target.load(std::memory_order_relaxed);
  return state >= 0 ? static_cast<Target>(state) : choose_target();
}

/// Makes all kernels of the process run on `target`. `invalid_argument`, and nothing changes, when it is not supported.
/// Thread safe: a kernel that is running finishes on its old target.
inline Status set_target(Target target) noexcept {
  if (!supported(target)) return Status::invalid_argument;
  process::simd_target.store(static_cast<int>(target), std::memory_order_relaxed);
  return Status::ok;
}

#endif

}  // namespace simd
TEXTPLANE_END_NAMESPACE

// TEXTPLANE_SIMD_DISPATCH(halve(a)): the body of an entry point. Returns the result of `halve(a)` of the active target,
// of scalar for a target that this compiler cannot build.
#if defined(TEXTPLANE_TARGET)
#define TEXTPLANE_SIMD_DISPATCH(call) return ::textplane::detail::TEXTPLANE_TARGET::call;
#else
#define TEXTPLANE_SIMD_CASE_0(name, call)
#define TEXTPLANE_SIMD_CASE_1(name, call) \
  case ::textplane::simd::Target::name:   \
    return ::textplane::detail::name::call;
#define TEXTPLANE_SIMD_CASE(call, number, name, lanes, fused, needs, few, features) \
  TEXTPLANE_SIMD_JOIN(TEXTPLANE_SIMD_CASE_, TEXTPLANE_SIMD_ON_##needs)(name, call)
#define TEXTPLANE_SIMD_DISPATCH(call)                                                      \
  switch (::textplane::simd::active_target()) {                                            \
    default: /* and scalar, the first */ TEXTPLANE_SIMD_TARGETS(TEXTPLANE_SIMD_CASE, call) \
  }
#endif

// TEXTPLANE_KERNEL int f(int a) noexcept TEXTPLANE_SIMD_BODY(f(a)); is an entry point. Inline; or, with compiled
// kernels (targets.hpp), declared everywhere and defined in one file.
#if !TEXTPLANE_HAS_KERNELS
#define TEXTPLANE_KERNEL
#define TEXTPLANE_SIMD_BODY(call)
#else
#if defined(TEXTPLANE_EXTERN_KERNELS)
#define TEXTPLANE_KERNEL
#else
#define TEXTPLANE_KERNEL inline
#endif
#define TEXTPLANE_SIMD_BODY(call)   \
  { TEXTPLANE_SIMD_DISPATCH(call) } \
  static_assert(true, "") /* for the semicolon */
#endif

#endif  // TEXTPLANE_SIMD_DISPATCH_HPP
