// Lines: letters of one kind side by side, the third step of the classical text detector.
#ifndef TEXTSLAM_DETECTORS_TEXT_LINES_HPP
#define TEXTSLAM_DETECTORS_TEXT_LINES_HPP

#include <vector>

#include "detectors/classical_parameters.hpp"
#include "detectors/text_letters.hpp"

namespace textslam {

/// Letters b may follow a in a line of text that runs from the left to the right.
struct LetterPair {
  int a, b;
  double cost;  ///< the closer and the more alike, the less
};

/// Memory that find_lines() keeps from call to call.
struct LineScratch {
  std::vector<int> by_x;
  std::vector<LetterPair> pairs;    ///< by a, then by cost
  std::vector<int> first_pair;      ///< of each letter
  std::vector<LetterPair> reverse;  ///< the same pairs by b
  std::vector<int> first_reverse;
  std::vector<int> seeds;
  std::vector<char> used;
};

/// Sets of at least min_letters letters, from left to right, side by side: alike in height, stroke and tones, along a
/// direction within max_angle of the horizontal. A letter is in one line at most. `lines` is filled anew.
void find_lines(const std::vector<Letter>& letters, const ClassicalParameters& parameters, LineScratch& scratch,
                std::vector<std::vector<int>>& lines);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_TEXT_LINES_HPP
