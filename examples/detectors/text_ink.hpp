// Ink: which pixels are darker or lighter than their surroundings, the first step of the classical text detector.
#ifndef TEXTSLAM_DETECTORS_TEXT_INK_HPP
#define TEXTSLAM_DETECTORS_TEXT_INK_HPP

#include <cstdint>
#include <vector>

#include "detectors/classical_parameters.hpp"
#include "io/names.hpp"

namespace textslam {

/// The classes of a pixel.
constexpr std::uint8_t kPaper = 0, kDarkInk = 1, kLightInk = 2;

/// Memory that mark_ink() keeps from call to call.
struct InkScratch {
  std::vector<std::uint32_t> column, column_squares;  ///< sums over the window's rows, a column each
  std::vector<std::uint32_t> prefix, prefix_squares;
};

/// Writes the class of every pixel: ink where it differs from the mean of the (2 window_radius + 1)^2 window around it,
/// cut at the border, by more than ink_sigmas standard deviations and ink_floor. `out` takes the image's size.
void mark_ink(const ImageView8& image, const ClassicalParameters& parameters, InkScratch& scratch,
              Image<std::uint8_t>& out);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_TEXT_INK_HPP
