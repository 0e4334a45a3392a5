// What the CPU and the operating system offer, by CPUID and XGETBV.
#ifndef TEXTPLANE_SIMD_CPU_HPP
#define TEXTPLANE_SIMD_CPU_HPP

#include "textplane/simd/targets.hpp"

#if TEXTPLANE_HAS_X86
#include <cpuid.h>
#endif

TEXTPLANE_BEGIN_NAMESPACE
namespace detail {

#if TEXTPLANE_HAS_X86

/// The low half of XCR0: which registers the operating system saves. Only where CPUID reports OSXSAVE.
inline unsigned extended_control_register() noexcept {
  unsigned low = 0, high = 0;
  // The mnemonic needs -mxsave in some assemblers.
  __asm__ volatile(".byte 0x0f, 0x01, 0xd0" : "=a"(low), "=d"(high) : "c"(0));
  return low;
}

/// True when this CPU runs `target` and the operating system saves the registers that it uses.
inline bool cpu_runs(simd::Target target) noexcept {
  const auto has = [](unsigned word, unsigned bits) { return (word & bits) == bits; };
  unsigned highest = 0, a = 0, b = 0, c = 0, d = 0, features = 0;
  __cpuid(0, highest, b, c, d);
  if (highest < 1) return target == simd::Target::scalar;
  __cpuid(1, a, b, features, d);
  const bool sse41 = has(features, 1u << 19);
  unsigned b7 = 0, c7 = 0;
  if (highest >= 7) __cpuid_count(7, 0, a, b7, c7, d);
  const unsigned saved = has(features, 1u << 27) ? extended_control_register() : 0u;  // OSXSAVE
  const bool avx2 = sse41 && has(features, 1u << 28 | 1u << 12 | 1u << 23) &&         // AVX, FMA, POPCNT
                    has(b7, 1u << 5) && has(saved, 0x06u);                            // AVX2; xmm, ymm
  switch (target) {
    case simd::Target::scalar: return true;
    case simd::Target::sse41: return sse41;
    case simd::Target::avx2: return avx2;
    case simd::Target::avx512:
#if defined(TEXTPLANE_EMULATED_AVX512)
      return avx2;
#else
      return avx2 && has(b7, 1u << 16 | 1u << 17 | 1u << 30 | 1u << 31) &&  // F, DQ, BW, VL
             has(c7, 1u << 11) && has(saved, 0xe6u);                        // VNNI; xmm, ymm, opmask, zmm
#endif
    case simd::Target::neon: return false;
  }
  return false;
}

#else

/// Scalar code runs everywhere, NEON on every AArch64.
inline bool cpu_runs(simd::Target target) noexcept {
  return target == simd::Target::scalar || (target == simd::Target::neon && simd::compiled(target));
}

#endif

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_CPU_HPP
