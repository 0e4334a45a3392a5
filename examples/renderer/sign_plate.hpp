// Sign plates: a word set in a font on a plate, and where on the plate the text stands.
#ifndef TEXTSLAM_RENDERER_SIGN_PLATE_HPP
#define TEXTSLAM_RENDERER_SIGN_PLATE_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/font.hpp"
#include "renderer/random.hpp"
#include "renderer/scene.hpp"

namespace textslam {

/// The painted plate, and the box of its text in metres from the plate's top left.
struct SignPlate {
  Canvas paint;
  Image<std::uint8_t> letters;                     ///< 255 where the paint is a letter's, 0 where it is the plate's
  double text_x, text_y, text_width, text_height;  ///< m
};

/// A plate `width` metres wide for the word, which determines its height. The random numbers choose dark on light or
/// light on dark, a border or none, and the font. As in a detector's box, the text box leaves a rim of 6 % of the
/// text's height round the ink.
SignPlate make_sign_plate(const std::string& word, double width, const std::vector<Font>& fonts, Random& random);

/// `count` different English words in capitals, in random order. At most 48.
std::vector<std::string> sign_words(int count, Random& random);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_SIGN_PLATE_HPP
