#include "textslam/map/scale_map.hpp"

namespace textslam {

void scale_map(double factor, Map* map) {
  for (MapPoint& point : map->points) point.p_w *= factor;
  for (TextObject& text : map->texts) {
    text.theta /= factor;
    text.covariance /= factor * factor;
  }
  for (KeyFrame& keyframe : map->keyframes) keyframe.T_w_c.t *= factor;
  for (const int id : map->keyframe_ids()) {
    if (!map->keyframe(id).frame.rows) continue;
    textplane::RowMotion rows = *map->keyframe(id).frame.rows;
    rows.velocity.head<3>() *= factor;
    map->set_rows(id, std::make_shared<const textplane::RowMotion>(rows));
  }
}

}  // namespace textslam
