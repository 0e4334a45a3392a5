// Links translation units for different CPUs, as a user does who compiles one file with -march=native: each must compute the
// same, and on an old CPU the baseline one must run although the linker has seen wide copies of what the units share.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

bool baseline_unit(const std::uint8_t* pixels, int width, int height, double* result);
bool avx2_unit(const std::uint8_t* pixels, int width, int height, double* result);    // -march=x86-64-v3
bool avx512_unit(const std::uint8_t* pixels, int width, int height, double* result);  // -march=x86-64-v4

int main() {
  const int width = 160, height = 120;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width) * height);
  unsigned state = 7;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const unsigned block = static_cast<unsigned>(x / 8 * 31 + y / 8 * 57) * 2654435761u >> 25;  // 0 to 127
      state = state * 1664525u + 1013904223u;
      pixels[static_cast<std::size_t>(y * width + x)] = static_cast<std::uint8_t>(60u + block + (state >> 28));
    }
  }
  double expected[6];
  if (!baseline_unit(pixels.data(), width, height, expected)) return std::printf("the baseline unit failed\n"), 1;
  if (!(expected[0] > 0 && expected[3] > 0.9)) return std::printf("the scene is too dull\n"), 1;

  const auto agrees = [&](const char* name, bool (*unit)(const std::uint8_t*, int, int, double*)) {
    double result[6];
    bool same = unit(pixels.data(), width, height, result);
    for (int i = 0; i < 6; ++i) same = same && std::fabs(result[i] - expected[i]) <= 1e-3;
    std::printf("%s unit: %s\n", name, same ? "agrees" : "differs");
    return same;
  };
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd");
  std::printf("baseline unit: runs\n");
  if (avx2 && !agrees("avx2", avx2_unit)) return 1;
  if (avx512 && !agrees("avx512", avx512_unit)) return 1;
  if (!avx2) std::printf("avx2 unit: not on this CPU\n");
  if (!avx512) std::printf("avx512 unit: not on this CPU\n");
  return 0;
}
