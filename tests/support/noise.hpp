// Pictures for tests of filters.
#ifndef TEXTPLANE_TEST_SUPPORT_NOISE_HPP
#define TEXTPLANE_TEST_SUPPORT_NOISE_HPP

#include <cstdint>
#include <random>

#include "textplane/core/image_view.hpp"

namespace textplane_test {

/// Every pixel any of the 256 grey levels, the same on every platform for a seed.
inline textplane::Image<std::uint8_t> noise(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  textplane::Image<std::uint8_t> image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image(x, y) = static_cast<std::uint8_t>(random() & 255U);
  return image;
}

}  // namespace textplane_test

#endif  // TEXTPLANE_TEST_SUPPORT_NOISE_HPP
