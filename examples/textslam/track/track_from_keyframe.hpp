// Corners of texts that were detected late: found in the key frame that shows them, and tracked from there to the
// newest frame.
#ifndef TEXTSLAM_TRACK_TRACK_FROM_KEYFRAME_HPP
#define TEXTSLAM_TRACK_TRACK_FROM_KEYFRAME_HPP

#include <vector>

#include "textslam/track/track.hpp"

namespace textslam {

/// Tracks as they were in key frame `id`: first those of `tracks` that it observes, then its other map points. `now`
/// gets the newest positions of the first.
std::vector<Track> tracks_in_keyframe(const Map& map, int id, const std::vector<Track>& tracks,
                                      std::vector<Vec2f>* now);

/// New tracks inside the quads of `then`, a frame with id `keyframe`, tracked to `newest` in one step. `tracks` are
/// those of frame `then`: new corners keep clear of them. `now` holds where the first of these are in `newest`; the new
/// corners are expected to move like their nearest neighbours.
std::vector<Track> track_from_keyframe(const Frame& then, int keyframe, const std::vector<Quad<double>>& quads,
                                       const std::vector<Track>& tracks, const std::vector<Vec2f>& now,
                                       const Frame& newest, const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_TRACK_FROM_KEYFRAME_HPP
