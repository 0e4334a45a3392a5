#include "textslam/track/track.hpp"

#include "textslam/common/algorithms.hpp"
#include "textslam/map/observations.hpp"

namespace textslam {

std::vector<Track> tracks_of_keyframe(const Map& map, int id) {
  std::vector<Track> tracks;
  for (const int point : map.keyframe(id).points)
    if (const Vec2* px = observed_in(map.point(point).observations, id)) tracks.push_back({px->cast<float>(), point});
  return tracks;
}

void erase_bad_tracks(const Map& map, std::vector<Track>& tracks) {
  erase_if(tracks, [&](const Track& track) { return track.point >= 0 && map.point(track.point).bad; });
}

void forget_keyframe(int id, std::vector<Track>& tracks) {
  for (Track& track : tracks) erase_if(track.observations, [&](const PointObservation& o) { return o.keyframe == id; });
}

}  // namespace textslam
