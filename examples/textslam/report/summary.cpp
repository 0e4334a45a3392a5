#include "textslam/report/summary.hpp"

#include <algorithm>

#include "io/text_file.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/report/calibration.hpp"
#include "textslam/report/timing.hpp"

namespace textslam {
namespace {

void add_loops(Fields& fields, const std::vector<LoopRecord>& loops) {
  const auto drift = [](const Drift& d) {
    return Json{{"translation_share", d.translation}, {"rotation_deg", d.rotation}, {"scale", d.scale}};
  };
  Json list = Json::array();
  for (const LoopRecord& loop : loops)
    list.push_back({{"frame", loop.frame},
                    {"met_keyframe", loop.met_frame},
                    {"text", loop.word},
                    {"spread", loop.corrected},
                    {"drift", drift(loop.found)},
                    {"left", drift(loop.left)}});
  fields.add("loops", nullptr, list);
  if (loops.empty()) return;
  const auto largest = std::max_element(loops.begin(), loops.end(), [](const LoopRecord& a, const LoopRecord& b) {
    return a.found.translation < b.found.translation;
  });
  fields.row("loops closed", "%zu, largest drift %.3f %% of the way, %.2f deg, scale %.4f", loops.size(),
             100 * largest->found.translation, largest->found.rotation, largest->found.scale);
}

// Texts, and where there are none, whose doing that is.
void add_texts(Fields& fields, const RunSummary& s) {
  fields.add("texts", "texts", s.texts);
  if (s.texts > 0 || s.detector.empty())
    fields.row("text objects", "%zu", s.texts);
  else if (s.detected > 0)
    fields.row("text objects", "0, of %zu detected boxes", s.detected);
  else if (s.detector != "files")
    fields.row("text objects", "0: the detector %s found no text", s.detector.c_str());
  else
    fields.row("text objects", "%s",
               s.has_detections ? "0: the sequence's detections hold none"
                                : "0: the sequence has no detections, see --detector");
}

void add_counts(Fields& fields, const RunSummary& s) {
  const double frames = s.frames == 0 ? 1 : static_cast<double>(s.frames), tracked = static_cast<double>(s.tracked);
  fields.add("frames", "frames", s.frames);
  fields.add("tracked", "tracked", s.tracked);
  fields.add("tracked_live", "tracked_live", s.tracked_live);
  fields.add("broken", nullptr, s.broken);
  fields.row("frames tracked", "%zu of %zu (%.1f %%)", s.tracked, s.frames, 100 * tracked / frames);
  fields.add("map_began_at_frame", nullptr, s.first_tracked_live);
  if (s.first_tracked_live >= 0) fields.row("map began at frame", "%d", s.first_tracked_live);
  fields.add("coverage", nullptr, tracked / frames);
  fields.add("keyframes", "keyframes", s.keyframes);
  fields.add("points", "points", s.points);
  fields.row("key frames, points", "%zu, %zu", s.keyframes, s.points);
  if (s.points > 0) {
    fields.add("reprojection_px", "reprojection_px", s.reprojection_px);
    fields.row("reprojection error", "%.4f px rms", s.reprojection_px);
  }
  add_texts(fields, s);
  fields.add(nullptr, "loops", s.loops.size());
  fields.add("maps", nullptr, s.map_frames.size());
  fields.add("map_frames", "map_frames", s.map_frames);
  add_loops(fields, s.loops);
  if (s.metric) {
    fields.add("metric", "metric", Json{{"sigma_share", s.metric->sigma}, {"texts", s.metric->texts}});
    fields.row("scale", "metres to %.2f %%, by %d %s", 100 * s.metric->sigma, s.metric->texts,
               s.metric->texts == 1 ? "text" : "texts");
  }
  if (s.readout != 0) {
    fields.add("readout_s", "readout_s", s.readout);
    fields.add("readout_estimated", "readout_estimated", s.readout_estimated);
    fields.row("readout of the rows", "%.1f ms%s", 1000 * s.readout, s.readout_estimated ? ", estimated" : "");
  }
  if (s.approximate_fov > 0) fields.add("approximate_camera", nullptr, Json{{"fov_deg", s.approximate_fov}});
  if (s.calibration) add_calibration(fields, *s.calibration, s.true_camera);
}

// The errors of a trajectory; the page has those of the final one, and the live one's ATE.
Fields errors(const TrajectoryEvaluation& e, const TrajectoryEvaluation& live) {
  Fields fields;
  fields.add("status", nullptr, textplane::to_string(e.status));
  fields.add("pairs", nullptr, e.pairs);
  fields.add("scale", "scale", e.alignment.scale);
  fields.add("path_length", "path_length", e.path_length);
  fields.row("path", "%.2f m", e.path_length);
  fields.add("ate_rmse", "ate_rmse", e.ate.rmse);
  fields.row("ATE (Sim(3))", "%.2f mm rmse, %.3f %% of the path", 1000 * e.ate.rmse,
             e.path_length > 0 ? 100 * e.ate.rmse / e.path_length : 0);
  fields.add(nullptr, "ate_live_rmse", live.ate.rmse);
  fields.row("ATE live", "%.2f mm rmse", 1000 * live.ate.rmse);
  fields.add("ate_median", nullptr, e.ate.median);
  fields.add("ate_p90", nullptr, e.ate.p90);
  fields.add("ate_max", nullptr, e.ate.max);
  fields.add("rpe_frame_translation_rmse", nullptr, e.rpe_frame.translation.rmse);
  fields.add("rpe_frame_rotation_rmse_deg", "rpe_rotation_deg", e.rpe_frame.rotation.rmse);
  fields.row("RPE a frame", "%.2f mm, %.3f deg rmse", 1000 * e.rpe_frame.translation.rmse, e.rpe_frame.rotation.rmse);
  fields.add("rpe_distance_translation_rmse", nullptr, e.rpe_distance.translation.rmse);
  fields.add("rpe_distance_rotation_rmse_deg", nullptr, e.rpe_distance.rotation.rmse);
  return fields;
}

Json stated(const PoseErrors& e) {
  return {{"poses", e.poses},
          {"ate_rmse", e.ate_rmse},
          {"relative_rmse", e.relative_rmse},
          {"over_sigma_median", e.over_sigma.median},
          {"over_sigma_p90", e.over_sigma.p90},
          {"relative_over_sigma_median", e.relative_over_sigma.median},
          {"relative_over_sigma_p90", e.relative_over_sigma.p90}};
}

void add_trajectories(Fields& fields, const RunSummary& s) {
  if (!s.has_truth) return;
  const Fields of_final = errors(s.trajectory, s.live);
  fields.add("trajectory", nullptr, of_final.file);
  fields.add("trajectory_live", nullptr, errors(s.live, s.live).file);
  if (!is_aligned(s)) return;
  fields.page.update(of_final.page);
  fields.table += of_final.table;
  fields.add("final_live", nullptr, stated(s.final_live));
  fields.add("filled_in", nullptr, stated(s.filled_in));
  if (s.filled_in.poses > 0)
    fields.row("ATE filled in", "%.2f mm rmse, %zu poses", 1000 * s.filled_in.ate_rmse, s.filled_in.poses);
}

void add_signs(Fields& fields, const TextEvaluation& text) {
  if (!text.available) return;
  Fields signs;
  signs.add("signs_visible", "signs_visible", text.signs);
  signs.add("signs_mapped", "signs_mapped", text.mapped);
  signs.add("signs_clear", nullptr, text.clear);
  signs.add("signs_clear_mapped", nullptr, text.clear_mapped);
  signs.add("false_texts", "false_texts", text.false_texts);
  fields.row("signs mapped", "%d of %d visible, %d false", text.mapped, text.signs, text.false_texts);
  signs.add("angle_median_deg", "angle_median_deg", text.angle.median);
  signs.add("angle_p90_deg", nullptr, text.angle.p90);
  signs.add("angle_max_deg", nullptr, text.angle.max);
  signs.add("angle_over_sigma_median", nullptr, text.angle_over_sigma.median);
  signs.add("angle_over_sigma_p90", nullptr, text.angle_over_sigma.p90);
  if (text.mapped > 0)
    fields.row("angle error", "%.2f deg median, %.2f deg p90, %.2f deg largest", text.angle.median, text.angle.p90,
               text.angle.max);
  signs.add("centre_median", nullptr, text.centre.median);
  signs.add("centre_p90", nullptr, text.centre.p90);
  signs.add("centre_max", nullptr, text.centre.max);
  Json matches = Json::array();
  for (const SignMatch& m : text.matches)
    matches.push_back({{"text", m.text},
                       {"sign", m.sign},
                       {"angle_deg", m.angle},
                       {"sigma_deg", m.sigma},
                       {"centre", m.centre},
                       {"word_right", m.word}});
  signs.add("matches", nullptr, matches);
  fields.add("text", nullptr, signs.file);
  fields.page.update(signs.page);
}

}  // namespace

bool is_aligned(const RunSummary& summary) { return summary.has_truth && textplane::is_ok(summary.trajectory.status); }

std::vector<StampedPose> final_trajectory(const System& system) {
  std::vector<StampedPose> poses;
  for (const FrameRecord& record : system.records())
    if (record.state == FrameState::tracked) poses.push_back({record.timestamp, system.final_pose(record)});
  return poses;
}

std::vector<StampedPose> live_trajectory(const System& system) {
  std::vector<StampedPose> poses;
  for (const FrameRecord& record : system.records())
    if (record.live) poses.push_back({record.timestamp, record.T_w_c_live});
  return poses;
}

RunSummary summarise(const System& system, const Sequence& sequence, std::size_t frames) {
  RunSummary s;
  s.frames = frames;
  std::vector<double> detect_ms;
  for (std::size_t i = 0; i < system.records().size(); ++i) {
    const FrameRecord& record = system.records()[i];
    s.tracked += record.state == FrameState::tracked ? 1 : 0;
    if (record.detect_ms > 0) detect_ms.push_back(record.detect_ms);
    if (!record.live) continue;
    if (s.first_tracked_live < 0) s.first_tracked_live = static_cast<int>(i);
    ++s.tracked_live;
  }
  const std::vector<double> ms = whole_frames_ms(system);
  s.median_ms = median(ms);
  s.p99_ms = percentile(ms, 99);
  s.longest_ms = percentile(ms, 100);
  s.median_detect_ms = median(detect_ms);
  s.loops = system.loops();
  s.map_frames = system.map_frames();
  const Map& map = system.map();
  s.keyframes = map.keyframe_ids().size();
  for (const MapPoint& point : map.points) s.points += point.bad ? 0 : 1;
  for (const TextObject& text : map.texts) s.texts += text.state == TextState::mapped ? 1 : 0;
  s.reprojection_px = reprojection_error(map);
  s.notes = sequence.notes;
  s.approximate_fov = sequence.approximate_fov;
  s.readout = system.map().shutter.readout;
  s.readout_estimated = system.estimates_readout();
  s.true_camera = sequence.true_camera;
  s.has_detections = sequence.has_detections;
  s.has_truth = !sequence.groundtruth.empty();
  if (!s.has_truth) return s;
  s.trajectory = evaluate_trajectory(final_trajectory(system), sequence.groundtruth, frames);
  s.live = evaluate_trajectory(live_trajectory(system), sequence.groundtruth, frames);
  if (!is_aligned(s)) return s;
  const std::vector<StampedPose> at_keyframes = keyframe_trajectory(map);
  for (const bool live : {true, false})
    (live ? s.final_live : s.filled_in) =
        compare_poses(stated_poses(system, live), at_keyframes, sequence.groundtruth, s.trajectory.alignment);
  return s;
}

Fields describe(const RunSummary& s) {
  Fields fields;
  add_counts(fields, s);
  add_trajectories(fields, s);
  add_signs(fields, s.text);
  if (s.median_detect_ms > 0)
    fields.row("time", "%.1f ms a frame, detection %.1f ms (medians)", s.median_ms, s.median_detect_ms);
  else
    fields.row("time", "%.1f ms a frame (median)", s.median_ms);
  fields.row("longest frames", "%.1f ms (99th percentile), %.1f ms", s.p99_ms, s.longest_ms);
  if (!s.latency_ms.empty())
    fields.row("latency", "%.1f ms (median), %.1f ms (95th percentile)", median(s.latency_ms),
               percentile(s.latency_ms, 95));
  return fields;
}

std::vector<std::string> warnings(const RunSummary& s) {
  std::vector<std::string> out = s.notes;
  if (s.broken > 0)
    out.push_back(std::to_string(s.broken) + " of " + std::to_string(s.frames) +
                  " frames cannot be read and were passed over");
  if (s.approximate_fov > 0)
    out.push_back("the camera is approximate, a pinhole of " + shortest(s.approximate_fov) +
                  " degrees without lens distortion: take angles and shapes with care");
  if (s.calibration && !s.calibration->determined)
    out.push_back(
        "the images do not tell the camera, for which it has to move and turn; it stays what it began with: " +
        s.calibration->origin);
  if (s.map_frames.size() < 2) return out;
  std::string frames;
  for (const std::size_t count : s.map_frames) frames += (frames.empty() ? "" : ", ") + std::to_string(count);
  out.push_back(std::to_string(s.map_frames.size()) + " separate maps, of " + frames +
                " frames; the outputs hold the first of these");
  return out;
}

}  // namespace textslam
