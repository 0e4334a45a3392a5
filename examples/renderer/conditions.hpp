// Conditions: what a sweep varies about a rendered sequence. Each replaces a property of the kind.
//
// Errors of the detector are varied in DetectorErrors (detector_model.hpp): they do not depend on the kind.
#ifndef TEXTSLAM_RENDERER_CONDITIONS_HPP
#define TEXTSLAM_RENDERER_CONDITIONS_HPP

#include <optional>

#include "renderer/kinds.hpp"

namespace textslam {

/// A condition that is not set is the kind's.
struct Conditions {
  /// px: length of the motion blur, the same in every frame and pixel, along the motion of the image at that time. The
  /// shutter is instant then, so 0 gives sharp frames.
  std::optional<double> blur;
  std::optional<double> gain;   ///< Of the sensor, constant in time; bias, vignette and glare stay.
  std::optional<double> noise;  ///< Grey levels: standard deviation of all noise, the same at every brightness.
};

/// Exposure and sensor of the shot under the conditions; blur_along() adds the blur.
void apply(const Conditions& conditions, Shot* shot);

/// The mean of the image along a line of `length` px centred on each pixel, interpolated bilinearly; the border is
/// extended. The image itself for a length of 0.
Image<double> blur_along(const Image<double>& light, const Vector2<double>& direction, double length);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_CONDITIONS_HPP
