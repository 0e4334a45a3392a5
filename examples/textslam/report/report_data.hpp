// What the report shows beside its pictures: the map, the trajectory, numbers by frame. All in the map's world frame and unit;
// the truth is brought there by the inverse of the alignment.
#ifndef TEXTSLAM_REPORT_REPORT_DATA_HPP
#define TEXTSLAM_REPORT_REPORT_DATA_HPP

#include <vector>

#include "io/evaluate_signs.hpp"
#include "textslam/common/report_json.hpp"
#include "textslam/report/outputs.hpp"

namespace textslam {

constexpr std::size_t kReportPoints = 20000;  ///< Map points shown; of more, evenly spread.

/// [{"id", "word", "corners", "centre", "normal", "sigma_deg", "observations", "zncc", "host", "image", "sign", "angle_deg",
/// "centre_error", "word_right"}]: sign and what follows only where the truth is known; sign -1: none stands there; `host`: a
/// frame; `image` null once the pictures are beyond their bound.
Json texts_json(const System& system, const RunSummary& summary);

/// {"points":[x,y,z,...], "keyframes":[{"frame","pose"}], "trajectory":[pose or null, a frame], "truth":[[x,y,z] or null, a
/// frame], "signs":[{"id","word","corners"}]}. Truth and signs are empty where they are not known.
Json world_json(const System& system, const Sequence& sequence, const RunSummary& summary,
                const std::vector<TrueSign>& signs);

/// By frame: {"time", "state":"w|t|f|l" (waiting, tracked, filled in afterwards, lost), "points", "texts", "error",
/// "error_live" (units of the truth), "cost", "cost_live" (px rms of what the frame's pose rests on, in the final map)}.
Json series_json(const System& system, const Sequence& sequence, const RunSummary& summary);

/// Milliseconds by frame and stage, and the median and 95th percentile of each.
Json report_timing_json(const System& system);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_REPORT_DATA_HPP
