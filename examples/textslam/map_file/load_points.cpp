// Points and their observations.
#include "textslam/map/observations.hpp"
#include "textslam/map_file/tables.hpp"

namespace textslam {

void load_points(Database& database, Map* map) {
  const std::int64_t most = database.integer("select coalesce(max(id), -1) from points");
  if (most > kMostId || database.integer("select coalesce(min(id), 0) from points") < 0)
    database.refuse("damaged: the id of a point is out of range");
  map->points.resize(static_cast<std::size_t>(most + 1));
  for (MapPoint& point : map->points) {
    point.p_w.setZero();
    point.bad = true;
  }
  Statement row(database, "select id, x, y, z, nx, ny, nz, visible, found from points");
  while (row.next()) {
    MapPoint& point = map->point(row.index(0, static_cast<int>(most)));
    point.bad = false;
    point.p_w = {row.number(1), row.number(2), row.number(3)};
    point.normal_w = {row.number(4), row.number(5), row.number(6)};
    point.visible = row.index(7, INT32_MAX);
    point.found = row.index(8, INT32_MAX);
  }
  Statement seen(database, "select point, keyframe, u, v from observations order by point, number");
  while (seen.next()) {
    const int point = seen.index(0, static_cast<int>(most)), keyframe = seen.index(1, map->newest_keyframe());
    if (map->point(point).bad || map->keyframe(keyframe).culled)
      database.refuse("damaged: an observation of what is not there");
    add_observation(*map, point, keyframe, {seen.number(2), seen.number(3)});
  }
  for (const MapPoint& point : map->points)
    if (!point.bad && point.observations.size() < 2)
      database.refuse("damaged: a point with fewer than two observations");
}

}  // namespace textslam
