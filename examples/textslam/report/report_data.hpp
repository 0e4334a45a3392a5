// What the report shows beside its pictures: the map, the trajectory, numbers by frame, all in the map's world frame
// and unit. The inverse of the alignment brings the truth there.
#ifndef TEXTSLAM_REPORT_REPORT_DATA_HPP
#define TEXTSLAM_REPORT_REPORT_DATA_HPP

#include <vector>

#include "io/evaluate_signs.hpp"
#include "textslam/common/report_json.hpp"
#include "textslam/report/summary.hpp"

namespace textslam {

constexpr std::size_t kReportPoints = 20000;  ///< Map points shown; of more, evenly spaced.

/// {"points":[x,y,z,...], "point_frames":[the frame of the key frame that saw it first, below 0 where that is none of
/// this run], "point_greys":[0 to 255, -1 where no image is left], "keyframes":[{"frame","pose"}]}.
Json map_json(const Map& map);

/// map_json() and "trajectory":[pose or null by frame], "truth":[[x,y,z] or null by frame],
/// "signs":[{"id","word","corners"}]. Truth and signs are empty if unknown.
Json world_json(const System& system, const Sequence& sequence, const RunSummary& summary,
                const std::vector<TrueSign>& signs);

/// px rms of the points that a frame saw, from T_c_w; NaN where none of them is before the camera.
double seen_error(const Map& map, const std::vector<SeenPoint>& seen, const SE3d& T_c_w);

/// By frame: {"time", "state":"w|t|f|l" (waiting, tracked, filled in afterwards, lost), "points", "texts", "error",
/// "error_live" (in units of the truth), "cost", "cost_live" (px rms of the frame's points in the final map)}.
Json series_json(const System& system, const Sequence& sequence, const RunSummary& summary);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_REPORT_DATA_HPP
