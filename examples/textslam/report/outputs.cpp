#include "textslam/report/outputs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <sstream>

#include "io/output_file.hpp"
#include "io/text_file.hpp"
#include "textplane/geometry/plane.hpp"
#include "textslam/common/report_json.hpp"
#include "textslam/common/statistics.hpp"
#include "textslam/report/text_index.hpp"

namespace textslam {
namespace {

Json to_json(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

std::string text_map_json(const Map& map) {
  Json texts = Json::array();
  for (const TextObject& text : map.texts) {
    if (text.state != TextState::mapped) continue;
    const KeyFrame& host = map.keyframe(text.host);
    Json corners = Json::array();
    for (const Vec3& corner : world_corners(map, text)) corners.push_back(to_json(corner));
    texts.push_back({{"id", text.id},
                     {"text", text.word()},
                     {"corners", corners},
                     {"normal", to_json(host.T_w_c.R * textplane::plane_normal(text.theta))},
                     {"theta", to_json(text.theta)},
                     {"host", host.frame.timestamp},
                     {"observations", text.targets.size() + 1},
                     {"zncc", text.zncc},
                     {"normal_sigma_deg", normal_sigma(text) * 180 / M_PI}});
  }
  return Json{{"texts", texts}}.dump(1) + "\n";
}

std::string text_map_ply(const Map& map) {
  std::vector<std::array<Vec3, 4>> quads;
  for (const TextObject& text : map.texts)
    if (text.state == TextState::mapped) quads.push_back(world_corners(map, text));
  const std::vector<int> keyframes = map.keyframe_ids();
  std::vector<Vec3> points;
  for (const MapPoint& point : map.points)
    if (!point.bad) points.push_back(point.p_w);

  std::ostringstream out;
  out << "ply\nformat ascii 1.0\ncomment textplane: text objects (faces, blue), points (grey), key frames (orange)\n"
      << "element vertex " << 4 * quads.size() + points.size() + keyframes.size()
      << "\nproperty float x\nproperty float y\nproperty float z\n"
      << "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      << "element face " << quads.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto vertex = [&](const Vec3& p, const char* colour) {
    char line[96];
    std::snprintf(line, sizeof line, "%.7g %.7g %.7g %s\n", p.x(), p.y(), p.z(), colour);
    out << line;
  };
  for (const auto& quad : quads)
    for (const Vec3& corner : quad) vertex(corner, "30 90 220");
  for (const Vec3& point : points) vertex(point, "150 150 150");
  for (const int id : keyframes) vertex(map.keyframe(id).T_w_c.t, "240 140 20");
  for (std::size_t i = 0; i < quads.size(); ++i)
    out << "4 " << 4 * i << ' ' << 4 * i + 1 << ' ' << 4 * i + 2 << ' ' << 4 * i + 3 << '\n';
  return out.str();
}

std::string timing_json(const System& system, const std::vector<double>& latency_ms) {
  const auto stage = [&](double FrameRecord::*member) {
    std::vector<double> values;
    for (const FrameRecord& record : system.records())
      if (record.live) values.push_back(record.*member);
    return Json{{"median", median(values)}, {"p95", percentile95(values)}};
  };
  Json stages{{"detection", stage(&FrameRecord::detect_ms)},
              {"tracking", stage(&FrameRecord::track_ms)},
              {"tracking.klt", stage(&FrameRecord::klt_ms)},
              {"tracking.pose", stage(&FrameRecord::pose_ms)},
              {"tracking.reobservation", stage(&FrameRecord::reobserve_ms)},
              {"mapping", stage(&FrameRecord::map_ms)},
              {"mapping.adjustment", stage(&FrameRecord::adjust_ms)}};
  if (!latency_ms.empty()) stages["latency"] = Json{{"median", median(latency_ms)}, {"p95", percentile95(latency_ms)}};
  Json frames = Json::array();
  for (const FrameRecord& r : system.records())
    frames.push_back({{"timestamp", r.timestamp}, {"tracking", r.track_ms}, {"mapping", r.map_ms}});
  return Json{{"unit", "ms"}, {"stages", stages}, {"frames", frames}}.dump(1) + "\n";
}

Json errors_json(const TrajectoryEvaluation& e) {
  return {{"status", textplane::to_string(e.status)},
          {"pairs", e.pairs},
          {"scale", e.alignment.scale},
          {"path_length", e.path_length},
          {"ate_rmse", e.ate.rmse},
          {"ate_median", e.ate.median},
          {"ate_p90", e.ate.p90},
          {"ate_max", e.ate.max},
          {"rpe_frame_translation_rmse", e.rpe_frame.translation.rmse},
          {"rpe_frame_rotation_rmse_deg", e.rpe_frame.rotation.rmse},
          {"rpe_distance_translation_rmse", e.rpe_distance.translation.rmse},
          {"rpe_distance_rotation_rmse_deg", e.rpe_distance.rotation.rmse}};
}

Json to_json(const Drift& drift) {
  return {{"translation_share", drift.translation}, {"rotation_deg", drift.rotation}, {"scale", drift.scale}};
}

Json loops_json(const std::vector<LoopRecord>& loops) {
  Json out = Json::array();
  for (const LoopRecord& loop : loops)
    out.push_back({{"frame", loop.frame},
                   {"met_keyframe", loop.met_frame},
                   {"text", loop.word},
                   {"spread", loop.spread},
                   {"drift", to_json(loop.found)},
                   {"left", to_json(loop.left)}});
  return out;
}

// In order of time, which that of the ids is not where maps were joined.
std::vector<StampedPose> keyframe_trajectory(const Map& map) {
  std::vector<StampedPose> poses;
  for (const int id : map.keyframe_ids()) poses.push_back({map.keyframe(id).frame.timestamp, map.keyframe(id).T_w_c});
  std::sort(poses.begin(), poses.end(),
            [](const StampedPose& a, const StampedPose& b) { return a.timestamp < b.timestamp; });
  return poses;
}

}  // namespace

std::string metrics_json(const RunSummary& s) {
  Json out{{"frames", s.frames},
           {"tracked", s.tracked},
           {"tracked_live", s.tracked_live},
           {"map_began_at_frame", s.first_tracked_live},
           {"coverage", s.frames == 0 ? 0.0 : static_cast<double>(s.tracked) / static_cast<double>(s.frames)},
           {"keyframes", s.keyframes},
           {"points", s.points},
           {"texts", s.texts},
           {"maps", s.map_frames.size()},
           {"map_frames", s.map_frames},
           {"loops", loops_json(s.loops)}};
  if (s.approximate_fov > 0) out["approximate_camera"] = {{"fov_deg", s.approximate_fov}};
  if (s.has_truth) {
    out["trajectory"] = errors_json(s.trajectory);
    out["trajectory_live"] = errors_json(s.live);
  }
  if (s.text.available) {
    Json matches = Json::array();
    for (const SignMatch& m : s.text.matches)
      matches.push_back(
          {{"text", m.text}, {"sign", m.sign}, {"angle_deg", m.angle}, {"centre", m.centre}, {"word_right", m.word}});
    out["text"] = {{"signs_visible", s.text.signs},         {"signs_mapped", s.text.mapped},
                   {"false_texts", s.text.false_texts},     {"angle_median_deg", s.text.angle.median},
                   {"angle_p90_deg", s.text.angle.p90},     {"angle_max_deg", s.text.angle.max},
                   {"centre_median", s.text.centre.median}, {"centre_p90", s.text.centre.p90},
                   {"centre_max", s.text.centre.max},       {"matches", matches}};
  }
  return out.dump(1) + "\n";
}

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
  std::vector<double> ms;
  for (std::size_t i = 0; i < system.records().size(); ++i) {
    const FrameRecord& record = system.records()[i];
    s.tracked += record.state == FrameState::tracked ? 1 : 0;
    if (!record.live) continue;
    if (s.first_tracked_live < 0) s.first_tracked_live = static_cast<int>(i);
    ++s.tracked_live;
    ms.push_back(record.track_ms + record.map_ms);
  }
  s.median_ms = median(ms);
  s.loops = system.loops();
  s.map_frames = system.map_frames();
  const Map& map = system.map();
  s.keyframes = map.keyframe_ids().size();
  for (const MapPoint& point : map.points) s.points += point.bad ? 0 : 1;
  for (const TextObject& text : map.texts) s.texts += text.state == TextState::mapped ? 1 : 0;
  s.approximate_fov = sequence.approximate_fov;
  s.has_detections = sequence.has_detections;
  s.has_truth = !sequence.groundtruth.empty();
  if (!s.has_truth) return s;
  s.trajectory = evaluate_trajectory(final_trajectory(system), sequence.groundtruth, frames);
  s.live = evaluate_trajectory(live_trajectory(system), sequence.groundtruth, frames);
  return s;
}

void write_outputs(const std::string& folder, const System& system, const RunSummary& summary,
                   const std::function<std::string(int)>& image) {
  const auto at = [&](const char* name) { return folder + "/" + name; };
  const std::vector<std::function<void()>> writers = {
      [&] { write_tum(at("trajectory.txt"), final_trajectory(system)); },
      [&] { write_tum(at("trajectory_live.txt"), live_trajectory(system)); },
      [&] { write_tum(at("keyframes.txt"), keyframe_trajectory(system.map())); },
      [&] { write_file(at("text_map.json"), text_map_json(system.map())); },
      [&] { write_file(at("text_map.ply"), text_map_ply(system.map())); },
      [&] { write_file(at("text_index.json"), text_index_json(index_texts(system.map(), image))); },
      [&] { write_file(at("timing.json"), timing_json(system, summary.latency_ms)); },
      [&] { write_file(at("metrics.json"), metrics_json(summary)); },
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

std::string format_summary(const RunSummary& s) {
  std::ostringstream out;
  char line[160];
  const auto row = [&](const char* name, const char* format, auto... values) {
    char value[120];
    std::snprintf(value, sizeof value, format, values...);
    std::snprintf(line, sizeof line, "  %-22s %s\n", name, value);
    out << line;
  };
  const double share = s.frames == 0 ? 0 : 100.0 * static_cast<double>(s.tracked) / static_cast<double>(s.frames);
  row("frames tracked", "%zu of %zu (%.1f %%)", s.tracked, s.frames, share);
  if (s.first_tracked_live >= 0) row("map began at frame", "%d", s.first_tracked_live);
  row("key frames, points", "%zu, %zu", s.keyframes, s.points);
  row("text objects", s.texts > 0 || s.has_detections ? "%zu" : "%zu: the sequence has no detections, see --detector",
      s.texts);
  if (!s.loops.empty()) {
    const auto largest = std::max_element(s.loops.begin(), s.loops.end(), [](const LoopRecord& a, const LoopRecord& b) {
      return a.found.translation < b.found.translation;
    });
    row("loops closed", "%zu, largest drift %.3f %% of the way, %.2f deg, scale %.4f", s.loops.size(),
        100 * largest->found.translation, largest->found.rotation, largest->found.scale);
  }
  if (s.has_truth && textplane::is_ok(s.trajectory.status)) {
    const double path = s.trajectory.path_length;
    row("path", "%.2f m", path);
    row("ATE (Sim(3))", "%.2f mm rmse, %.3f %% of the path", 1000 * s.trajectory.ate.rmse,
        path > 0 ? 100 * s.trajectory.ate.rmse / path : 0);
    row("ATE live", "%.2f mm rmse", 1000 * s.live.ate.rmse);
    row("RPE a frame", "%.2f mm, %.3f deg rmse", 1000 * s.trajectory.rpe_frame.translation.rmse,
        s.trajectory.rpe_frame.rotation.rmse);
  }
  if (s.text.available) {
    row("signs mapped", "%d of %d visible, %d false", s.text.mapped, s.text.signs, s.text.false_texts);
    if (s.text.mapped > 0)
      row("angle error", "%.2f deg median, %.2f deg p90, %.2f deg largest", s.text.angle.median, s.text.angle.p90,
          s.text.angle.max);
  }
  row("time", "%.1f ms a frame (median)", s.median_ms);
  if (!s.latency_ms.empty())
    row("latency", "%.1f ms (median), %.1f ms (95th percentile)", median(s.latency_ms), percentile95(s.latency_ms));
  return out.str();
}

std::vector<std::string> warnings(const RunSummary& s) {
  std::vector<std::string> out;
  if (s.approximate_fov > 0) {
    out.push_back("the camera is approximate, a pinhole of " + shortest(s.approximate_fov) +
                  " degrees without lens distortion: take angles and shapes with care");
  }
  if (s.map_frames.size() < 2) return out;
  std::string frames;
  for (const std::size_t count : s.map_frames) frames += (frames.empty() ? "" : ", ") + std::to_string(count);
  out.push_back(std::to_string(s.map_frames.size()) + " separate maps, of " + frames +
                " frames; the outputs hold the first of these");
  return out;
}

}  // namespace textslam
