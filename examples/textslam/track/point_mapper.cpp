#include "textslam/track/point_mapper.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/geometry/triangulate.hpp"
#include "textslam/map/observations.hpp"

namespace textslam {
namespace {

// The rays of a track, and the poses (world to camera) that they are seen from.
struct Rays {
  std::vector<SE3d> poses;
  std::vector<Vec3> rays;

  Rays(const Map& map, const Track& track) {
    for (const PointObservation& o : track.observations) {
      poses.push_back(map.T_c_w_at(o.keyframe, o.px));
      rays.push_back(ray_of(map.camera, o.px));
    }
  }
  // Between the newest ray and any other, radians.
  double parallax() const {
    const Vec3 last = poses.back().R.transpose() * rays.back();
    double largest = 0;
    for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
      const Vec3 ray = poses[i].R.transpose() * rays[i];
      largest = std::max(largest, std::atan2(ray.cross(last).norm(), ray.dot(last)));
    }
    return largest;
  }
  bool triangulate(Vec3* p_w) const {
    return textplane::is_ok(
        textplane::triangulate_views(poses.data(), rays.data(), static_cast<int>(poses.size()), p_w));
  }
};

bool is_consistent(const Map& map, const Parameters& parameters, const Track& track, const Rays& rays,
                   const Vec3& p_w) {
  for (std::size_t i = 0; i < rays.poses.size(); ++i) {
    const Vec3 p = rays.poses[i] * p_w;
    if (!map.camera.in_domain(p) ||
        !((map.camera.project(p) - track.observations[i].px).norm() < parameters.max_reprojection))
      return false;
  }
  return true;
}

}  // namespace

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

int triangulate_tracks(Map& map, const Parameters& parameters, double min_parallax, std::vector<Track>& tracks) {
  int made = 0;
  for (Track& track : tracks) {
    if (track.point >= 0 || track.observations.size() < 2) continue;
    const Rays rays(map, track);
    MapPoint point;
    if (rays.parallax() < radians(min_parallax) || !rays.triangulate(&point.p_w)) continue;
    if (!is_consistent(map, parameters, track, rays, point.p_w)) {
      // The track slid from one thing to another: it starts anew from here.
      if (static_cast<int>(track.observations.size()) > parameters.max_inconsistent_views)
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

}  // namespace textslam
