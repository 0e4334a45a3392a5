#include "textslam/map/point_mapper.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/geometry/triangulate.hpp"
#include "textslam/common/statistics.hpp"

namespace textslam {

void add_observation(Map& map, int point, int keyframe, const Vec2& px) {
  map.point(point).observations.push_back({keyframe, px});
  map.keyframe(keyframe).points.push_back(point);
}

void drop_point(Map& map, int point) {
  MapPoint& dropped = map.point(point);
  dropped.bad = true;
  for (const PointObservation& o : dropped.observations) {
    auto& points = map.keyframe(o.keyframe).points;
    points.erase(std::remove(points.begin(), points.end(), point), points.end());
  }
  dropped.observations.clear();
  dropped.observations.shrink_to_fit();  // most points of a long run are bad in the end
}

void remove_observation(Map& map, int point, int keyframe) {
  auto& observations = map.point(point).observations;
  observations.erase(std::remove_if(observations.begin(), observations.end(),
                                    [&](const PointObservation& o) { return o.keyframe == keyframe; }),
                     observations.end());
  auto& points = map.keyframe(keyframe).points;
  points.erase(std::remove(points.begin(), points.end(), point), points.end());
  if (observations.size() < 2) drop_point(map, point);
}

int insert_keyframe(Map& map, const Frame& frame, const SE3d& T_w_c, std::vector<Track>& tracks) {
  const int id = static_cast<int>(map.keyframes.size());
  map.keyframes.push_back({frame, T_w_c, {}, false});
  for (Track& track : tracks) {
    if (track.point < 0) {
      track.observations.push_back({id, track.px.cast<double>()});
    } else if (track.inlier && !map.point(track.point).bad) {
      add_observation(map, track.point, id, track.px.cast<double>());
    }
  }
  return id;
}

int triangulate_tracks(Map& map, const Parameters& parameters, std::vector<Track>& tracks) {
  int made = 0;
  std::vector<SE3d> poses;
  std::vector<Vec3> rays;
  for (Track& track : tracks) {
    if (track.point >= 0 || track.observations.size() < 2) continue;
    poses.clear();
    rays.clear();
    for (const PointObservation& o : track.observations) {
      poses.push_back(map.keyframe(o.keyframe).T_w_c.inverse());
      rays.push_back(map.camera.unproject(o.px));
    }
    const Vec3 last = poses.back().R.transpose() * rays.back();
    double parallax = 0;
    for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
      const Vec3 ray = poses[i].R.transpose() * rays[i];
      parallax = std::max(parallax, std::atan2(ray.cross(last).norm(), ray.dot(last)));
    }
    if (parallax < parameters.min_parallax * M_PI / 180) continue;
    MapPoint point;
    const auto status =
        textplane::triangulate_views(poses.data(), rays.data(), static_cast<int>(poses.size()), &point.p_w);
    if (!textplane::is_ok(status)) continue;
    bool consistent = true;
    for (std::size_t i = 0; i < poses.size() && consistent; ++i) {
      const Vec3 p = poses[i] * point.p_w;
      consistent = p.z() > 0 && (map.camera.project(p) - track.observations[i].px).norm() < parameters.max_reprojection;
    }
    if (!consistent) {
      // The track slid from one thing to another: it starts anew from here.
      if (track.observations.size() > 3)
        track.observations.erase(track.observations.begin(), track.observations.end() - 1);
      continue;
    }
    track.point = static_cast<int>(map.points.size());
    track.inlier = true;
    map.points.push_back(std::move(point));
    for (const PointObservation& o : track.observations) add_observation(map, track.point, o.keyframe, o.px);
    track.observations.clear();
    ++made;
  }
  return made;
}

void cull_points(Map& map, const Parameters& parameters, std::vector<Track>& tracks) {
  for (std::size_t id = 0; id < map.points.size(); ++id) {
    const MapPoint& point = map.points[id];
    if (point.bad || point.visible < 20) continue;
    if (point.found >= parameters.min_found_share * point.visible) continue;
    drop_point(map, static_cast<int>(id));
  }
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [&](const Track& t) { return t.point >= 0 && map.point(t.point).bad; }),
               tracks.end());
}

std::vector<int> shared_points(const Map& map, const std::vector<int>& points) {
  std::vector<int> shared(map.keyframes.size(), 0);
  for (const int id : points)
    for (const PointObservation& o : map.point(id).observations) ++shared[static_cast<std::size_t>(o.keyframe)];
  return shared;
}

double median_depth(const Map& map, int id) {
  const KeyFrame& keyframe = map.keyframe(id);
  const SE3d T_c_w = keyframe.T_w_c.inverse();
  std::vector<double> depths;
  for (const int point : keyframe.points) depths.push_back((T_c_w * map.point(point).p_w).z());
  return median(std::move(depths));
}

}  // namespace textslam
