// Reading of the mapped texts once their planes are known.
//
// A detector's box round a slanted text is sheared, foreshortened and often blurred. The plane rectifies the text, and
// it is read in its sharpest views. The readings vote for its word.
#ifndef TEXTSLAM_TEXT_TEXT_READING_HPP
#define TEXTSLAM_TEXT_TEXT_READING_HPP

#include "textslam/detect/text_detector.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// A text rectified: seen from the front, with a level base line, in the upright rectangle around its quad.
struct SquareView {
  Image<std::uint8_t> picture;
  Quad<double> quad;     ///< The rectangle, px of the picture; around it is a margin.
  double sharpness = 0;  ///< Of one text's views of equal height, the larger and less blurred are sharper.
};

/// As key frame `id` shows it, reading_height px high; without a picture where the image does not hold it whole.
SquareView square_view(const Map& map, const TextObject& text, int id, const Parameters& parameters);

/// Reads every mapped text in its reading_views sharpest views, either way up. Less sharp views have fewer votes.
void read_texts(Map& map, const Parameters& parameters, TextReader& reader);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_READING_HPP
