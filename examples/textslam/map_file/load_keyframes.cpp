// Sessions, the camera, key frames, their images and detections.
#include <cmath>

#include "io/camera_formats/formats.hpp"
#include "io/image_codecs.hpp"
#include "io/text_file.hpp"
#include "textslam/map_file/tables.hpp"

namespace textslam {
namespace {

constexpr int kMostSide = 1 << 16;

CameraModel camera_of(Database& database, const Statement& row) {
  CameraModel camera;
  const std::string model = row.text(0);
  camera.width = static_cast<int>(row.integer(1, 1, kMostSide));
  camera.height = static_cast<int>(row.integer(2, 1, kMostSide));
  std::vector<double> parameters = {row.number(3), row.number(4), row.number(5), row.number(6)};
  std::string list = row.text(7);
  for (char& c : list)
    if (c == ',') c = ' ';
  for (const std::string_view number : split_blanks(list))
    parameters.push_back(require_number(number, database.path(), 0, "a coefficient of the camera"));
  const CameraType& type = camera_type(model);
  if (type.model != model || !make_camera(type, parameters, &camera.raw))
    database.refuse("damaged: it has no camera '" + shown(model) + "' of these numbers");
  camera.fps = row.number(8);
  camera.shutter = {row.number(9), row.number(10), camera.height};
  return camera;
}

void load_cameras(Database& database, MapRecord* record) {
  Statement row(database,
                "select model, width, height, fx, fy, cx, cy, coefficients, fps, readout, readout_row from cameras "
                "order by id");
  if (!row.next()) database.refuse("damaged: it has no camera");
  record->camera = camera_of(database, row);
  if (!row.next()) return;
  record->given_camera = camera_of(database, row);
  if (row.next()) database.refuse("damaged: it has more cameras than its own and the one given");
}

SE3d pose_of(Database& database, const Statement& row, int column) {
  SE3d T;
  T.t = {row.number(column), row.number(column + 1), row.number(column + 2)};
  const Eigen::Quaterniond q(row.number(column + 6), row.number(column + 3), row.number(column + 4),
                             row.number(column + 5));
  constexpr double kTolerance = 1e-6;
  if (!(std::abs(q.norm() - 1) < kTolerance)) database.refuse("damaged: the turn of a key frame is no unit quaternion");
  T.R = q.normalized().toRotationMatrix();
  return T;
}

void load_images(Database& database, const Parameters& parameters, Map* map) {
  Statement row(database, "select keyframe, format, bytes from images order by keyframe");
  while (row.next()) {
    const int id = row.index(0, map->newest_keyframe());
    const std::string name = database.path() + ", image of key frame " + std::to_string(id), format = row.text(1);
    const std::string bytes(row.bytes(2));
    if (format != "png" && format != "jpeg") throw InputError(name, 0, "of the unknown format '" + shown(format) + "'");
    const Image<std::uint8_t> image = format == "png" ? decode_png(bytes, name) : decode_jpeg(bytes, name);
    if (image.view().width() != map->width || image.view().height() != map->height)
      throw InputError(name, 0, "not of the camera's size");
    map->keyframe(id).frame.image = std::make_shared<const Pyramid>(image.view(), parameters.pyramid_levels);
  }
  for (const int id : map->keyframe_ids())
    if (!map->keyframe(id).frame.image) database.refuse("damaged: key frame " + std::to_string(id) + " has no image");
}

void load_detections(Database& database, Map* map) {
  Statement row(
      database,
      "select keyframe, word, score, x1, y1, x2, y2, x3, y3, x4, y4 from detections order by keyframe, number");
  while (row.next()) {
    Detection detection;
    detection.text = row.text(1);
    detection.score = row.number(2);
    for (int i = 0; i < 4; ++i)
      detection.quad.corner[static_cast<std::size_t>(i)] = {row.number(3 + 2 * i), row.number(4 + 2 * i)};
    map->keyframe(row.index(0, map->newest_keyframe())).frame.detections.push_back(detection);
  }
}

}  // namespace

void load_sessions(Database& database, MapRecord* record) {
  Statement row(database,
                "select id, started, sequence, command, mode, version, frames, tracked from sessions order by id");
  while (row.next())
    record->sessions.push_back({row.index(0, kMostId), row.text(1), row.text(2), row.text(3), row.text(4), row.text(5),
                                row.index(6, kMostId), row.index(7, kMostId)});
  if (record->sessions.empty()) database.refuse("damaged: it has no session");
  load_cameras(database, record);
}

void load_keyframes(Database& database, const Parameters& parameters, MapRecord* record, Map* map) {
  if (database.integer("select count(*) from keyframes where id = 0") != 1)
    database.refuse("damaged: the first key frame is missing");
  const std::int64_t most = database.integer("select max(id) from keyframes");
  if (most > kMostId) database.refuse("damaged: the id of a key frame is out of range");
  map->keyframes.resize(static_cast<std::size_t>(most) + 1);
  for (KeyFrame& keyframe : map->keyframes) keyframe.culled = true;
  Statement row(
      database,
      "select id, session, timestamp, image, noise, smoothing, x, y, z, qx, qy, qz, qw, vx, vy, vz, wx, wy, wz "
      "from keyframes order by id");
  while (row.next()) {
    const int id = row.index(0, map->newest_keyframe());
    KeyFrame& keyframe = map->keyframe(id);
    keyframe.culled = false;
    record->sources[id] = {row.index(1, kMostId), row.text(3)};
    keyframe.frame.timestamp = row.number(2);
    keyframe.frame.noise = row.number(4);
    keyframe.frame.smoothing = row.number(5);
    keyframe.T_w_c = pose_of(database, row, 6);
    if (row.is_null(13)) continue;
    Vector6 velocity;
    for (int i = 0; i < 6; ++i) velocity[i] = row.number(13 + i);
    keyframe.frame.rows = std::make_shared<const textplane::RowMotion>(textplane::RowMotion{velocity, map->shutter});
  }
  for (int id = 0; id <= map->newest_keyframe(); ++id)
    map->keyframe(id).frame.index = earlier_frame_index(id, map->keyframes.size());
  load_images(database, parameters, map);
  load_detections(database, map);
}

}  // namespace textslam
