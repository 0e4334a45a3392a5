// Bundle adjustment of the map by the library's window solver: around the newest key frame, or over all of them.
#ifndef TEXTSLAM_ADJUSTMENT_HPP
#define TEXTSLAM_ADJUSTMENT_HPP

#include "textslam/map.hpp"
#include "textslam/parameters.hpp"

namespace textslam {

/// Adjusts the newest key frame and those that share most points with it, with their points and text planes; key frames
/// around them stay fixed. Observations that no longer fit are removed.
void adjust_local(Map& map, const Parameters& parameters);

/// Adjusts everything; the first key frame is fixed, and the distance to its farthest neighbour in view fixes the scale.
void adjust_all(Map& map, const Parameters& parameters, int iterations);

}  // namespace textslam

#endif  // TEXTSLAM_ADJUSTMENT_HPP
