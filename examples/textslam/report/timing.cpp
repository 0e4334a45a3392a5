#include "textslam/report/timing.hpp"

#include <cmath>
#include <functional>

#include "textslam/common/algorithms.hpp"

namespace textslam {
namespace {

// `ms`: a member of FrameRecord, or a function of one.
template <class Ms>
std::vector<double> of_live_frames(const System& system, Ms ms) {
  std::vector<double> values;
  for (const FrameRecord& record : system.records())
    if (record.live) values.push_back(std::invoke(ms, record));
  return values;
}

Json statistics(const std::vector<double>& ms) { return {{"median", median(ms)}, {"p95", percentile(ms, 95)}}; }

}  // namespace

std::vector<double> whole_frames_ms(const System& system) {
  return of_live_frames(system, [](const FrameRecord& record) { return record.track_ms + record.map_ms; });
}

std::string timing_json(const System& system, const std::vector<double>& latency_ms) {
  Json stages, frames = Json::array();
  for (const Stage& stage : kStages) stages[stage.in_file] = statistics(of_live_frames(system, stage.ms));
  const std::vector<double> whole = whole_frames_ms(system);
  stages["frame"] = statistics(whole);
  stages["frame"]["p99"] = percentile(whole, 99);
  stages["frame"]["longest"] = percentile(whole, 100);
  if (!latency_ms.empty()) stages["latency"] = statistics(latency_ms);
  for (const FrameRecord& record : system.records()) {
    Json frame{{"timestamp", record.timestamp}};
    for (const Stage& stage : kStages)
      if (stage.in_frames) frame[stage.in_file] = record.*stage.ms;
    frames.push_back(frame);
  }
  return Json{{"unit", "ms"}, {"stages", stages}, {"frames", frames}}.dump(1) + "\n";
}

Json page_timing(const System& system) {
  Json stages = Json::array();
  for (const Stage& stage : kStages) {
    const std::vector<double> live = of_live_frames(system, stage.ms);
    Json values = Json::array();
    for (const FrameRecord& record : system.records())
      values.push_back(short_number(std::round(100 * record.*stage.ms) / 100));
    stages.push_back({{"name", stage.on_page},
                      {"median", short_number(median(live))},
                      {"p95", short_number(percentile(live, 95))},
                      {"ms", values}});
  }
  return stages;
}

Json line_timing(const FrameRecord& record) {
  Json ms;
  for (const Stage& stage : kStages)
    if (stage.in_lines) ms[stage.in_file] = short_number(record.*stage.ms);
  return ms;
}

}  // namespace textslam
