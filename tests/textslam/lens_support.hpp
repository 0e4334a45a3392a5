// Lenses to look through.
#ifndef TESTS_TEXTSLAM_LENS_SUPPORT_HPP
#define TESTS_TEXTSLAM_LENS_SUPPORT_HPP

#include "textplane/core/cameras/camera_view.hpp"

namespace textslam {
namespace lens_support {

using textplane::LensMap;

/// A wide-angle lens as visual-inertial sensors have: at half a radian off the axis it moves a pixel by 7 per cent.
inline const LensMap& wide_lens() {
  static const LensMap lens(textplane::RadialTangential<double>{{}, -0.28, 0.07, 1e-3, -5e-4, 0});
  return lens;
}
/// A fisheye: pixels are nearly as far from the middle as the angle is wide, up to 80 degrees.
inline const LensMap& fisheye() {
  static const LensMap lens(textplane::KannalaBrandt<double>{{}, 0.01, -0.003, 0.002, -0.001});
  return lens;
}

}  // namespace lens_support
}  // namespace textslam

#endif  // TESTS_TEXTSLAM_LENS_SUPPORT_HPP
