// The two libraries were built with different flags, compute the same number, and share the choice of the SIMD target.
#include "unit.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>

constexpr double kSum = 149564;  // Of the image, in exact arithmetic; the rest of number() is zero.

int main() {
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) {
    std::puts("skipped: this CPU does not run one of the two libraries");
    return 0;
  }
  if (std::strcmp(plain::baseline(), wide::baseline()) == 0) return 1;
#endif
  const double a = plain::number(), b = wide::number();
  std::printf("%s and %s: %.12f and %.12f, on %s and %s\n", plain::baseline(), wide::baseline(), a, b, plain::target(),
              wide::target());
  if (!(std::abs(a - kSum) < 1e-12 && std::abs(b - kSum) < 1e-12)) return 1;
  if (std::strcmp(plain::target(), wide::target()) != 0) return 1;
  // What one library sets, the other sees.
  if (!plain::set_target_scalar() || std::strcmp(wide::target(), "scalar") != 0) return 1;
  return std::abs(wide::number() - a) < 1e-12 ? 0 : 1;
}
