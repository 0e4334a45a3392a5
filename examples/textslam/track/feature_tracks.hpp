// Corners followed from frame to frame: KLT forth and back, and new FAST corners where the image has room.
#ifndef TEXTSLAM_TRACK_FEATURE_TRACKS_HPP
#define TEXTSLAM_TRACK_FEATURE_TRACKS_HPP

#include <vector>

#include "textslam/track/track.hpp"

namespace textslam {

/// Moves every track from frame `from` to frame `to`, of one camera; those that fail, or come to a pixel without a ray,
/// are erased. `guesses` (px in `to`) may be empty.
void advance_tracks(const Frame& from, const Frame& to, const CameraView& camera, const std::vector<Vec2f>& guesses,
                    const Parameters& parameters, std::vector<Track>& tracks);

/// Adds corners of `frame` that have a ray, away from the tracks, up to max_tracks, and up to text_corners inside each
/// of `quads`.
/// New tracks carry an observation in key frame `keyframe`.
void add_corners(const Frame& frame, const CameraView& camera, int keyframe, const std::vector<Quad<double>>& quads,
                 const Parameters& parameters, std::vector<Track>& tracks);

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_FEATURE_TRACKS_HPP
