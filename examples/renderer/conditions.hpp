// Conditions: what a sweep varies about a rendered sequence, each in place of what its kind says.
//
// The errors of the detector are varied in DetectorErrors (detector_model.hpp), which no kind changes.
#ifndef TEXTSLAM_RENDERER_CONDITIONS_HPP
#define TEXTSLAM_RENDERER_CONDITIONS_HPP

#include <optional>

#include "renderer/kinds.hpp"

namespace textslam {

/// What is not set is the kind's.
struct Conditions {
  /// px: length of the motion blur, the same in every frame and pixel, along the way that the image moves at that time.
  /// The shutter is instant otherwise, so 0 gives sharp frames.
  std::optional<double> blur;
  std::optional<double> gain;   ///< Of the sensor, constant in time; bias, vignette and glare stay.
  std::optional<double> noise;  ///< Grey levels: standard deviation of all noise, the same at every brightness.
};

/// Exposure and sensor of the shot under the conditions; its blur is the affair of blur_along().
void apply(const Conditions& conditions, Shot* shot);

/// The mean of the image along a line of `length` px centred on each pixel, read bilinearly; beyond the border its edge
/// goes on. The image itself for a length of 0.
Image<double> blur_along(const Image<double>& light, const Vector2<double>& direction, double length);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_CONDITIONS_HPP
