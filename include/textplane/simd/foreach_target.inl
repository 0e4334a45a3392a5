// Includes the file that TEXTPLANE_SIMD_KERNEL names once in the region of every target, inside
// `textplane::detail::<target>`, with TEXTPLANE_SIMD_REGION defined as the number of the target (simd::Target), and undefines
// TEXTPLANE_SIMD_KERNEL at its end. No include guard: each family of kernels includes it once.
//
// What is inside is built for the target whatever the command line says, and without contraction of a * b + c: where a
// fused multiply-add is meant, it is written. -ffast-math is off inside, so that a NaN does not get past a clamp. (Clang's
// own headers of intrinsics keep it, and its -ffp-contract=fast overrides the rest: bits may differ then.)
//
// The file must hold non-template functions, constants and plain structs alone: no #include, no function of std, Eigen or
// the C library, no template, no class with members, no lambda. Inline functions of those are shared by the whole program;
// a copy of one that was built in a region could be the one that the linker keeps, and would kill the program on an older CPU.
#ifndef TEXTPLANE_SIMD_KERNEL
#error "define TEXTPLANE_SIMD_KERNEL as the file to include"
#endif

#if TEXTPLANE_HAS_KERNELS
#if defined(__clang__)
#if defined(__x86_64__) || defined(__i386__)
#pragma float_control(precise, on, push)
#endif
#pragma clang fp contract(off)
#elif defined(__GNUC__)
#pragma GCC push_options
#pragma GCC optimize("fp-contract=off", "no-fast-math")
#endif

#if TEXTPLANE_HAS_SCALAR
#define TEXTPLANE_SIMD_REGION 0
TEXTPLANE_BEGIN_NAMESPACE
namespace detail {
namespace scalar {
#include TEXTPLANE_SIMD_KERNEL
}  // namespace scalar
}  // namespace detail
TEXTPLANE_END_NAMESPACE
#undef TEXTPLANE_SIMD_REGION
#endif

#if TEXTPLANE_HAS_SSE41
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("sse4.1"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("sse4.1")
#endif
#define TEXTPLANE_SIMD_REGION 1
TEXTPLANE_BEGIN_NAMESPACE
namespace detail {
namespace sse41 {
#include TEXTPLANE_SIMD_KERNEL
}  // namespace sse41
}  // namespace detail
TEXTPLANE_END_NAMESPACE
#undef TEXTPLANE_SIMD_REGION
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

#if TEXTPLANE_HAS_AVX2
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,fma,popcnt"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma,popcnt")
#endif
#define TEXTPLANE_SIMD_REGION 2
TEXTPLANE_BEGIN_NAMESPACE
namespace detail {
namespace avx2 {
#include TEXTPLANE_SIMD_KERNEL
}  // namespace avx2
}  // namespace detail
TEXTPLANE_END_NAMESPACE
#undef TEXTPLANE_SIMD_REGION
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

#if TEXTPLANE_HAS_AVX512
#if defined(TEXTPLANE_EMULATED_AVX512)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,fma,popcnt"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma,popcnt")
#endif
#elif defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,avx512vnni,avx2,fma,popcnt"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx512f,avx512bw,avx512dq,avx512vl,avx512vnni,avx2,fma,popcnt")
#endif
#define TEXTPLANE_SIMD_REGION 3
TEXTPLANE_BEGIN_NAMESPACE
namespace detail {
namespace avx512 {
#include TEXTPLANE_SIMD_KERNEL
}  // namespace avx512
}  // namespace detail
TEXTPLANE_END_NAMESPACE
#undef TEXTPLANE_SIMD_REGION
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

#if TEXTPLANE_HAS_NEON
#define TEXTPLANE_SIMD_REGION 4
TEXTPLANE_BEGIN_NAMESPACE
namespace detail {
namespace neon {
#include TEXTPLANE_SIMD_KERNEL
}  // namespace neon
}  // namespace detail
TEXTPLANE_END_NAMESPACE
#undef TEXTPLANE_SIMD_REGION
#endif

#if defined(__clang__)
#if defined(__x86_64__) || defined(__i386__)
#pragma float_control(pop)
#else
#pragma STDC FP_CONTRACT DEFAULT
#endif
#elif defined(__GNUC__)
#pragma GCC pop_options
#endif
#endif  // TEXTPLANE_HAS_KERNELS

#undef TEXTPLANE_SIMD_KERNEL
