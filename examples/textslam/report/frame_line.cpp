#include "textslam/report/frame_line.hpp"

#include <algorithm>
#include <cstdio>

#include "textplane/landmarks/words.hpp"
#include "textslam/map/text_views.hpp"
#include "textslam/report/localisation.hpp"
#include "textslam/report/timing.hpp"

namespace textslam {
namespace {

Json seen_by(const Map& map, int keyframe, const Similarity& live_world) {
  Json points = Json::array(), texts = Json::array();
  for (const int id : map.keyframe(keyframe).points) {
    Json point = short_vector(live_world * map.point(id).p_w);
    point.insert(point.begin(), id);
    points.push_back(std::move(point));
  }
  for (const TextObject& text : map.texts) {
    if (text.state != TextState::mapped ||
        (text.host != keyframe && !std::binary_search(text.views.begin(), text.views.end(), keyframe)))
      continue;
    std::array<Vec3, 4> corners = world_corners(map, text);
    for (Vec3& corner : corners) corner = live_world * corner;
    texts.push_back({{"id", text.id}, {"text", textplane::consensus(text.votes)}, {"corners", short_corners(corners)}});
  }
  return {{"number", map.number}, {"points", points}, {"texts", texts}};
}

}  // namespace

const char* to_string(FrameState state) {
  return state == FrameState::tracked ? "tracked" : state == FrameState::lost ? "lost" : "waiting";
}

Json frame_json(int index, const FrameRecord& record, const Map& map) {
  const bool is_keyframe = record.live && map.keyframe(record.keyframe).frame.index == index;
  return {{"frame", index},
          {"timestamp", record.timestamp},
          {"state", to_string(record.state)},
          {"found_by", to_string(record.by)},
          {"points", record.points},
          {"texts", record.texts},
          {"keyframe", is_keyframe},
          {"map_keyframes", map.keyframe_ids().size()},
          {"pose", record.live ? short_pose(record.T_w_c_live) : Json(nullptr)},
          {"position_sigma", record.live ? Json(record.position_sigma) : Json(nullptr)},
          {"ms", line_timing(record)}};
}

std::string frame_line(int index, const FrameRecord& record, const Map& map, const Similarity& live_world) {
  Json line = frame_json(index, record, map);
  if (line["keyframe"]) line["map"] = seen_by(map, record.keyframe, live_world);
  return line.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void print_line(const std::string& line) {
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

}  // namespace textslam
