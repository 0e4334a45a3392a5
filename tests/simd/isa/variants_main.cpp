// Links translation units of other optimisation, other standards, with and without the library's and Eigen's
// assertions: TEXTPLANE_TEST_UNITS is UNIT(name) of each. All compute the same, whichever copies the linker keeps of
// what they share.
#include "scene.hpp"

#define UNIT(name) bool name(const std::uint8_t* pixels, int width, int height, double* result);
TEXTPLANE_TEST_UNITS
#undef UNIT

int main() {
  Scene scene;
  bool first = true, same = true;
#define UNIT(name)                               \
  same = same && (!first || scene.expect(name)); \
  first = false;                                 \
  same = same && scene.agrees(#name, name);
  TEXTPLANE_TEST_UNITS
#undef UNIT
  return same ? 0 : 1;
}
