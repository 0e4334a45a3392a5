// What the tests of examples/renderer share.
#ifndef TESTS_RENDERER_RENDERER_SUPPORT_HPP
#define TESTS_RENDERER_RENDERER_SUPPORT_HPP

#include <cmath>

#include "io/sequence.hpp"

namespace textslam {

/// The renderer's camera at the given width, 4:3.
inline CameraModel test_camera(int width = 640, RadialTangential<double> lens = {}) {
  CameraModel camera;
  camera.width = width;
  camera.height = width * 3 / 4;
  const double f = 525.0 / 640.0 * width;
  lens.intrinsics = {f, f, 0.5 * (camera.width - 1), 0.5 * (camera.height - 1)};
  camera.raw = lens;
  camera.fps = 30.0;
  return camera;
}

/// A mild wide-angle lens.
inline RadialTangential<double> test_lens() {
  RadialTangential<double> lens;
  lens.k1 = -0.12;
  lens.k2 = 0.03;
  lens.p1 = 0.0008;
  lens.p2 = -0.0011;
  return lens;
}

/// A fisheye whose domain ends 95 degrees off the axis, in a circle as wide as the image.
inline CameraModel fisheye_camera(int width) {
  constexpr double kEnd = 95 * M_PI / 180;
  CameraModel camera;
  camera.width = width;
  camera.height = width * 3 / 4;
  const double f = 0.5 * width / (kEnd * 8 / 9);
  camera.raw = textplane::KannalaBrandt<double>{
      {f, f, 0.5 * (camera.width - 1), 0.5 * (camera.height - 1)}, 0, 0, 0, -1 / (9 * std::pow(kEnd, 8))};
  camera.fps = 30.0;
  return camera;
}

}  // namespace textslam

#endif  // TESTS_RENDERER_RENDERER_SUPPORT_HPP
