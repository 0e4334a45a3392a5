#include "textslam/track/track.hpp"

#include <algorithm>

namespace textslam {

std::vector<Track> tracks_of_keyframe(const Map& map, int id) {
  std::vector<Track> tracks;
  for (const int point : map.keyframe(id).points)
    for (const PointObservation& o : map.point(point).observations) {
      if (o.keyframe != id) continue;
      tracks.emplace_back();
      tracks.back().px = o.px.cast<float>();
      tracks.back().point = point;
    }
  return tracks;
}

void erase_bad_tracks(const Map& map, std::vector<Track>& tracks) {
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [&](const Track& track) { return track.point >= 0 && map.point(track.point).bad; }),
               tracks.end());
}

void forget_keyframe(int id, std::vector<Track>& tracks) {
  for (Track& track : tracks)
    track.observations.erase(std::remove_if(track.observations.begin(), track.observations.end(),
                                            [&](const PointObservation& o) { return o.keyframe == id; }),
                             track.observations.end());
}

}  // namespace textslam
