// Links translation units for different CPUs, as a user does who compiles one file with -march=native: each must
// compute the same, and on an old CPU the baseline one must run although the linker has seen wide copies of what the
// units share.
#include "scene.hpp"

bool baseline_unit(const std::uint8_t* pixels, int width, int height, double* result);
bool avx2_unit(const std::uint8_t* pixels, int width, int height, double* result);    // -march=x86-64-v3
bool avx512_unit(const std::uint8_t* pixels, int width, int height, double* result);  // -march=x86-64-v4

int main() {
  Scene scene;
  if (!scene.expect(baseline_unit)) return 1;
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd");
  std::printf("baseline unit: runs\n");
  if (avx2 && !scene.agrees("avx2", avx2_unit)) return 1;
  if (!avx2) std::printf("avx2 unit: not on this CPU\n");
  if (avx512 && !scene.agrees("avx512", avx512_unit)) return 1;
  if (!avx512) std::printf("avx512 unit: not on this CPU\n");
  return 0;
}
