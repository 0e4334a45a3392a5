// The picture that units built in different ways compute with, and what they must agree on.
#ifndef TEXTPLANE_TESTS_SIMD_ISA_SCENE_HPP
#define TEXTPLANE_TESTS_SIMD_ISA_SCENE_HPP

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

/// mixed_unit.cpp under another name: eight numbers of the image, true where everything succeeded.
using Unit = bool (*)(const std::uint8_t* pixels, int width, int height, double* result);

/// Runs units on one picture: blocks with a little noise.
class Scene {
 public:
  Scene() : pixels_(static_cast<std::size_t>(kWidth) * kHeight) {
    unsigned state = 7;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const unsigned block = static_cast<unsigned>(x / 8 * 31 + y / 8 * 57) * 2654435761u >> 25;  // 0 to 127
        state = state * 1664525u + 1013904223u;
        pixels_[static_cast<std::size_t>(y * kWidth + x)] = static_cast<std::uint8_t>(60u + block + (state >> 28));
      }
  }

  /// Whether the unit succeeds in a scene that tells something; its numbers are those expected of the others.
  bool expect(Unit unit) {
    if (!unit(pixels_.data(), kWidth, kHeight, expected_)) return std::printf("the first unit failed\n"), false;
    if (!(expected_[0] > 0 && expected_[3] > 0.9)) return std::printf("the scene is too dull\n"), false;
    return true;
  }

  /// Whether the unit succeeds with the same numbers.
  bool agrees(const char* name, Unit unit) const {
    double result[8];
    bool same = unit(pixels_.data(), kWidth, kHeight, result);
    for (int i = 0; i < 8; ++i) same = same && std::fabs(result[i] - expected_[i]) <= 1e-3;
    std::printf("%s unit: %s\n", name, same ? "agrees" : "differs");
    return same;
  }

 private:
  static constexpr int kWidth = 160, kHeight = 120;
  std::vector<std::uint8_t> pixels_;
  double expected_[8] = {};
};

#endif  // TEXTPLANE_TESTS_SIMD_ISA_SCENE_HPP
