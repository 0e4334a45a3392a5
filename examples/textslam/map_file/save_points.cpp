// Points and their observations.
#include "textslam/map_file/tables.hpp"

namespace textslam {

void save_points(Database& database, const Map& map) {
  Statement insert(database, "insert into points values (?, ?, ?, ?, ?, ?, ?, ?, ?)");
  Statement observe(database, "insert into observations values (?, ?, ?, ?, ?)");
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const MapPoint& point = map.points[i];
    if (point.bad || !point.p_w.allFinite() || !point.normal_w.allFinite()) continue;
    const Vec3 &p = point.p_w, &n = point.normal_w;
    const int id = static_cast<int>(i);
    insert.run(id, p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), point.visible, point.found);
    int number = 0;
    for (const PointObservation& o : point.observations) observe.run(id, number++, o.keyframe, o.px.x(), o.px.y());
  }
}

}  // namespace textslam
