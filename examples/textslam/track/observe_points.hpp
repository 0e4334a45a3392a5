// The map's points, looked for once more in all its key frames.
//
// A point is followed from frame to frame and found again near where it was seen last; key frames before it was made,
// or in which it was lost, do not observe it, though many show it. With poses that are adjusted it is expected within
// a few pixels, so its patch finds it there. More views of a point are a wider base, and tie key frames that shared
// nothing.
#ifndef TEXTSLAM_TRACK_OBSERVE_POINTS_HPP
#define TEXTSLAM_TRACK_OBSERVE_POINTS_HPP

#include "textslam/map/map.hpp"

namespace textslam {

/// Adds the observations found; those that the map has stay. Patches come from observations that were there before.
/// Returns how many were added.
int observe_points_again(Map& map, const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_OBSERVE_POINTS_HPP
