// Track: a corner followed from frame to frame.
#ifndef TEXTSLAM_TRACK_TRACK_HPP
#define TEXTSLAM_TRACK_TRACK_HPP

#include <vector>

#include "textslam/map/map.hpp"

namespace textslam {

struct Track {
  Vec2f px = Vec2f::Zero();
  int point = -1;                                   ///< Id of its map point, -1 while it has none.
  std::vector<PointObservation> observations = {};  ///< In key frames, while it has no point.
  bool inlier = true;                               ///< Of the last pose.
};

/// The observations of its point, or its own while it has none.
inline const std::vector<PointObservation>& observations_of(const Map& map, const Track& track) {
  return track.point >= 0 ? map.point(track.point).observations : track.observations;
}

/// Tracks at the points that key frame `id` observes: what a tracker that starts there follows.
std::vector<Track> tracks_of_keyframe(const Map& map, int id);

/// Erases the tracks whose points are bad.
void erase_bad_tracks(const Map& map, std::vector<Track>& tracks);

/// Erases what tracks without a point observed in key frame `id`.
void forget_keyframe(int id, std::vector<Track>& tracks);

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_TRACK_HPP
