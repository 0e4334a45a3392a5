// Milliseconds by stage: each stage is a line of kStages, with its name in timing.json and on the report's page.
#ifndef TEXTSLAM_REPORT_TIMING_HPP
#define TEXTSLAM_REPORT_TIMING_HPP

#include <array>
#include <string>
#include <vector>

#include "textslam/common/report_json.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

struct Stage {
  const char *in_file, *on_page;
  double FrameRecord::*ms;
  bool in_lines;   ///< In a line of --json-lines.
  bool in_frames;  ///< In timing.json by frame.
};
constexpr std::array<Stage, 7> kStages = {{
    {"detection", "detection", &FrameRecord::detect_ms, true, false},
    {"tracking", "tracking", &FrameRecord::track_ms, true, true},
    {"tracking.klt", "tracking: corners", &FrameRecord::klt_ms, false, false},
    {"tracking.pose", "tracking: pose", &FrameRecord::pose_ms, false, false},
    {"tracking.reobservation", "tracking: map points found again", &FrameRecord::reobserve_ms, false, false},
    {"mapping", "mapping", &FrameRecord::map_ms, true, true},
    {"mapping.adjustment", "mapping: adjustment", &FrameRecord::adjust_ms, false, false},
}};

/// Tracking and mapping together, of each live frame.
std::vector<double> whole_frames_ms(const System& system);

/// The text of timing.json: the median and 95th percentile of each stage over the live frames, and the frames. The
/// stage `frame` is tracking and mapping together, with the 99th percentile and the longest.
std::string timing_json(const System& system, const std::vector<double>& latency_ms);

/// For the page: by stage, the same and the milliseconds of every frame.
Json page_timing(const System& system);

/// {stage: ms} of a frame.
Json line_timing(const FrameRecord& record);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_TIMING_HPP
