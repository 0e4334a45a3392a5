// Corners of texts that were found late: looked for in the frame that shows them, and followed from there to the newest one.
#ifndef TEXTSLAM_TRACK_LATE_CORNERS_HPP
#define TEXTSLAM_TRACK_LATE_CORNERS_HPP

#include <vector>

#include "textslam/common/parameters.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// New tracks inside the quads of `then`, a frame with id `keyframe`, that arrive in `newest`, in one step. `tracks`: those of
/// frame `then`, kept clear of; `now`: where the first of these are in `newest`, from which it is guessed where to look.
std::vector<Track> late_corners(const Frame& then, int keyframe, const std::vector<Quad<double>>& quads,
                                const std::vector<Track>& tracks, const std::vector<Vec2f>& now, const Frame& newest,
                                const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_LATE_CORNERS_HPP
