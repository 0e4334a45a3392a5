// Checks one number of a project that found an installed textplane, and that package and headers agree on the version.
#include <cmath>
#include <cstdio>
#include <cstring>

#include <textplane/core/cameras/pinhole.hpp>

int main() {
  const textplane::Pinhole<double> camera(500, 500, 320, 240);
  const textplane::Vector2<double> px = camera.project(textplane::Vector3<double>(0.2, -0.1, 2.0));
  std::printf("pixel %.17g %.17g, version %s\n", px[0], px[1], TEXTPLANE_VERSION_STRING);
  const bool same_version = std::strcmp(TEXTPLANE_VERSION_STRING, PACKAGE_VERSION) == 0;
  return std::hypot(px[0] - 370.0, px[1] - 215.0) < 1e-12 && same_version ? 0 : 1;
}
