// Text hypotheses: poses of a lost frame from the signs that its detector found.
//
// A detection that may be a mapped text gives up to two poses from its four corners. A coarse search by ZNCC around
// each keeps the promising ones, which are refined on the text's pixels. The frame's other detections then confirm them
// or not: a pose that explains several signs comes first.
#ifndef TEXTSLAM_RELOCALISE_TEXT_HYPOTHESES_HPP
#define TEXTSLAM_RELOCALISE_TEXT_HYPOTHESES_HPP

#include <vector>

#include "textslam/map/map.hpp"

namespace textslam {

/// Which detections are compared with which texts.
enum class WordMatch {
  same,    ///< Both are read, and read the same.
  unread,  ///< One is not read.
  other,   ///< Different words, or one not read: words may be misread.
};

struct TextHypothesis {
  SE3d T_c_w;
  int text = -1;      ///< Id of the text that it comes from.
  int confirmed = 0;  ///< Detections that a mapped text falls on.
  double zncc = 0;    ///< Of the text.
};

/// The poses worth trying in full, the best first, at most relocalise_hypotheses. Nearly equal poses of one text count
/// once.
std::vector<TextHypothesis> text_hypotheses(const Map& map, const Parameters& parameters, const Frame& frame,
                                            WordMatch words);

}  // namespace textslam

#endif  // TEXTSLAM_RELOCALISE_TEXT_HYPOTHESES_HPP
