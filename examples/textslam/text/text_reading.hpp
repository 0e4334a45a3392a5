// Reading of the mapped texts once their planes are known.
//
// A detector's box round a slanted text is a crop of it as the camera saw it: sheared, foreshortened, often blurred.
// The plane undoes that: each text is looked at squarely, in the key frames that show it sharpest, and read there. Its
// readings vote for its word beside those of the detections.
#ifndef TEXTSLAM_TEXT_TEXT_READING_HPP
#define TEXTSLAM_TEXT_TEXT_READING_HPP

#include "textslam/detect/text_detector.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// A text squarely from the front, with its base line level, in the upright rectangle around its quad.
struct SquareView {
  Image<std::uint8_t> picture;
  Quad<double> quad;     ///< The rectangle, px of the picture; around it is a margin.
  double sharpness = 0;  ///< Of one text's views of equal height, the larger and less blurred are sharper.
};

/// As key frame `id` shows it, the rectangle reading_height px high; without a picture where the image does not hold it
/// whole.
SquareView square_view(const Map& map, const TextObject& text, int id, const Parameters& parameters);

/// Reads every mapped text in the Parameters::reading_views sharpest of the key frames that observe it, either way up.
/// A reading votes with its score, less where the view is less sharp than the sharpest.
void read_texts(Map& map, const Parameters& parameters, TextReader& reader);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_READING_HPP
