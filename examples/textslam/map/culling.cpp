#include "textslam/map/culling.hpp"

#include <algorithm>

#include "textslam/common/algorithms.hpp"
#include "textslam/map/observations.hpp"

namespace textslam {
namespace {

bool is_redundant(const Parameters& parameters, std::size_t other_views) {
  return static_cast<int>(other_views) >= parameters.redundant_views;
}

bool texts_allow(const Map& map, const Parameters& parameters, int id) {
  return std::all_of(map.texts.begin(), map.texts.end(), [&](const TextObject& text) {
    if (text.state == TextState::dropped) return true;
    if (text.host == id) return false;
    const bool shown = std::find(text.views.begin(), text.views.end(), id) != text.views.end();
    return !shown || is_redundant(parameters, text.views.size());  // the host in its place
  });
}

bool points_allow(const Map& map, const Parameters& parameters, int id) {
  const std::vector<int>& points = map.keyframe(id).points;
  const auto seen = std::count_if(points.begin(), points.end(), [&](int point) {
    return is_redundant(parameters, map.point(point).observations.size() - 1);
  });
  return static_cast<double>(seen) >= parameters.redundant_share * static_cast<double>(points.size());
}

}  // namespace

void cull_points(Map& map, const Parameters& parameters) {
  for (std::size_t id = 0; id < map.points.size(); ++id) {
    const MapPoint& point = map.points[id];
    if (point.bad || point.visible < parameters.min_visible) continue;
    if (point.found < parameters.min_found_share * point.visible) drop_point(map, static_cast<int>(id));
  }
}

int find_redundant_keyframe(const Map& map, const Parameters& parameters, const LocalMap& local, int from) {
  for (int id = std::max(1, from); id <= map.newest_keyframe() - parameters.window_frames; ++id)
    if (!map.keyframe(id).culled && local.has_keyframe(id) && points_allow(map, parameters, id) &&
        texts_allow(map, parameters, id))
      return id;
  return -1;
}

int keyframe_before(const Map& map, int id) {
  do --id;
  while (map.keyframe(id).culled);
  return id;
}

void cull_keyframe(Map& map, int id) {
  const std::vector<int> points = map.keyframe(id).points;
  for (const int point : points) remove_observation(map, point, id);
  for (TextObject& text : map.texts) erase(text.views, id);
  KeyFrame& keyframe = map.keyframe(id);
  keyframe.culled = true;
  keyframe.frame.image.reset();
  keyframe.looks.reset();
  keyframe.frame.detections.clear();
  keyframe.frame.detections.shrink_to_fit();
  keyframe.points.shrink_to_fit();
}

}  // namespace textslam
