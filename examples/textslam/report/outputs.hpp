// The output folder: trajectories, text map, timings and metrics, each file whole or absent.
//
//   trajectory.txt       TUM, camera to world, final poses
//   trajectory_live.txt  each pose as known when its frame was processed, in a world that stays (System::live_world())
//   keyframes.txt        TUM, final poses of the key frames
//   covariances.csv      of the poses between key frames: what is known of them
//   text_map.json        the mapped texts, see text_map.hpp
//   text_map.ply         the same with points and key frames, for viewers of point clouds
//   text_index.json      the texts by their words, for textslam-map, see text_index.hpp
//   timing.json          milliseconds by stage; differs between two equal runs
//   metrics.json         counts; errors where ground truth exists
//   localisation.csv     of --localise: how each frame was found, see localisation.hpp
//   report.html          all of it to look at, see report.hpp; its block `run` differs between two equal runs
//
// If parts of a sequence were mapped separately and never joined, the outputs are those of the map with most frames,
// the frames of the others count as lost, and metrics.json lists the maps.
#ifndef TEXTSLAM_REPORT_OUTPUTS_HPP
#define TEXTSLAM_REPORT_OUTPUTS_HPP

#include <functional>
#include <string>

#include "textslam/report/summary.hpp"

namespace textslam {

/// Writes every file but the report into `folder`, which exists. If one fails, the others are written, then the first
/// error is thrown: std::runtime_error. `image`: a processed frame's file in the sequence's folder, by the frame's
/// index.
void write_outputs(const std::string& folder, const System& system, const RunSummary& summary,
                   const std::function<std::string(int)>& image);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_OUTPUTS_HPP
