#include "textslam/map_file/map_file.hpp"
#include "textslam/map_file/schema.hpp"
#include "textslam/map_file/tables.hpp"

namespace textslam {

LoadedMap load_map(const std::string& path, const Parameters& parameters) {
  Database database = open_map(path);
  database.execute("begin");  // one state of the file, whoever writes meanwhile
  return load_tables(database, parameters);
}

CameraModel load_map_camera(const std::string& path) {
  Database database = open_map(path);
  MapRecord record;
  load_sessions(database, &record);
  return record.camera;
}

LoadedMap load_tables(Database& database, const Parameters& parameters) {
  if (Statement(database, "pragma foreign_key_check").next())
    database.refuse("damaged: rows refer to rows that are gone");
  LoadedMap loaded;
  loaded.record.revision = database.integer("select max(revision) from map");
  Statement scale(database, "select scale_sigma from map where scale_sigma is not null");
  if (scale.next()) loaded.record.scale_sigma = scale.number(0);
  load_sessions(database, &loaded.record);
  const CameraModel& camera = loaded.record.camera;
  loaded.camera = std::make_shared<const SequenceCamera>(camera);
  loaded.map.camera = loaded.camera->view();
  loaded.map.width = camera.width;
  loaded.map.height = camera.height;
  loaded.map.shutter = at_middle(camera.shutter, camera.height);
  load_keyframes(database, at_size(parameters, camera.width, camera.height), &loaded.record, &loaded.map);
  load_points(database, &loaded.map);
  load_texts(database, &loaded.map);
  return loaded;
}

}  // namespace textslam
