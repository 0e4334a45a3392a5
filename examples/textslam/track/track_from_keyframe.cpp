#include "textslam/track/track_from_keyframe.hpp"

#include <algorithm>

#include "textplane/geometry/quad.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/track/feature_tracks.hpp"

namespace textslam {
namespace {

// Moved as the corner nearest to it that was followed.
Vec2f guess(const Vec2f& px, const std::vector<Track>& then, const std::vector<Vec2f>& now) {
  Vec2f moved = px;
  float nearest = -1;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const float distance = (then[i].px - px).squaredNorm();
    if (nearest >= 0 && distance >= nearest) continue;
    nearest = distance;
    moved = px + now[i] - then[i].px;
  }
  return moved;
}

}  // namespace

std::vector<Track> tracks_in_keyframe(const Map& map, int id, const std::vector<Track>& tracks,
                                      std::vector<Vec2f>* now) {
  std::vector<Track> in_keyframe;
  std::vector<char> taken(map.points.size(), 0);
  const auto add = [&](const Track& track) {
    const Vec2* px = observed_in(observations_of(map, track), id);
    if (!px) return false;
    in_keyframe.push_back(track);
    in_keyframe.back().px = px->cast<float>();
    if (track.point >= 0) taken[static_cast<std::size_t>(track.point)] = 1;
    return true;
  };
  for (const Track& track : tracks)
    if (add(track)) now->push_back(track.px);
  for (const int point : map.keyframe(id).points) {
    if (taken[static_cast<std::size_t>(point)] == 0) add({Vec2f::Zero(), point});
  }
  return in_keyframe;
}

std::vector<Track> track_from_keyframe(const Frame& then, const CameraView& camera, int keyframe,
                                       const std::vector<Quad<double>>& quads, const std::vector<Track>& tracks,
                                       const std::vector<Vec2f>& now, const Frame& newest,
                                       const Parameters& parameters) {
  std::vector<Track> corners = tracks;
  add_corners(then, camera, keyframe, quads, parameters, corners);
  corners.erase(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(tracks.size()));
  const auto outside = [&](const Track& corner) {
    return std::none_of(quads.begin(), quads.end(), [&](const Quad<double>& quad) {
      return textplane::contains(quad, corner.observations.front().px);
    });
  };
  erase_if(corners, outside);
  std::vector<Vec2f> guesses;
  for (const Track& corner : corners) guesses.push_back(guess(corner.px, tracks, now));
  advance_tracks(then, newest, camera, guesses, parameters, corners);
  return corners;
}

}  // namespace textslam
