// What goes into and comes out of a recogniser network with CTC output, such as PP-OCR's: the picture of a line, and
// the probabilities of letters from left to right. Who runs the network is another matter.
#ifndef TEXTSLAM_DETECTORS_LINE_RECOGNISER_HPP
#define TEXTSLAM_DETECTORS_LINE_RECOGNISER_HPP

#include <string>
#include <vector>

#include "textslam/detect/text_detector.hpp"

namespace textslam {

struct RecogniserParameters {
  int height = 48;              ///< px of the network's input,
  int width = 320;              ///< longer lines are squeezed into it.
  double margin = 0.1;          ///< Of a quad's height, around it.
  double min_confidence = 0.5;  ///< 0 to 1: mean probability of the letters.
};

/// The picture of a quad in the size of the network's input, at most `width` px wide. Empty where line_picture() is.
Image<std::uint8_t> recogniser_picture(ImageView8 raw_image, const Quad<double>& quad,
                                       const RecogniserParameters& parameters);

/// Writes 3 x height x width values in [-1, 1] of a grey picture, 0 beside and below it.
void recogniser_input(const Image<std::uint8_t>& picture, int width, int height, float* out);

/// CTC's best path: the likeliest class of each step, without repetitions and blanks (class 0). `probability`: steps x
/// classes, row by row. `letters` are the classes from 1 on; the last class is the space.
TextReader::Reading decode_ctc(const float* probability, int steps, int classes,
                               const std::vector<std::string>& letters);

/// That as a word, unread where there is none or the network is not sure.
TextReader::Reading read_word(const float* probability, int steps, int classes, const std::vector<std::string>& letters,
                              const RecogniserParameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_LINE_RECOGNISER_HPP
