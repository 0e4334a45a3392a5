#include "textslam/map/observations.hpp"

#include <cmath>

#include "textslam/common/algorithms.hpp"

namespace textslam {

void add_observation(Map& map, int point, int keyframe, const Vec2& px) {
  map.point(point).observations.push_back({keyframe, px});
  map.keyframe(keyframe).points.push_back(point);
}

void remove_observation(Map& map, int point, int keyframe) {
  auto& observations = map.point(point).observations;
  erase_if(observations, [&](const PointObservation& o) { return o.keyframe == keyframe; });
  erase(map.keyframe(keyframe).points, point);
  if (observations.size() < 2) drop_point(map, point);
}

void drop_point(Map& map, int point) {
  MapPoint& dropped = map.point(point);
  dropped.bad = true;
  for (const PointObservation& o : dropped.observations) erase(map.keyframe(o.keyframe).points, point);
  dropped.observations.clear();
  dropped.observations.shrink_to_fit();  // most points of a long run are bad in the end
}

const Vec2* observed_in(const std::vector<PointObservation>& observations, int keyframe) {
  for (const PointObservation& o : observations)
    if (o.keyframe == keyframe) return &o.px;
  return nullptr;
}

std::vector<int> shared_points(const Map& map, const std::vector<int>& points) {
  std::vector<int> shared(map.keyframes.size(), 0);
  for (const int id : points)
    for (const PointObservation& o : map.point(id).observations) ++shared[static_cast<std::size_t>(o.keyframe)];
  return shared;
}

double reprojection_error(const Map& map) {
  double sum = 0;
  std::size_t count = 0;
  for (const int id : map.keyframe_ids()) {
    for (const int point : map.keyframe(id).points) {
      const Vec2* const seen = observed_in(map.point(point).observations, id);
      if (!seen) continue;
      const Vec3 p = map.T_c_w_at(id, *seen) * map.point(point).p_w;
      if (!map.camera.in_domain(p)) continue;
      sum += (map.camera.project(p) - *seen).squaredNorm();
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

double median_depth(const Map& map, int id) {
  const KeyFrame& keyframe = map.keyframe(id);
  const SE3d T_c_w = keyframe.T_w_c.inverse();
  std::vector<double> depths;
  for (const int point : keyframe.points) depths.push_back((T_c_w * map.point(point).p_w).z());
  return median(std::move(depths));
}

}  // namespace textslam
