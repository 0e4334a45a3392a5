// A run as lines of JSON, for programs: one a frame as it is processed, then one of the whole.
#ifndef TEXTSLAM_REPORT_FRAME_LINE_HPP
#define TEXTSLAM_REPORT_FRAME_LINE_HPP

#include <string>

#include "textslam/report/summary.hpp"

namespace textslam {

const char* to_string(FrameState state);

/// {"frame", "timestamp", "state", "found_by", "points", "texts", "keyframe", "map_keyframes", "pose",
/// "position_sigma", "ms"}: `pose`: [x, y, z, qx, qy, qz, qw], camera to world, as known live, or
/// null; `keyframe`: whether it became one; `map_keyframes`: how many the map holds; `ms`: time of detection, tracking
/// and mapping. Poses that change later are in the output files.
Json frame_json(int index, const FrameRecord& record, const Map& map);

/// That as a line, without its end. A key frame has `map` too, what it sees of the map in the same world: {"number",
/// "points": [[id, x, y, z], ...], "texts": [{"id", "text", "corners"}, ...]}. What comes again under its id is where
/// it is known to be by then; ids are those of the map of this number. `live_world`: of the system.
std::string frame_line(int index, const FrameRecord& record, const Map& map, const Similarity& live_world);

/// Writes the line to standard output at once.
void print_line(const std::string& line);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_FRAME_LINE_HPP
