// Letters: connected pieces of ink that look like a letter, the second step of the classical text detector.
#ifndef TEXTSLAM_DETECTORS_TEXT_LETTERS_HPP
#define TEXTSLAM_DETECTORS_TEXT_LETTERS_HPP

#include <vector>

#include "detectors/classical_parameters.hpp"
#include "detectors/pieces.hpp"
#include "io/names.hpp"

namespace textslam {

/// A piece of ink that may be a letter. Lengths in px of the image it was found in; tones in grey levels.
struct Letter {
  std::vector<Vector2<double>> outline;              ///< convex hull of its pixels' squares, clockwise on the screen
  Vector2<double> centre = Vector2<double>::Zero();  ///< of the bounding box
  double size = 0;                                   ///< the longer side of the bounding box
  double area = 0;                                   ///< px^2
  double stroke = 0;                                 ///< width of the stroke
  double ink = 0, paper = 0;                         ///< mean tone of the letter, and of what is beside it
  bool light = false;                                ///< lighter than its paper

  double contrast() const { return light ? ink - paper : paper - ink; }
};

/// The extent of a letter along a direction.
struct Extent {
  double low, high;
  double length() const { return high - low; }
};
Extent extent(const Letter& letter, const Vector2<double>& direction);

/// Memory that find_letters() keeps from call to call.
struct LetterScratch {
  Pieces pieces;
  std::vector<int> distance;
};

/// The letters of an image whose ink is marked, by their first pixel. Pieces at the border are left out: they are cut.
void find_letters(const ImageView8& image, const Image<std::uint8_t>& ink, const ClassicalParameters& parameters,
                  LetterScratch& scratch, std::vector<Letter>& letters);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_TEXT_LETTERS_HPP
