// Textures of random spots for rendered walls and boards: the same on every platform.
#ifndef TEXTPLANE_TESTS_SUPPORT_SPOTS_HPP
#define TEXTPLANE_TESTS_SUPPORT_SPOTS_HPP

#include <cmath>
#include <cstdint>

namespace textplane_test {

/// A random number for each spot of a grid, another one for each print.
inline std::uint32_t spot_number(std::uint32_t column, std::uint32_t row, std::uint32_t print = 0) {
  std::uint32_t h = column * 2654435761U ^ row * 2246822519U ^ print * 3266489917U;
  h = (h ^ (h >> 15)) * 739982445U;
  h = (h ^ (h >> 12)) * 695872825U;
  return h ^ (h >> 15);
}

/// Linear between the spots: spot(column, row) is the value at whole numbers u and v.
template <class Spot>
double between_spots(double u, double v, Spot spot) {
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  const double a = u - i, b = v - j;
  return (1 - b) * ((1 - a) * spot(i, j) + a * spot(i + 1, j)) +
         b * ((1 - a) * spot(i, j + 1) + a * spot(i + 1, j + 1));
}

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SUPPORT_SPOTS_HPP
