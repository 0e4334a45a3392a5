// The final planes of the texts, once the poses of the key frames are known.
#ifndef TEXTSLAM_TEXT_TEXT_REFINER_HPP
#define TEXTSLAM_TEXT_TEXT_REFINER_HPP

#include "textslam/map/map.hpp"

namespace textslam {

/// Refines every mapped text (textplane/landmarks/text_refiner.hpp) with the map's points, and drops those that are not
/// planar, whose normal stays uncertain, that the detector saw too seldom, or of which no two whole views agree.
void refine_texts(Map& map, const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_REFINER_HPP
