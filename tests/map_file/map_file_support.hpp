// A small map made by formula, its record, and a file for it.
#ifndef TESTS_MAP_FILE_MAP_FILE_SUPPORT_HPP
#define TESTS_MAP_FILE_MAP_FILE_SUPPORT_HPP

#include "io/input_error.hpp"
#include "io/io_support.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/map_file/map_file.hpp"
#include "textslam/relocalise/boards_support.hpp"

namespace textslam {
namespace map_file_support {

using namespace boards_support;

// Three texts, four points, and three key frames, of which the middle one is culled.
class MapFileTest : public TextRecoveryTest {
 protected:
  MapFileTest() {
    const SE3d beside = moved({0.2, 0, 0}, {0, 0.05, 0});
    map.keyframes.push_back({});
    map.keyframes.back().culled = true;
    map.keyframes.push_back({frame_at(beside), beside.inverse(), {}});
    for (const int id : map.keyframe_ids()) {
      Frame& frame = map.keyframe(id).frame;
      frame.index = 10 * id;
      frame.timestamp = 0.1 + id;
      frame.noise = 1.5;
      frame.smoothing = 0.25;
      frame.detections = {detection(0, map.keyframe(id).T_w_c.inverse(), "EXIT, \"A\"")};
    }
    for (int i = 0; i < 5; ++i) {
      map.points.push_back({{0.1 * i - 0.2, 0.3, 3 + 1.0 / 3 * i}});
      map.points.back().visible = 7;
      map.points.back().found = 5;
      map.points.back().normal_w = {0, 0, i == 1 ? 1.0 : 0.0};
      for (const int id : map.keyframe_ids()) add_observation(map, i, id, {100.25 + i, 50 + id / 3.0});
    }
    drop_point(map, 3);
    for (TextObject& text : map.texts) {
      text.views = {2};
      text.votes["ExIT"] = 0.7;
      text.covariance << 4, 1, 2, 1, 5, 3, 2, 3, 6;
      text.covariance *= 1e-6;
      text.zncc = 0.93;
      text.detections = 4;
      text.shown = 6;
      text.variance_factor = 2.5;
    }
    record.camera.raw = map.camera.pinhole;
    record.camera.width = map.width;
    record.camera.height = map.height;
    record.camera.fps = 30;
    record.camera.shutter = all_at_once(map.height);
    record.sessions = {{1, "2026-01-31 12:00:00", "rooms/first", "textslam rooms/first", "text", "0.1.0", 120, 118}};
    for (const int id : map.keyframe_ids()) record.sources[id] = {1, "images/" + std::to_string(id) + ".png"};
    map.shutter = record.camera.shutter;
    file = folder.path("map.db");
  }

  void save() const { save_map(file, map, record); }
  LoadedMap load() const { return load_map(file, parameters); }
  // The message of the refusal; empty where there is none.
  std::string refusal() const {
    try {
      load();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder;
  MapRecord record;
  std::string file;
};

}  // namespace map_file_support
}  // namespace textslam

#endif  // TESTS_MAP_FILE_MAP_FILE_SUPPORT_HPP
