// What the CPU and the operating system offer, by CPUID and XGETBV.
#ifndef TEXTPLANE_SIMD_CPU_HPP
#define TEXTPLANE_SIMD_CPU_HPP

#include "textplane/simd/targets.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace detail {

#if TEXTPLANE_SIMD_ON_x86

/// A feature: its bit in a word of CPUID, and the registers that the operating system must save (bits of XCR0).
struct CpuFeature {
  const char* name;
  enum Word : int { leaf1_c, leaf7_b, leaf7_c } word;
  int bit;
  unsigned saved;
};
constexpr unsigned kSavesYmm = 0x06, kSavesZmm = 0xe6;  // xmm and ymm; these, opmask and zmm
constexpr CpuFeature kCpuFeatures[] = {
    {"sse4.1", CpuFeature::leaf1_c, 19, 0},           {"popcnt", CpuFeature::leaf1_c, 23, 0},
    {"fma", CpuFeature::leaf1_c, 12, kSavesYmm},      {"avx", CpuFeature::leaf1_c, 28, kSavesYmm},
    {"avx2", CpuFeature::leaf7_b, 5, kSavesYmm},      {"avx512f", CpuFeature::leaf7_b, 16, kSavesZmm},
    {"avx512dq", CpuFeature::leaf7_b, 17, kSavesZmm}, {"avx512bw", CpuFeature::leaf7_b, 30, kSavesZmm},
    {"avx512vl", CpuFeature::leaf7_b, 31, kSavesZmm}, {"avx512vnni", CpuFeature::leaf7_c, 11, kSavesZmm},
};

/// The words a, b, c, d of a leaf of CPUID. Not by <cpuid.h>, whose macro __cpuid is a function of Windows' headers.
inline void cpu_identification(unsigned leaf, unsigned (&words)[4]) noexcept {
#if TEXTPLANE_SIMD_MSVC
  int registers[4] = {};
  __cpuidex(registers, static_cast<int>(leaf), 0);
  for (int i = 0; i < 4; ++i) words[i] = static_cast<unsigned>(registers[i]);
#else
  __asm__ volatile("cpuid" : "=a"(words[0]), "=b"(words[1]), "=c"(words[2]), "=d"(words[3]) : "0"(leaf), "2"(0));
#endif
}

/// The low half of XCR0: which registers the operating system saves. Only where CPUID reports OSXSAVE.
inline unsigned extended_control_register() noexcept {
#if TEXTPLANE_SIMD_MSVC
  return static_cast<unsigned>(_xgetbv(0));
#else
  unsigned low = 0, high = 0;
  // The mnemonic needs -mxsave in some assemblers.
  __asm__ volatile(".byte 0x0f, 0x01, 0xd0" : "=a"(low), "=d"(high) : "c"(0));
  return low;
#endif
}

/// True when a comma-separated list begins with `name`; then `list` moves behind it.
inline bool skip_feature(const char* name, const char*& list) noexcept {
  const char* rest = list;
  while (*name != '\0' && *name == *rest) ++name, ++rest;
  if (*name != '\0' || (*rest != '\0' && *rest != ',')) return false;
  list = *rest == ',' ? rest + 1 : rest;
  return true;
}

/// True when this CPU has all features of a comma-separated list and the operating system saves their registers.
inline bool cpu_has(const char* features) noexcept {
  unsigned leaf[4] = {}, words[3] = {0, 0, 0};
  cpu_identification(0, leaf);
  const unsigned highest = leaf[0];
  if (highest >= 1) {
    cpu_identification(1, leaf);
    words[CpuFeature::leaf1_c] = leaf[2];
  }
  if (highest >= 7) {
    cpu_identification(7, leaf);
    words[CpuFeature::leaf7_b] = leaf[1];
    words[CpuFeature::leaf7_c] = leaf[2];
  }
  const bool osxsave = (words[0] >> 27 & 1U) != 0;
  const unsigned saved = osxsave ? extended_control_register() : 0U;
  while (*features != '\0') {
    const CpuFeature* f = kCpuFeatures;
    const CpuFeature* const end = f + sizeof kCpuFeatures / sizeof *f;
    while (f != end && !skip_feature(f->name, features)) ++f;
    if (f == end || (words[f->word] >> f->bit & 1U) == 0 || (saved & f->saved) != f->saved) return false;
  }
  return true;
}

#else

/// Scalar code runs everywhere, NEON on every AArch64, and an engine without simd128 loads no module that has it; no
/// other feature is known here.
inline bool cpu_has(const char* features) noexcept { return *features == '\0'; }

#endif

/// True when this machine runs `target`, of those that this compiler can build.
inline bool cpu_runs(simd::Target target) noexcept {
  return simd::known(target) && cpu_has(kTargets[static_cast<int>(target)].features);
}

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_CPU_HPP
