// Text recovery: poses of a lost frame from the signs that its detector found.
//
// A detection that may be a mapped text gives up to two poses from its four corners. A coarse search by ZNCC around each,
// in one batch, tells which are worth more; these are refined on the text's pixels. What else the detector saw then
// confirms them or not: a pose that explains several signs goes first.
#ifndef TEXTSLAM_TRACK_TEXT_RECOVERY_HPP
#define TEXTSLAM_TRACK_TEXT_RECOVERY_HPP

#include <vector>

#include "textslam/common/parameters.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// Which detections are compared with which texts.
enum class WordMatch {
  same,    ///< Both are read, and read the same.
  unread,  ///< One is not read.
  other,   ///< All but the same: words are misread, or not read.
};

struct TextHypothesis {
  SE3d T_c_w;
  int text = -1;      ///< Id of the text that it comes from.
  int confirmed = 0;  ///< Detections that a mapped text falls on.
  double zncc = 0;    ///< Of the text.
};

/// The poses worth trying in full, the best first, at most parameters.relocalise_hypotheses. Those of one text that are
/// nearly the same count once.
std::vector<TextHypothesis> text_hypotheses(const Map& map, const Parameters& parameters, const Frame& frame,
                                            WordMatch words);

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_TEXT_RECOVERY_HPP
