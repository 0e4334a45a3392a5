// Images and homographies for the tests of the warps.
#ifndef TEXTPLANE_TESTS_SIMD_WARP_SUPPORT_HPP
#define TEXTPLANE_TESTS_SIMD_WARP_SUPPORT_HPP

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "support/calculus.hpp"
#include "support/targets.hpp"
#include "textplane/photometry/warp_patch.hpp"

namespace warp_support {

using namespace textplane;
using simd::Target;
using textplane_test::Random;

constexpr float kFill = 77;

// Runs `check` on every target that this machine has.
template <class Check>
void on_each_target(const Check& check) {
  for (const Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(simd::to_string(target));
    check(target);
  }
}

// An image whose rows are `gap` pixels apart.
template <class T>
struct Padded {
  std::vector<T> pixels;
  int width, height, gap;
  Padded(int w, int h, int g, T value = T())
      : pixels(static_cast<std::size_t>((w + g) * h), value), width(w), height(h), gap(g) {}
  ImageView<T> view() { return {pixels.data(), width, height, static_cast<std::ptrdiff_t>(sizeof(T)) * (width + gap)}; }
  ImageView<const T> view() const {
    return {pixels.data(), width, height, static_cast<std::ptrdiff_t>(sizeof(T)) * (width + gap)};
  }
  T at(int x, int y) const { return pixels[static_cast<std::size_t>(y * (width + gap) + x)]; }
};

template <class T>
Padded<T> noise(Random& random, int width, int height, int gap) {
  Padded<T> image(width, height, gap);
  for (T& p : image.pixels) p = static_cast<T>(std::floor(random.uniform(0, 256)));
  return image;
}

// Turns, scales, tilts and shifts; `reach` is how far the output strays from the middle of the source.
inline Matrix3<double> random_warp(Random& random, int width, int height, int out_width, int out_height, double reach) {
  const double angle = random.uniform(0, 1) < 0.5 ? random.uniform(-0.15, 0.15) : random.uniform(-3.2, 3.2);
  const double zoom = random.uniform(0.3, 1.9), c = zoom * std::cos(angle), s = zoom * std::sin(angle);
  const double tilt = 0.3 / std::max(out_width, out_height);
  Matrix3<double> centre, H;
  centre << 1, 0, -0.5 * out_width, 0, 1, -0.5 * out_height, 0, 0, 1;
  H << c, -s, 0, s, c, 0, random.uniform(-tilt, tilt), random.uniform(-tilt, tilt), 1;
  Matrix3<double> shift;
  shift << 1, 0, width * (0.5 + random.uniform(-reach, reach)), 0, 1, height * (0.5 + random.uniform(-reach, reach)), 0,
      0, 1;
  return (shift * H * centre) * random.uniform(0.01, 100);
}

}  // namespace warp_support

#endif  // TEXTPLANE_TESTS_SIMD_WARP_SUPPORT_HPP
