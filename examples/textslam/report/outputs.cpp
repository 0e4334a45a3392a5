#include "textslam/report/outputs.hpp"

#include <array>
#include <cstdio>
#include <exception>
#include <vector>

#include "io/output_file.hpp"
#include "textslam/report/text_index.hpp"
#include "textslam/report/text_map.hpp"
#include "textslam/report/timing.hpp"

namespace textslam {
namespace {

// Of the poses between key frames: the upper triangle of the covariance of (v, omega), row by row.
std::string covariance_table(const System& system) {
  constexpr std::array<const char*, 6> kNames = {"vx", "vy", "vz", "wx", "wy", "wz"};
  std::string out = "timestamp,kind";
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = i; j < 6; ++j) out += std::string(",") + kNames[i] + "_" + kNames[j];
  out += '\n';
  char number[32];
  for (const FrameRecord& record : system.records()) {
    const textplane::Ldlt<double, 6> ldlt(record.information);
    if (record.state != FrameState::tracked || !ldlt.ok()) continue;
    const Matrix6 covariance = ldlt.inverse();
    std::snprintf(number, sizeof number, "%.6f", record.timestamp);
    out += std::string(number) + (record.live ? ",live" : ",filled");
    for (int i = 0; i < 6; ++i)
      for (int j = i; j < 6; ++j) {
        std::snprintf(number, sizeof number, ",%.6e", covariance(i, j));
        out += number;
      }
    out += '\n';
  }
  return out;
}

}  // namespace

void write_outputs(const std::string& folder, const System& system, const RunSummary& summary,
                   const std::function<std::string(int)>& image) {
  const auto at = [&](const char* name) { return folder + "/" + name; };
  const std::vector<std::function<void()>> writers = {
      [&] { write_tum(at("trajectory.txt"), final_trajectory(system)); },
      [&] { write_tum(at("trajectory_live.txt"), live_trajectory(system)); },
      [&] { write_tum(at("keyframes.txt"), keyframe_trajectory(system.map())); },
      [&] { write_file(at("covariances.csv"), covariance_table(system)); },
      [&] { write_file(at("text_map.json"), text_map_json(system.map())); },
      [&] { write_file(at("text_map.ply"), text_map_ply(system.map())); },
      [&] { write_file(at("text_index.json"), text_index_json(index_texts(system.map(), image))); },
      [&] { write_file(at("timing.json"), timing_json(system, summary.latency_ms)); },
      [&] { write_file(at("metrics.json"), describe(summary).file.dump(1) + "\n"); },
  };
  std::exception_ptr first;
  for (const auto& write : writers) {
    try {
      write();
    } catch (const std::exception&) {
      if (!first) first = std::current_exception();
    }
  }
  if (first) std::rethrow_exception(first);
}

}  // namespace textslam
