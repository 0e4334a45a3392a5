// What readers share: the picture of a line cut out of an image, and what of a reading is a word.
#ifndef TEXTSLAM_DETECTORS_LINE_PICTURE_HPP
#define TEXTSLAM_DETECTORS_LINE_PICTURE_HPP

#include <string>

#include "io/detections.hpp"

namespace textslam {

/// Bilinear, edge pixels repeated beyond the image.
std::uint8_t grey_at(ImageView8 image, double x, double y);

/// The quad's inside as a rectangle `height` px high, `margin` of that height around it; of quads that are longer than `longest`
/// times their height it is squeezed. Empty where the quad is smaller than 4 px or not finite.
Image<std::uint8_t> line_picture(ImageView8 image, const Quad<double>& quad, int height, double margin, double longest);

/// Without the marks around it, which are no part of a word, and UTF-8; empty with less than two letters or digits: texture is
/// mostly read as marks and single letters.
std::string word_of(std::string reading);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_LINE_PICTURE_HPP
