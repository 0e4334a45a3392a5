// What the report shows beside its pictures: the map, the trajectory, numbers by frame. All in the map's world frame and unit;
// the truth is brought there by the inverse of the alignment.
#ifndef TEXTSLAM_REPORT_REPORT_DATA_HPP
#define TEXTSLAM_REPORT_REPORT_DATA_HPP

#include <vector>

#include "io/evaluate_signs.hpp"
#include "textslam/common/report_json.hpp"
#include "textslam/report/summary.hpp"

namespace textslam {

constexpr std::size_t kReportPoints = 20000;  ///< Map points shown; of more, evenly spaced.

/// {"points":[x,y,z,...], "keyframes":[{"frame","pose"}], "trajectory":[pose or null, a frame], "truth":[[x,y,z] or null, a
/// frame], "signs":[{"id","word","corners"}]}. Truth and signs are empty where they are not known.
Json world_json(const System& system, const Sequence& sequence, const RunSummary& summary,
                const std::vector<TrueSign>& signs);

/// By frame: {"time", "state":"w|t|f|l" (waiting, tracked, filled in afterwards, lost), "points", "texts", "error",
/// "error_live" (units of the truth), "cost", "cost_live" (px rms of what the frame's pose rests on, in the final map)}.
Json series_json(const System& system, const Sequence& sequence, const RunSummary& summary);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_REPORT_DATA_HPP
