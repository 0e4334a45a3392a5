// SIMD targets: which instruction sets this compiler can build regions for, and the attributes of the functions in them.
//
// A *region* is a stretch of source inside `textplane::detail::<target>` that the compiler builds for that instruction set,
// whatever the command line says (foreach_target.inl opens them). Baseline code stays baseline, so one plain -O2 build
// holds kernels for every CPU. Besides config.hpp this is the only header that reads compiler macros:
//
//   TEXTPLANE_HAS_SSE41, _AVX2, _AVX512   1 for GCC and Clang on x86-64 (MinGW: SSE4.1 alone, its stack is not aligned for more)
//   TEXTPLANE_HAS_NEON                    1 for GCC and Clang on little-endian AArch64, where NEON is part of the baseline
//
// All other compilers and CPUs, MSVC and 32 bits among them, have the scalar target alone. Where TEXTPLANE_TARGET fixes one
// (dispatch.hpp), TEXTPLANE_HAS_SCALAR and these are 1 for what it needs and 0 for all others.
//
// Compiled kernels, an option: compiling all targets of a kernel in every file that calls it takes its time. Where
// TEXTPLANE_EXTERN_KERNELS is defined for a whole program, its files see the entry points as declarations, those of the solvers, too,
// and one file,
//
//   #define TEXTPLANE_DEFINE_KERNELS
//   #include <textplane/textplane.hpp>
//
// holds the kernels (CMake: link textplane::kernels, which is both). Results are the same. Flags that would make another
// textplane (config.hpp) make the linker miss its kernels.
#ifndef TEXTPLANE_SIMD_TARGETS_HPP
#define TEXTPLANE_SIMD_TARGETS_HPP

#include "textplane/config.hpp"

#if defined(TEXTPLANE_EXTERN_KERNELS) && !defined(TEXTPLANE_DEFINE_KERNELS)
#define TEXTPLANE_HAS_KERNELS 0
#else
#define TEXTPLANE_HAS_KERNELS 1
#endif

// What this compiler and machine offer.
#define TEXTPLANE_HAS_X86 0
#define TEXTPLANE_HAS_WIDE 0
#define TEXTPLANE_HAS_ARM 0
#if (defined(__GNUC__) || defined(__clang__)) && !defined(_MSC_VER)
#if defined(__x86_64__)
#if TEXTPLANE_HAS_KERNELS
#include <immintrin.h>
#endif
#undef TEXTPLANE_HAS_X86
#define TEXTPLANE_HAS_X86 1
#if defined(__clang__) || !defined(_WIN32)
#undef TEXTPLANE_HAS_WIDE
#define TEXTPLANE_HAS_WIDE 1
#endif
#elif defined(__aarch64__) && defined(__ARM_NEON) && !defined(__AARCH64EB__)
#if TEXTPLANE_HAS_KERNELS
#include <arm_neon.h>
#endif
#undef TEXTPLANE_HAS_ARM
#define TEXTPLANE_HAS_ARM 1
#endif
#endif

// TEXTPLANE_FIXED is 1 + the number of the target that TEXTPLANE_TARGET names; 0 where none is named.
#if defined(TEXTPLANE_TARGET)
#define TEXTPLANE_NUMBER_scalar 1
#define TEXTPLANE_NUMBER_sse41 2
#define TEXTPLANE_NUMBER_avx2 3
#define TEXTPLANE_NUMBER_avx512 4
#define TEXTPLANE_NUMBER_neon 5
#define TEXTPLANE_NUMBER_(target) TEXTPLANE_NUMBER_##target
#define TEXTPLANE_NUMBER(target) TEXTPLANE_NUMBER_(target)
#define TEXTPLANE_FIXED TEXTPLANE_NUMBER(TEXTPLANE_TARGET)
#if TEXTPLANE_FIXED == 0
#error "TEXTPLANE_TARGET is none of scalar, sse41, avx2, avx512, neon"
#endif
#else
#define TEXTPLANE_FIXED 0
#endif

// Kernels of avx512 leave few pixels to those of avx2.
#define TEXTPLANE_HAS_SCALAR (TEXTPLANE_FIXED <= 1)
#define TEXTPLANE_HAS_SSE41 (TEXTPLANE_HAS_X86 && (TEXTPLANE_FIXED == 0 || TEXTPLANE_FIXED == 2))
#define TEXTPLANE_HAS_AVX2 \
  (TEXTPLANE_HAS_WIDE && (TEXTPLANE_FIXED == 0 || TEXTPLANE_FIXED == 3 || TEXTPLANE_FIXED == 4))
#define TEXTPLANE_HAS_AVX512 (TEXTPLANE_HAS_WIDE && (TEXTPLANE_FIXED == 0 || TEXTPLANE_FIXED == 4))
#define TEXTPLANE_HAS_NEON (TEXTPLANE_HAS_ARM && (TEXTPLANE_FIXED == 0 || TEXTPLANE_FIXED == 5))

// A test may define this as a header that emulates the AVX-512 intrinsics: the avx512 regions are then built for AVX2, and
// the target counts as supported wherever AVX2 is.
#if defined(TEXTPLANE_EMULATED_AVX512) && TEXTPLANE_HAS_KERNELS
#include TEXTPLANE_EMULATED_AVX512
#endif

// Clang keeps -ffinite-math-only in functions that a pragma asks to be precise, and may then exchange the operands of a
// minimum; a NaN would get past a clamp. The minima and maxima of the vectors are out of its sight there.
#if defined(__clang__) && defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
#define TEXTPLANE_SIMD_HIDE_MINIMA 1
#else
#define TEXTPLANE_SIMD_HIDE_MINIMA 0
#endif

// Building blocks of a region and its entry points.
#if defined(__GNUC__) || defined(__clang__)
#define TEXTPLANE_SIMD_INLINE inline __attribute__((always_inline))
#define TEXTPLANE_SIMD_ENTRY inline __attribute__((noinline))
#define TEXTPLANE_SIMD_RESTRICT __restrict__
#define TEXTPLANE_SIMD_PREFETCH(p) __builtin_prefetch(p)
#define TEXTPLANE_SIMD_SQRT __builtin_sqrtf
#define TEXTPLANE_SIMD_FLOOR __builtin_floorf
#define TEXTPLANE_SIMD_ABS __builtin_fabsf
#else
#include <cmath>
#if defined(_MSC_VER)
#define TEXTPLANE_SIMD_INLINE __forceinline
#define TEXTPLANE_SIMD_RESTRICT __restrict
#else
#define TEXTPLANE_SIMD_INLINE inline
#define TEXTPLANE_SIMD_RESTRICT
#endif
#define TEXTPLANE_SIMD_ENTRY inline
#define TEXTPLANE_SIMD_PREFETCH(p) static_cast<void>(p)
#define TEXTPLANE_SIMD_SQRT ::std::sqrt
#define TEXTPLANE_SIMD_FLOOR ::std::floor
#define TEXTPLANE_SIMD_ABS ::std::fabs
#endif

TEXTPLANE_BEGIN_NAMESPACE
namespace simd {

/// The instruction sets that kernels are built for. The numbers do not change between versions.
enum class Target : int {
  scalar = 0,  ///< Plain C++.
  sse41 = 1,   ///< SSE4.1.
  avx2 = 2,    ///< AVX2, FMA and POPCNT: Haswell, Zen and later.
  avx512 = 3,  ///< AVX-512 F, BW, DQ, VL and VNNI besides: Ice Lake, Zen 4 and later.
  neon = 4,    ///< AArch64.
};

/// Number of enumerators of Target.
constexpr int kTargetCount = 5;

/// The enumerator's name, never null.
constexpr const char* to_string(Target target) noexcept {
  switch (target) {
    case Target::scalar: return "scalar";
    case Target::sse41: return "sse41";
    case Target::avx2: return "avx2";
    case Target::avx512: return "avx512";
    case Target::neon: return "neon";
  }
  return "unknown";
}

/// True when this translation unit holds kernels for `target`. Whether the CPU runs them is another matter: see supported.
constexpr bool compiled(Target target) noexcept {
  switch (target) {
    case Target::scalar: return TEXTPLANE_HAS_SCALAR != 0;
    case Target::sse41: return TEXTPLANE_HAS_SSE41 != 0;
    case Target::avx2: return TEXTPLANE_HAS_AVX2 != 0;
    case Target::avx512: return TEXTPLANE_HAS_AVX512 != 0;
    case Target::neon: return TEXTPLANE_HAS_NEON != 0;
  }
  return false;
}

/// Floats in a vector of `target`.
constexpr int lanes(Target target) noexcept {
  switch (target) {
    case Target::scalar: return 1;
    case Target::sse41:
    case Target::neon: return 4;
    case Target::avx2: return 8;
    case Target::avx512: return 16;
  }
  return 1;
}

/// True when kernels of `target` use fused multiply-add. Kernels that do not reduce give the same bits on all targets of
/// a group; between the groups each kernel states a bound.
constexpr bool fused(Target target) noexcept {
  return target == Target::avx2 || target == Target::avx512 || target == Target::neon;
}

}  // namespace simd
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_TARGETS_HPP
