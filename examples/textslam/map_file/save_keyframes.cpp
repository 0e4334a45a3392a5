// Sessions, the camera, key frames, their images and detections.
#include "io/camera_formats/formats.hpp"
#include "io/image_file.hpp"
#include "textslam/map_file/tables.hpp"

namespace textslam {
namespace {

constexpr int kCamera = 1;  // all key frames share one
constexpr int kGivenCamera = 2;

void save_camera(Database& database, int id, const CameraModel& camera) {
  const std::vector<double> all = parameters_of(camera);
  Statement(database, "insert into cameras values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .run(id, std::string(camera.raw.name()), camera.width, camera.height, all[0], all[1], all[2], all[3],
           list_of({all.begin() + 4, all.end()}), camera.fps, camera.shutter.readout, camera.shutter.row0);
}

class KeyFrameWriter {
 public:
  explicit KeyFrameWriter(Database& database)
      : has_image_(database, "select count(*) from images where keyframe = ?"),
        image_(database, "insert into images values (?, ?, ?)"),
        detection_(database, "insert into detections values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
        still_(database, "insert into keyframes values (?,?,?,?,?,?,?,?,?,?,?,?,?,?, null,null,null,null,null,null)"),
        moving_(database, "insert into keyframes values (?,?,?,?,?,?,?,?,?,?,?,?,?,?, ?,?,?,?,?,?)") {}

  void write(int id, const KeyFrame& keyframe, const KeyFrameSource& source) {
    const Frame& frame = keyframe.frame;
    const Vec3& t = keyframe.T_w_c.t;
    const Eigen::Quaterniond q(keyframe.T_w_c.R);
    const auto run = [&](Statement& statement, const auto&... rest) {
      statement.run(id, source.session, kCamera, frame.timestamp, source.image, t.x(), t.y(), t.z(), q.x(), q.y(),
                    q.z(), q.w(), frame.noise, frame.smoothing, rest...);
    };
    if (frame.rows) {
      const Vector6& v = frame.rows->velocity;
      run(moving_, v[0], v[1], v[2], v[3], v[4], v[5]);
    } else {
      run(still_);
    }
    has_image_.bind_all(id);
    const bool known = has_image_.next() && has_image_.integer(0, 0, 1) == 1;
    has_image_.reset();
    if (!known) {
      const std::string bytes = encode_png(frame.image->level(0));
      image_.run(id, std::string("png"), std::string_view(bytes));
    }
    int number = 0;
    for (const Detection& detection : frame.detections) {
      const auto& c = detection.quad.corner;
      detection_.run(id, number++, detection.text, detection.score, c[0].x(), c[0].y(), c[1].x(), c[1].y(), c[2].x(),
                     c[2].y(), c[3].x(), c[3].y());
    }
  }

 private:
  Statement has_image_, image_, detection_, still_, moving_;
};

}  // namespace

void save_sessions(Database& database, const MapRecord& record) {
  Statement insert(database, "insert into sessions values (?, ?, ?, ?, ?, ?, ?, ?)");
  for (const SavedSession& s : record.sessions)
    insert.run(s.id, s.started, s.sequence, s.command, s.mode, s.version, s.frames, s.tracked);
}

void save_keyframes(Database& database, const Map& map, const MapRecord& record) {
  save_camera(database, kCamera, record.camera);
  if (record.given_camera) save_camera(database, kGivenCamera, *record.given_camera);
  KeyFrameWriter writer(database);
  for (const int id : map.keyframe_ids()) writer.write(id, map.keyframe(id), record.sources.at(id));
}

}  // namespace textslam
