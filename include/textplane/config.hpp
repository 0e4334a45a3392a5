// textplane: version, inline ABI namespace and assert hook.
//
// Every public symbol lives in `textplane::<abi>`, an inline namespace whose name encodes the version and the flags of
// the translation unit that change code or layout: the instruction-set baseline, fast-math, Eigen's two largest
// alignments, the SIMD target where TEXTPLANE_TARGET fixes one (simd/dispatch.hpp), and the moves that MinGW's wide
// targets need (simd/targets.hpp). Two translation units built with different flags therefore keep their own copies,
// and passing a type from one to the other is a link error instead of a corrupt heap. It protects textplane's own
// functions. Those of Eigen and of the standard library that a compiler does not inline stay shared, whichever copy the
// linker keeps; so kernels and small solvers call none (tests/simd/isa).
//
// This header and simd/compiler.hpp are the only ones that read compiler macros.
#ifndef TEXTPLANE_CONFIG_HPP
#define TEXTPLANE_CONFIG_HPP

#include <Eigen/Core>
#include <Eigen/Geometry>

#define TEXTPLANE_VERSION_MAJOR 0
#define TEXTPLANE_VERSION_MINOR 1
#define TEXTPLANE_VERSION_PATCH 0
#define TEXTPLANE_VERSION_STRING "0.1.0"

#if defined(__AVX512F__)
#define TEXTPLANE_ABI_ISA avx512
#elif defined(__AVX2__) && defined(__FMA__)
#define TEXTPLANE_ABI_ISA avx2
#elif defined(__AVX__)
#define TEXTPLANE_ABI_ISA avx
#elif defined(__SSE4_1__)
#define TEXTPLANE_ABI_ISA sse41
#elif defined(__wasm_simd128__)
#define TEXTPLANE_ABI_ISA simd128
#else
#define TEXTPLANE_ABI_ISA base
#endif

#if defined(__FAST_MATH__)
#define TEXTPLANE_ABI_MATH fast
#else
#define TEXTPLANE_ABI_MATH ieee
#endif

// What Eigen allocates, and the members that it puts into objects, have settings of their own.
#if EIGEN_MAX_ALIGN_BYTES >= 64
#define TEXTPLANE_ABI_ALIGN a64
#elif EIGEN_MAX_ALIGN_BYTES >= 32
#define TEXTPLANE_ABI_ALIGN a32
#elif EIGEN_MAX_ALIGN_BYTES >= 16
#define TEXTPLANE_ABI_ALIGN a16
#else
#define TEXTPLANE_ABI_ALIGN a0
#endif

#if EIGEN_MAX_STATIC_ALIGN_BYTES >= 64
#define TEXTPLANE_ABI_STATIC s64
#elif EIGEN_MAX_STATIC_ALIGN_BYTES >= 32
#define TEXTPLANE_ABI_STATIC s32
#elif EIGEN_MAX_STATIC_ALIGN_BYTES >= 16
#define TEXTPLANE_ABI_STATIC s16
#else
#define TEXTPLANE_ABI_STATIC s0
#endif

#if defined(TEXTPLANE_TARGET)
#define TEXTPLANE_ABI_FIXED_(target) _only_##target
#define TEXTPLANE_ABI_FIXED(target) TEXTPLANE_ABI_FIXED_(target)
#define TEXTPLANE_ABI_TARGET TEXTPLANE_ABI_FIXED(TEXTPLANE_TARGET)
#else
#define TEXTPLANE_ABI_TARGET
#endif

// Which targets there are, see simd/targets.
#if defined(TEXTPLANE_UNALIGNED_VECTOR_MOVES)
#define TEXTPLANE_ABI_MOVES _moves
#else
#define TEXTPLANE_ABI_MOVES
#endif

#define TEXTPLANE_ABI_JOIN_(major, minor, isa, math, align, fixed, target, moves) \
  v##major##_##minor##_##isa##_##math##_##align##fixed##target##moves
#define TEXTPLANE_ABI_JOIN(major, minor, isa, math, align, fixed, target, moves) \
  TEXTPLANE_ABI_JOIN_(major, minor, isa, math, align, fixed, target, moves)
#define TEXTPLANE_ABI                                                                                         \
  TEXTPLANE_ABI_JOIN(TEXTPLANE_VERSION_MAJOR, TEXTPLANE_VERSION_MINOR, TEXTPLANE_ABI_ISA, TEXTPLANE_ABI_MATH, \
                     TEXTPLANE_ABI_ALIGN, TEXTPLANE_ABI_STATIC, TEXTPLANE_ABI_TARGET, TEXTPLANE_ABI_MOVES)

#define TEXTPLANE_BEGIN_NAMESPACE \
  namespace textplane {           \
  inline namespace TEXTPLANE_ABI {
#define TEXTPLANE_END_NAMESPACE \
  }                             \
  }

// Deferred functions and classes. An inline function is compiled in every file that includes its header, and Eigen's
// templates take long. A function after TEXTPLANE_DEFERRED is compiled only where it is called; callers do not see the
// template parameter. A class after it has a using-declaration of its old name. Real is double: compilers leave an
// expression of Vector3<Real> alone until the function is called, while one of Vector3<double> costs Eigen's templates
// wherever the header is included. A program with compiled kernels (simd/targets.hpp) compiles a function once:
// TEXTPLANE_INSTANCE(signature), with `name<>`, at the end of the header defines it in the one file that defines the
// kernels, and declares it in all others. In other programs it does nothing. Of a class, TEXTPLANE_INSTANCE(class
// Name<double>), it keeps those members from other files that are defined below the class: those within it are inline.
#define TEXTPLANE_DEFERRED template <class Real = double>
#if defined(TEXTPLANE_DEFINE_KERNELS)
#undef TEXTPLANE_EXTERN_KERNELS
#define TEXTPLANE_EXTERN_KERNELS
#define TEXTPLANE_INSTANCE(...) template __VA_ARGS__
#elif defined(TEXTPLANE_EXTERN_KERNELS)
#define TEXTPLANE_INSTANCE(...) extern template __VA_ARGS__
#else
#define TEXTPLANE_INSTANCE(...) static_assert(true, "") /* for the semicolon */
#endif

// Checks of preconditions that only a bug in the caller can break. Off unless the embedder defines the macro, for
// example as `assert(condition)`: the library itself never aborts.
#ifndef TEXTPLANE_ASSERT
#define TEXTPLANE_ASSERT(condition) static_cast<void>(0)
#endif

#endif  // TEXTPLANE_CONFIG_HPP
