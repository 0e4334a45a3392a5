// For readers: the picture of a line cut out of an image, and the word in a reading.
#ifndef TEXTSLAM_DETECTORS_LINE_PICTURE_HPP
#define TEXTSLAM_DETECTORS_LINE_PICTURE_HPP

#include <string>

#include "io/detections.hpp"

namespace textslam {

/// Bilinear, edge pixels repeated beyond the image.
std::uint8_t grey_at(ImageView8 image, double x, double y);

/// The quad's inside as a rectangle `height` px high, with `margin` of that height around it. Quads longer than
/// `longest` times their height are squeezed. Empty if the quad is smaller than 4 px or not finite.
Image<std::uint8_t> line_picture(ImageView8 image, const Quad<double>& quad, int height, double margin, double longest);

/// The reading as UTF-8 without the marks around it. Empty with less than two letters or digits: readers take texture
/// for marks and single letters.
std::string word_of(std::string reading);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_LINE_PICTURE_HPP
