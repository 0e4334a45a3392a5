#include "textslam/adjust/adjustment_selection.hpp"

#include <algorithm>

#include "textslam/common/algorithms.hpp"
#include "textslam/map/observations.hpp"

namespace textslam {
namespace {

// Of these key frames, the farthest from key frame `id` that is its neighbour; -1 where none is.
int farthest_neighbour(const Map& map, const Parameters& parameters, int id, const std::vector<int>& among) {
  const std::vector<int> shared = shared_points(map, map.keyframe(id).points);
  int farthest = -1;
  double distance = 0;
  for (const int other : among) {
    const double d = (map.keyframe(other).T_w_c.t - map.keyframe(id).T_w_c.t).norm();
    if (shared[static_cast<std::size_t>(other)] < parameters.local_min_shared || d <= distance) continue;
    farthest = other;
    distance = d;
  }
  return farthest;
}

// Ids of key frames with the largest counts, at least `least` each; ties to the newer.
std::vector<int> strongest(const std::vector<int>& shared, int least, std::size_t count) {
  std::vector<int> ids;
  for (std::size_t i = 0; i < shared.size(); ++i)
    if (shared[i] >= least) ids.push_back(static_cast<int>(i));
  std::sort(ids.begin(), ids.end(), [&](int a, int b) {
    const int sa = shared[static_cast<std::size_t>(a)], sb = shared[static_cast<std::size_t>(b)];
    return sa != sb ? sa > sb : a > b;
  });
  if (ids.size() > count) ids.resize(count);
  return ids;
}

std::vector<int> points_of(const Map& map, const std::vector<int>& keyframes) {
  std::vector<int> points;
  for (const int id : keyframes)
    points.insert(points.end(), map.keyframe(id).points.begin(), map.keyframe(id).points.end());
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace

AdjustmentSelection local_selection(const Map& map, const Parameters& parameters) {
  const int newest = map.newest_keyframe();
  std::vector<int> shared = shared_points(map, map.keyframe(newest).points);
  shared[static_cast<std::size_t>(newest)] = static_cast<int>(map.points.size()) + 1;
  AdjustmentSelection selection;
  selection.free_frames =
      strongest(shared, parameters.local_min_shared, static_cast<std::size_t>(parameters.window_frames));
  erase(selection.free_frames, 0);
  selection.points = points_of(map, selection.free_frames);

  shared = shared_points(map, selection.points);
  for (const int id : selection.free_frames) shared[static_cast<std::size_t>(id)] = 0;
  selection.fixed_frames = strongest(shared, 1, static_cast<std::size_t>(parameters.window_fixed));
  if (selection.fixed_frames.empty()) return {};
  // Where one alone is fixed, as in a young map, its distance to another holds the scale.
  if (selection.fixed_frames.size() == 1)
    selection.scale_frame = farthest_neighbour(map, parameters, selection.fixed_frames[0], selection.free_frames);
  return selection;
}

AdjustmentSelection whole_selection(const Map& map, const Parameters& parameters) {
  AdjustmentSelection selection;
  selection.free_frames = map.keyframe_ids();
  selection.fixed_frames.push_back(selection.free_frames.front());
  selection.free_frames.erase(selection.free_frames.begin());
  for (std::size_t i = 0; i < map.points.size(); ++i)
    if (!map.points[i].bad) selection.points.push_back(static_cast<int>(i));
  selection.scale_frame = farthest_neighbour(map, parameters, selection.fixed_frames.front(), selection.free_frames);
  if (selection.scale_frame < 0) selection.scale_frame = selection.free_frames.front();
  return selection;
}

}  // namespace textslam
