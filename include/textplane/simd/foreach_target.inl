// Includes the file that TEXTPLANE_SIMD_KERNEL names once in the region of every target, inside
// `textplane::detail::<target>`, and undefines TEXTPLANE_SIMD_KERNEL at its end. No include guard: each family of
// kernels includes it once.
//
// A region is built for its target whatever the command line says, and without contraction of a * b + c: a fused
// multiply-add is written where it is meant. -ffast-math is off inside, so that a NaN does not get past a clamp.
// (Clang's own headers of intrinsics keep it, and its -ffp-contract=fast overrides the rest: bits may differ then.)
//
// The file must hold non-template functions, constants and plain structs alone: no function of std, Eigen or the C
// library, no template, no class with members, no lambda, no #include but of another such file. The whole program
// shares inline functions of those; the linker might keep a copy that was built in a region, and it would kill the
// program on an older CPU.
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
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wsign-conversion"  // of masks, where intrinsics are macros: at -O0
#pragma GCC push_options
#pragma GCC optimize("fp-contract=off", "no-fast-math")
#endif

#define TEXTPLANE_SIMD_SLOT 0
#include "textplane/simd/region.inl"
#define TEXTPLANE_SIMD_SLOT 1
#include "textplane/simd/region.inl"
#define TEXTPLANE_SIMD_SLOT 2
#include "textplane/simd/region.inl"
#define TEXTPLANE_SIMD_SLOT 3
#include "textplane/simd/region.inl"
#define TEXTPLANE_SIMD_SLOT 4
#include "textplane/simd/region.inl"
#define TEXTPLANE_SIMD_SLOT 5
#include "textplane/simd/region.inl"
#define TEXTPLANE_SIMD_SLOT 6
#include "textplane/simd/region.inl"
#define TEXTPLANE_SIMD_SLOT 7
#include "textplane/simd/region.inl"

#if defined(__clang__)
#if defined(__x86_64__) || defined(__i386__)
#pragma float_control(pop)
#else
#pragma STDC FP_CONTRACT DEFAULT
#endif
#elif defined(__GNUC__)
#pragma GCC pop_options
#pragma GCC diagnostic pop
#endif
#endif  // TEXTPLANE_HAS_KERNELS

#undef TEXTPLANE_SIMD_KERNEL
