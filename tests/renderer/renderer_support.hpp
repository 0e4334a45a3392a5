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

}  // namespace textslam

#endif  // TESTS_RENDERER_RENDERER_SUPPORT_HPP
