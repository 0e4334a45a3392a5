// What the compiler and the machine offer to the SIMD targets, and how to say it to this compiler: which kernels this
// file has, intrinsics, instruction sets by regions, and the building blocks of a region. Besides config.hpp this is
// the only header that reads compiler macros.
#ifndef TEXTPLANE_SIMD_COMPILER_HPP
#define TEXTPLANE_SIMD_COMPILER_HPP

#include "textplane/config.hpp"

#if defined(TEXTPLANE_EXTERN_KERNELS) && !defined(TEXTPLANE_DEFINE_KERNELS)
#define TEXTPLANE_HAS_KERNELS 0
#else
#define TEXTPLANE_HAS_KERNELS 1
#endif

// What a target may need of compiler and machine: TEXTPLANE_SIMD_ON_<need> is 1 where they offer it.
#define TEXTPLANE_SIMD_ON_any 1
#define TEXTPLANE_SIMD_ON_x86 0
#define TEXTPLANE_SIMD_ON_x86_wide 0
#define TEXTPLANE_SIMD_ON_arm 0
#define TEXTPLANE_SIMD_ON_wasm 0

// MSVC takes intrinsics of any instruction set anywhere, so its regions have no pragmas; its vectors are unions,
// without operators. No MSVC has compiled that yet. Tests stand in for it: TEXTPLANE_UNION_VECTORS names a header with
// such unions, and makes of Clang for MSVC's target a compiler that passes for MSVC.
#if defined(_MSC_VER) && (!defined(__clang__) || defined(TEXTPLANE_UNION_VECTORS))
#define TEXTPLANE_SIMD_MSVC 1
#else
#define TEXTPLANE_SIMD_MSVC 0
#endif
#if defined(TEXTPLANE_UNION_VECTORS) || (TEXTPLANE_SIMD_MSVC && defined(_M_X64) && !defined(_M_ARM64EC))
#define TEXTPLANE_SIMD_UNIONS 1
#else
#define TEXTPLANE_SIMD_UNIONS 0
#endif
#if TEXTPLANE_SIMD_UNIONS
#if !TEXTPLANE_HAS_KERNELS
#elif defined(TEXTPLANE_UNION_VECTORS)
#include TEXTPLANE_UNION_VECTORS
#else
#include <immintrin.h>
#endif
#undef TEXTPLANE_SIMD_ON_x86
#undef TEXTPLANE_SIMD_ON_x86_wide
#define TEXTPLANE_SIMD_ON_x86 1
#define TEXTPLANE_SIMD_ON_x86_wide 1
#elif defined(__GNUC__) || defined(__clang__)
#if defined(__x86_64__)
#if TEXTPLANE_HAS_KERNELS
#include <immintrin.h>
// For MSVC's target Clang's <immintrin.h> leaves out what the command line does not ask for. Their order matters.
#if defined(_MSC_VER)
// clang-format off
#include <pmmintrin.h>
#include <tmmintrin.h>
#include <smmintrin.h>
#include <popcntintrin.h>
#include <avxintrin.h>
#include <avx2intrin.h>
#include <fmaintrin.h>
#include <avx512fintrin.h>
#include <avx512vlintrin.h>
#include <avx512bwintrin.h>
#include <avx512dqintrin.h>
#include <avx512vlbwintrin.h>
#include <avx512vldqintrin.h>
#include <avx512vnniintrin.h>
#include <avx512vlvnniintrin.h>
// clang-format on
#endif
#endif
#undef TEXTPLANE_SIMD_ON_x86
#define TEXTPLANE_SIMD_ON_x86 1
#if defined(__clang__) || defined(TEXTPLANE_UNALIGNED_VECTOR_MOVES) || !(defined(_WIN32) || defined(__CYGWIN__))
#undef TEXTPLANE_SIMD_ON_x86_wide
#define TEXTPLANE_SIMD_ON_x86_wide 1
#endif
#elif defined(__aarch64__) && defined(__ARM_NEON) && !defined(__AARCH64EB__)
#if TEXTPLANE_HAS_KERNELS
#include <arm_neon.h>
#endif
#undef TEXTPLANE_SIMD_ON_arm
#define TEXTPLANE_SIMD_ON_arm 1
#elif defined(__wasm_simd128__)
#if TEXTPLANE_HAS_KERNELS
#include <wasm_simd128.h>
#endif
#undef TEXTPLANE_SIMD_ON_wasm
#define TEXTPLANE_SIMD_ON_wasm 1
#endif
#endif

// TEXTPLANE_SIMD_FEATURES_BEGIN and TEXTPLANE_SIMD_FEATURES_END go around what is built for these instruction sets.
#define TEXTPLANE_SIMD_TEXT_(text) #text
#define TEXTPLANE_SIMD_TEXT(text) TEXTPLANE_SIMD_TEXT_(text)
#if TEXTPLANE_SIMD_UNIONS
#define TEXTPLANE_SIMD_FEATURES_BEGIN(features)
#define TEXTPLANE_SIMD_FEATURES_END
#elif defined(__clang__)
#define TEXTPLANE_SIMD_FEATURES_BEGIN(features) \
  _Pragma(TEXTPLANE_SIMD_TEXT(clang attribute push(__attribute__((target(features))), apply_to = function)))
#define TEXTPLANE_SIMD_FEATURES_END _Pragma("clang attribute pop")
#else
#define TEXTPLANE_SIMD_FEATURES_BEGIN(features) \
  _Pragma("GCC push_options") _Pragma(TEXTPLANE_SIMD_TEXT(GCC target(features)))
#define TEXTPLANE_SIMD_FEATURES_END _Pragma("GCC pop_options")
#endif

// Clang keeps -ffinite-math-only in functions that a pragma asks to be precise. It may then swap the operands of a
// minimum, and a NaN would get past a clamp. So the operations hide their minima and maxima from it in assembly.
#if defined(__clang__) && defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
#define TEXTPLANE_SIMD_HIDE_MINIMA 1
#else
#define TEXTPLANE_SIMD_HIDE_MINIMA 0
#endif

// Building blocks of a region and its entry points.
#if (defined(__GNUC__) || defined(__clang__)) && !TEXTPLANE_SIMD_MSVC
#define TEXTPLANE_SIMD_INLINE inline __attribute__((always_inline))
#define TEXTPLANE_SIMD_ENTRY inline __attribute__((noinline))
#define TEXTPLANE_SIMD_RESTRICT __restrict__
#define TEXTPLANE_SIMD_PREFETCH(p) __builtin_prefetch(p)
#define TEXTPLANE_SIMD_UNROLL _Pragma("GCC unroll 8")  // g++ keeps such loops at -O2, and their arrays in memory
#define TEXTPLANE_SIMD_SQRT __builtin_sqrtf
#define TEXTPLANE_SIMD_FLOOR __builtin_floorf
#define TEXTPLANE_SIMD_ABS __builtin_fabsf
#define TEXTPLANE_SIMD_SQRT_D __builtin_sqrt
#define TEXTPLANE_SIMD_TRUNC_D __builtin_trunc
#define TEXTPLANE_SIMD_ABS_D __builtin_fabs
#define TEXTPLANE_SIMD_COPY __builtin_memcpy
#define TEXTPLANE_SIMD_LOWEST_BIT(bits) __builtin_ctzll(bits)
#else
#include <cmath>
#include <cstring>
#if TEXTPLANE_SIMD_MSVC
#include <intrin.h>
#define TEXTPLANE_SIMD_INLINE __forceinline
#define TEXTPLANE_SIMD_ENTRY inline __declspec(noinline)
#define TEXTPLANE_SIMD_RESTRICT __restrict
#define TEXTPLANE_SIMD_LOWEST_BIT(bits) lowest_bit_of(bits)
#else
#define TEXTPLANE_SIMD_INLINE inline
#define TEXTPLANE_SIMD_ENTRY inline
#define TEXTPLANE_SIMD_RESTRICT
#endif
#define TEXTPLANE_SIMD_PREFETCH(p) static_cast<void>(p)
#define TEXTPLANE_SIMD_UNROLL
#define TEXTPLANE_SIMD_SQRT ::std::sqrt
#define TEXTPLANE_SIMD_FLOOR ::std::floor
#define TEXTPLANE_SIMD_ABS ::std::fabs
#define TEXTPLANE_SIMD_SQRT_D ::std::sqrt
#define TEXTPLANE_SIMD_TRUNC_D ::std::trunc
#define TEXTPLANE_SIMD_ABS_D ::std::fabs
#define TEXTPLANE_SIMD_COPY ::std::memcpy
#endif
#if (defined(__GNUC__) || defined(__clang__)) && !TEXTPLANE_SIMD_UNIONS && !defined(TEXTPLANE_EMULATED_AVX512)
#define TEXTPLANE_SIMD_HOLD(constraint, v) __asm__("" : constraint(v))
#else
#define TEXTPLANE_SIMD_HOLD(constraint, v) static_cast<void>(0)
#endif

// What the compilers' own vectors have. 0 - a would lose the sign of a zero.
#if TEXTPLANE_SIMD_UNIONS
#define TEXTPLANE_SIMD_OPERATOR(Vector, sign, function) \
  TEXTPLANE_SIMD_INLINE Vector operator sign(Vector a, Vector b) noexcept { return function(a, b); }
#define TEXTPLANE_SIMD_OPERATORS(Vector, prefix, type)          \
  TEXTPLANE_SIMD_OPERATOR(Vector, +, prefix##_add_##type)       \
  TEXTPLANE_SIMD_OPERATOR(Vector, -, prefix##_sub_##type)       \
  TEXTPLANE_SIMD_OPERATOR(Vector, *, prefix##_mul_##type)       \
  TEXTPLANE_SIMD_OPERATOR(Vector, /, prefix##_div_##type)       \
  TEXTPLANE_SIMD_INLINE Vector operator-(Vector a) noexcept {   \
    return prefix##_sub_##type(prefix##_set1_##type(-0.0f), a); \
  }
#else
#define TEXTPLANE_SIMD_OPERATORS(Vector, prefix, type)
#endif

TEXTPLANE_BEGIN_NAMESPACE
namespace detail {
#if TEXTPLANE_SIMD_UNIONS && TEXTPLANE_SIMD_MSVC
/// Number of the lowest bit that is set; there is one.
TEXTPLANE_SIMD_INLINE int lowest_bit_of(unsigned long long bits) noexcept {
  unsigned long number = 0;
  _BitScanForward64(&number, bits);
  return static_cast<int>(number);
}
#endif
}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_COMPILER_HPP
