// Quads: the outline of a line of letters, and whether it is text; the fourth step of the classical text detector.
#ifndef TEXTSLAM_DETECTORS_TEXT_QUADS_HPP
#define TEXTSLAM_DETECTORS_TEXT_QUADS_HPP

#include <vector>

#include "detectors/classical_parameters.hpp"
#include "detectors/text_letters.hpp"

namespace textslam {

struct TextQuad {
  Quad<double> quad;  ///< px of the image the letters were found in, clockwise from the text's top left
  double score = 0;   ///< in (0, 1]; 0 where the line is not text
};

/// The quad around a line: top and bottom through the letters' tops and bottoms (the text may taper), sides that lean
/// with the letters. The score says how much they look like print: many, on common lines, of even tones. It is 0 below
/// min_score and for patterns (books, railings, tiles, leaves).
TextQuad fit_quad(const std::vector<Letter>& letters, const std::vector<int>& line,
                  const ClassicalParameters& parameters);

/// Drops each quad that shares more than max_shared_area of the smaller with a better one. Best first.
void suppress_overlaps(std::vector<TextQuad>& quads, const ClassicalParameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_TEXT_QUADS_HPP
