#include "textslam/track/observe_points.hpp"

#include <algorithm>
#include <vector>

#include "textslam/map/observations.hpp"
#include "textslam/track/point_search.hpp"

namespace textslam {

int observe_points_again(Map& map, const Parameters& parameters) {
  struct Found {
    int point, keyframe;
    Vec2 px;
  };
  std::vector<Found> found;
  std::vector<char> observed(map.points.size());
  for (const int id : map.keyframe_ids()) {
    const KeyFrame& keyframe = map.keyframe(id);
    const SE3d T_c_w = keyframe.T_w_c.inverse();
    const CameraView camera = map.view_of(id);
    std::fill(observed.begin(), observed.end(), 0);
    for (const int point : keyframe.points) observed[static_cast<std::size_t>(point)] = 1;
    for (std::size_t k = 0; k < map.points.size(); ++k) {
      PointPrediction prediction;
      if (map.points[k].bad || observed[k] != 0 ||
          !predict_point(map, parameters, map.points[k], camera, T_c_w, keyframe.T_w_c.t, &prediction))
        continue;
      Vec2f px = prediction.px.cast<float>();
      if (find_point(map, parameters, prediction, keyframe.frame, 0, &px) &&
          (px.cast<double>() - prediction.px).norm() <= parameters.max_reprojection)
        found.push_back({static_cast<int>(k), id, px.cast<double>()});
    }
  }
  for (const Found& f : found) add_observation(map, f.point, f.keyframe, f.px);
  return static_cast<int>(found.size());
}

}  // namespace textslam
