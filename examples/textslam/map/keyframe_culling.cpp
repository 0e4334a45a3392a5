#include "textslam/map/keyframe_culling.hpp"

#include <algorithm>

#include "textslam/map/point_mapper.hpp"
#include "textslam/track/tracker.hpp"

namespace textslam {
namespace {

bool seen_enough(const Parameters& parameters, std::size_t others) {
  return static_cast<int>(others) >= parameters.redundant_views;
}

bool texts_allow(const Map& map, const Parameters& parameters, int id) {
  return std::all_of(map.texts.begin(), map.texts.end(), [&](const TextObject& text) {
    if (text.state == TextState::dropped) return true;
    if (text.host == id) return false;
    const bool shown = std::find(text.targets.begin(), text.targets.end(), id) != text.targets.end();
    return !shown || seen_enough(parameters, text.targets.size());  // the host in its place
  });
}

bool points_allow(const Map& map, const Parameters& parameters, int id) {
  const std::vector<int>& points = map.keyframe(id).points;
  const auto seen = std::count_if(points.begin(), points.end(), [&](int point) {
    return seen_enough(parameters, map.point(point).observations.size() - 1);
  });
  return static_cast<double>(seen) >= parameters.redundant_share * static_cast<double>(points.size());
}

}  // namespace

int find_redundant_keyframe(const Map& map, const Parameters& parameters, const LocalMap& local, int from) {
  const int newest = static_cast<int>(map.keyframes.size()) - 1;
  for (int id = std::max(1, from); id <= newest - parameters.window_frames; ++id)
    if (!map.keyframe(id).culled && local.has_keyframe(id) && points_allow(map, parameters, id) &&
        texts_allow(map, parameters, id))
      return id;
  return -1;
}

std::vector<SeenPoint> seen_by_keyframe(const Map& map, int id, std::size_t most) {
  return seen_points(tracks_of_keyframe(map, id), most);
}

int keyframe_before(const Map& map, int id) {
  do --id;
  while (map.keyframe(id).culled);
  return id;
}

void cull_keyframe(Map& map, int id, std::vector<Track>& tracks) {
  const std::vector<int> points = map.keyframe(id).points;
  for (const int point : points) remove_observation(map, point, id);
  for (TextObject& text : map.texts)
    text.targets.erase(std::remove(text.targets.begin(), text.targets.end(), id), text.targets.end());
  for (Track& track : tracks)
    track.observations.erase(std::remove_if(track.observations.begin(), track.observations.end(),
                                            [&](const PointObservation& o) { return o.keyframe == id; }),
                             track.observations.end());
  KeyFrame& keyframe = map.keyframe(id);
  keyframe.culled = true;
  keyframe.frame.image.reset();
  keyframe.frame.detections.clear();
  keyframe.frame.detections.shrink_to_fit();
  keyframe.points.shrink_to_fit();
}

}  // namespace textslam
