#include "textslam/report/frame_line.hpp"

#include <cstdio>

#include "textslam/report/localisation.hpp"
#include "textslam/report/timing.hpp"

namespace textslam {

const char* to_string(FrameState state) {
  return state == FrameState::tracked ? "tracked" : state == FrameState::lost ? "lost" : "waiting";
}

std::string frame_line(int index, const FrameRecord& record, const Map& map) {
  const bool is_keyframe = record.live && map.keyframe(record.keyframe).frame.index == index;
  return Json{{"frame", index},
              {"timestamp", record.timestamp},
              {"state", to_string(record.state)},
              {"found_by", to_string(record.by)},
              {"points", record.points},
              {"texts", record.texts},
              {"keyframe", is_keyframe},
              {"map_keyframes", map.keyframe_ids().size()},
              {"pose", record.live ? short_pose(record.T_w_c_live) : Json(nullptr)},
              {"position_sigma", record.live ? Json(record.position_sigma) : Json(nullptr)},
              {"ms", line_timing(record)}}
      .dump();
}

void print_line(const std::string& line) {
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

}  // namespace textslam
