// The table of SIMD targets: the instruction sets that kernels are built for.
//
// A *region* is a stretch of source inside `textplane::detail::<target>` that the compiler builds for that instruction
// set, whatever the command line says (foreach_target.inl opens them). Code outside stays baseline, so one plain -O2
// build holds kernels for every CPU.
//
// GCC, Clang and MSVC build the x86-64 targets, GCC and Clang NEON on little-endian AArch64. For Windows GCC builds
// SSE4.1 alone: it aligns the stack to 16 bytes and moves wider vectors there as if they were aligned (its bug 54412).
// A file that the assembler makes with -Wa,-muse-unaligned-vector-move (binutils 2.38) may say so, by the macro
// TEXTPLANE_UNALIGNED_VECTOR_MOVES, and has them all. WebAssembly has no CPU to ask: its vectors (simd128) are for a
// whole translation unit, with Clang's -msimd128. All other compilers and CPUs, 32 bits among them, have the scalar
// target alone. Where TEXTPLANE_TARGET fixes a target (dispatch.hpp), a translation unit builds only what that one
// needs.
//
// Compiled kernels, an option: every file that calls a kernel compiles all its targets, which takes time. Where
// TEXTPLANE_EXTERN_KERNELS is defined for a whole program, its files see only declarations of kernels and solvers, and
// one file,
//
//   #define TEXTPLANE_DEFINE_KERNELS
//   #include <textplane/textplane.hpp>
//
// holds the kernels (CMake: link textplane::kernels, which is both). Results are the same. Flags that would make
// another textplane (config.hpp) make the linker miss its kernels.
#ifndef TEXTPLANE_SIMD_TARGETS_HPP
#define TEXTPLANE_SIMD_TARGETS_HPP

#include "textplane/config.hpp"
#include "textplane/simd/compiler.hpp"

// A test may define TEXTPLANE_EMULATED_AVX512 as a header that emulates the intrinsics: avx512 is then built for AVX2.
#define TEXTPLANE_SIMD_HASWELL "sse4.1,avx,avx2,fma,popcnt"
#if defined(TEXTPLANE_EMULATED_AVX512)
#define TEXTPLANE_SIMD_ICELAKE TEXTPLANE_SIMD_HASWELL
#if TEXTPLANE_HAS_KERNELS
#include TEXTPLANE_EMULATED_AVX512
#endif
#else
#define TEXTPLANE_SIMD_ICELAKE "avx512f,avx512bw,avx512dq,avx512vl,avx512vnni," TEXTPLANE_SIMD_HASWELL
#endif

// The table. A target's operations are in ops/<name>.inl.
//   number    simd::Target; does not change between versions
//   lanes     floats in a vector; of the targets that a CPU runs the widest is the best, of two alike the later one
//   fused     whether madd() rounds once
//   needs     TEXTPLANE_SIMD_ON_<needs>
//   few       the target whose kernels take patches of few pixels, sooner than its own would
//   features  what the compiler is asked for and the CPU must have, by the compiler's names (cpu.hpp knows them)
// clang-format off
//                                     number  name     lanes  fused  needs     few      features
#define TEXTPLANE_SIMD_scalar(X, a)  X(a, 0,   scalar,  1,     false, any,      scalar,  "")
#define TEXTPLANE_SIMD_sse41(X, a)   X(a, 1,   sse41,   4,     false, x86,      sse41,   "sse4.1")
#define TEXTPLANE_SIMD_avx2(X, a)    X(a, 2,   avx2,    8,     true,  x86_wide, avx2,    TEXTPLANE_SIMD_HASWELL)
#define TEXTPLANE_SIMD_avx512(X, a)  X(a, 3,   avx512,  16,    true,  x86_wide, avx2,    TEXTPLANE_SIMD_ICELAKE)
#define TEXTPLANE_SIMD_neon(X, a)    X(a, 4,   neon,    4,     true,  arm,      neon,    "")
#define TEXTPLANE_SIMD_simd128(X, a) X(a, 5,   simd128, 4,     false, wasm,     simd128, "")
#define TEXTPLANE_SIMD_none(X, a)
// clang-format on

// The same by number. A new target takes the first free one.
#define TEXTPLANE_SIMD_NAME_0 scalar
#define TEXTPLANE_SIMD_NAME_1 sse41
#define TEXTPLANE_SIMD_NAME_2 avx2
#define TEXTPLANE_SIMD_NAME_3 avx512
#define TEXTPLANE_SIMD_NAME_4 neon
#define TEXTPLANE_SIMD_NAME_5 simd128
#define TEXTPLANE_SIMD_NAME_6 none
#define TEXTPLANE_SIMD_NAME_7 none

// TEXTPLANE_SIMD_TARGETS(X, a): X(a, number, ...) of every target, in order.
#define TEXTPLANE_SIMD_JOIN_(a, b) a##b
#define TEXTPLANE_SIMD_JOIN(a, b) TEXTPLANE_SIMD_JOIN_(a, b)
#define TEXTPLANE_SIMD_ROW(number) \
  TEXTPLANE_SIMD_JOIN(TEXTPLANE_SIMD_, TEXTPLANE_SIMD_JOIN(TEXTPLANE_SIMD_NAME_, number))
// clang-format off
#define TEXTPLANE_SIMD_TARGETS(X, a)                                                                              \
  TEXTPLANE_SIMD_ROW(0)(X, a) TEXTPLANE_SIMD_ROW(1)(X, a) TEXTPLANE_SIMD_ROW(2)(X, a) TEXTPLANE_SIMD_ROW(3)(X, a) \
  TEXTPLANE_SIMD_ROW(4)(X, a) TEXTPLANE_SIMD_ROW(5)(X, a) TEXTPLANE_SIMD_ROW(6)(X, a) TEXTPLANE_SIMD_ROW(7)(X, a)
// clang-format on

// TEXTPLANE_SIMD_WANTED: bit `number` is set where this translation unit wants that target. Passed as `a`, it makes of
// the X TEXTPLANE_SIMD_BUILDS "|| 1" or "|| 0", for #if and for C++: whether the target is built.
#define TEXTPLANE_SIMD_NUMBER(a, number, name, lanes, fused, needs, few, features) number
#define TEXTPLANE_SIMD_FEW(a, number, name, lanes, fused, needs, few, features) few
#if defined(TEXTPLANE_TARGET)
#define TEXTPLANE_SIMD_ONLY(name) TEXTPLANE_SIMD_JOIN(TEXTPLANE_SIMD_, name)
#define TEXTPLANE_SIMD_ONLY_FEW TEXTPLANE_SIMD_ONLY(TEXTPLANE_TARGET)(TEXTPLANE_SIMD_FEW, 0)
#define TEXTPLANE_SIMD_WANTED                                             \
  (1 << TEXTPLANE_SIMD_ONLY(TEXTPLANE_TARGET)(TEXTPLANE_SIMD_NUMBER, 0) | \
   1 << TEXTPLANE_SIMD_ONLY(TEXTPLANE_SIMD_ONLY_FEW)(TEXTPLANE_SIMD_NUMBER, 0))
#else
#define TEXTPLANE_SIMD_WANTED 255
#endif
#define TEXTPLANE_SIMD_BUILDS(a, number, name, lanes, fused, needs, few, features) \
  || (TEXTPLANE_SIMD_ON_##needs && ((a) >> number & 1))

// TEXTPLANE_SIMD_BEGIN and TEXTPLANE_SIMD_END, Xs of the table, go around a region.
#define TEXTPLANE_SIMD_BEGIN_any(features)
#define TEXTPLANE_SIMD_BEGIN_x86(features) TEXTPLANE_SIMD_FEATURES_BEGIN(features)
#define TEXTPLANE_SIMD_BEGIN_x86_wide(features) TEXTPLANE_SIMD_FEATURES_BEGIN(features)
#define TEXTPLANE_SIMD_BEGIN_arm(features)
#define TEXTPLANE_SIMD_BEGIN_wasm(features)
#define TEXTPLANE_SIMD_END_any
#define TEXTPLANE_SIMD_END_x86 TEXTPLANE_SIMD_FEATURES_END
#define TEXTPLANE_SIMD_END_x86_wide TEXTPLANE_SIMD_FEATURES_END
#define TEXTPLANE_SIMD_END_arm
#define TEXTPLANE_SIMD_END_wasm
#define TEXTPLANE_SIMD_BEGIN(a, number, name, lanes, fused, needs, few, features) TEXTPLANE_SIMD_BEGIN_##needs(features)
#define TEXTPLANE_SIMD_END(a, number, name, lanes, fused, needs, few, features) TEXTPLANE_SIMD_END_##needs

TEXTPLANE_BEGIN_NAMESPACE
namespace simd {

/// The instruction sets that kernels are built for: scalar = 0 (plain C++), sse41 = 1 (SSE4.1), avx2 = 2 (AVX2, FMA and
/// POPCNT: Haswell, Zen and later), avx512 = 3 (AVX-512 F, BW, DQ, VL and VNNI besides: Ice Lake, Zen 4 and later),
/// neon = 4 (AArch64), simd128 = 5 (WebAssembly).
enum class Target : int {
#define TEXTPLANE_SIMD_X(a, number, name, ...) name = number,
  TEXTPLANE_SIMD_TARGETS(TEXTPLANE_SIMD_X, 0)
#undef TEXTPLANE_SIMD_X
};

}  // namespace simd

namespace detail {
/// A row of the table of targets.
struct TargetRow {
  const char *name, *features;
  int lanes;
  bool fused, built;
};

constexpr TargetRow kTargets[] = {
#define TEXTPLANE_SIMD_X(a, number, name, lanes, fused, needs, few, features) \
  {#name, features, lanes, fused, false TEXTPLANE_SIMD_BUILDS(a, number, name, lanes, fused, needs, few, features)},
    TEXTPLANE_SIMD_TARGETS(TEXTPLANE_SIMD_X, TEXTPLANE_SIMD_WANTED)
#undef TEXTPLANE_SIMD_X
};
}  // namespace detail

namespace simd {

/// Number of enumerators of Target.
constexpr int kTargetCount = sizeof detail::kTargets / sizeof detail::kTargets[0];

/// True for an enumerator of Target.
constexpr bool known(Target target) noexcept {
  return static_cast<int>(target) >= 0 && static_cast<int>(target) < kTargetCount;
}

/// The enumerator's name, never null.
constexpr const char* to_string(Target target) noexcept {
  return known(target) ? detail::kTargets[static_cast<int>(target)].name : "unknown";
}

/// True when this translation unit holds kernels for `target`. Whether the CPU runs them is another matter: see
/// supported.
constexpr bool compiled(Target target) noexcept {
  return known(target) && detail::kTargets[static_cast<int>(target)].built;
}

/// Floats in a vector of `target`.
constexpr int lanes(Target target) noexcept {
  return known(target) ? detail::kTargets[static_cast<int>(target)].lanes : 1;
}

/// True when kernels of `target` use fused multiply-add. Kernels that do not reduce give the same bits on all targets
/// of a group; between the groups each kernel states a bound.
constexpr bool fused(Target target) noexcept {
  return known(target) && detail::kTargets[static_cast<int>(target)].fused;
}

}  // namespace simd
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_TARGETS_HPP
