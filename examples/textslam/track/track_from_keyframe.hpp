// Corners of texts that were detected late, tracked from their key frame to the newest frame.
#ifndef TEXTSLAM_TRACK_TRACK_FROM_KEYFRAME_HPP
#define TEXTSLAM_TRACK_TRACK_FROM_KEYFRAME_HPP

#include <vector>

#include "textslam/track/track.hpp"

namespace textslam {

/// Tracks as they were in key frame `id`: those of `tracks` that it observes, with their newest positions in `now`,
/// then its other map points.
std::vector<Track> tracks_in_keyframe(const Map& map, int id, const std::vector<Track>& tracks,
                                      std::vector<Vec2f>* now);

/// New tracks inside the quads of `then`, a frame with id `keyframe`, tracked to `newest` in one step. They keep clear
/// of the frame's `tracks`; `now`, where the first of these are in `newest`, tells where to expect them.
std::vector<Track> track_from_keyframe(const Frame& then, const CameraView& camera, int keyframe,
                                       const std::vector<Quad<double>>& quads, const std::vector<Track>& tracks,
                                       const std::vector<Vec2f>& now, const Frame& newest,
                                       const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_TRACK_FROM_KEYFRAME_HPP
