#include "textslam/report/report_data.hpp"

#include <algorithm>
#include <cmath>

#include "textslam/common/algorithms.hpp"
#include "textslam/report/report_frames.hpp"

namespace textslam {
namespace {

// The true position of each frame, as far as it is known.
std::vector<const StampedPose*> truth_of_frames(const System& system, const Sequence& sequence) {
  std::vector<StampedPose> frames;
  for (const FrameRecord& record : system.records()) frames.push_back({record.timestamp, {}});
  std::vector<const StampedPose*> truth(frames.size(), nullptr);
  for (const PosePair& pair : associate(frames, sequence.groundtruth, EvaluationOptions{}.tolerance))
    truth[pair.estimate] = &sequence.groundtruth[pair.truth];
  return truth;
}

// The grey value of the point where the first key frame with an image saw it, -1 where none has.
int grey_of(const Map& map, const MapPoint& point) {
  for (const PointObservation& seen : point.observations) {
    const std::shared_ptr<const Pyramid>& image = map.keyframe(seen.keyframe).frame.image;
    if (!image) continue;
    const ImageView8& pixels = image->level(0);
    const int x = std::clamp(static_cast<int>(std::lround(seen.px.x())), 0, pixels.width() - 1);
    const int y = std::clamp(static_cast<int>(std::lround(seen.px.y())), 0, pixels.height() - 1);
    return pixels(x, y);
  }
  return -1;
}

}  // namespace

double seen_error(const Map& map, const std::vector<SeenPoint>& seen, const SE3d& T_c_w) {
  double sum = 0;
  int count = 0;
  for (const SeenPoint& s : seen) {
    const Vec3 p = T_c_w * map.point(s.point).p_w;
    if (map.point(s.point).bad || !map.camera.in_domain(p)) continue;
    sum += (map.camera.project(p) - s.px.cast<double>()).squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : std::nan("");
}

Json map_json(const Map& map) {
  Json points = Json::array(), frames = Json::array(), greys = Json::array(), keyframes = Json::array();
  std::vector<int> good;
  for (std::size_t i = 0; i < map.points.size(); ++i)
    if (!map.points[i].bad) good.push_back(static_cast<int>(i));
  for (const int id : evenly_spaced(good, kReportPoints)) {
    const MapPoint& point = map.point(id);
    for (const double value : point.p_w) points.push_back(short_number(value));
    frames.push_back(point.observations.empty() ? -1 : map.keyframe(point.observations.front().keyframe).frame.index);
    greys.push_back(grey_of(map, point));
  }
  for (const int id : map.keyframe_ids())
    keyframes.push_back({{"frame", map.keyframe(id).frame.index}, {"pose", short_pose(map.keyframe(id).T_w_c)}});
  return {{"points", points}, {"point_frames", frames}, {"point_greys", greys}, {"keyframes", keyframes}};
}

Json world_json(const System& system, const Sequence& sequence, const RunSummary& summary,
                const std::vector<TrueSign>& signs) {
  Json trajectory = Json::array(), truth = Json::array(), true_signs = Json::array();
  for (const FrameRecord& record : system.records())
    trajectory.push_back(record.state == FrameState::tracked ? short_pose(system.final_pose(record)) : Json(nullptr));
  if (is_aligned(summary)) {
    const Similarity to_map = inverse(summary.trajectory.alignment);
    for (const StampedPose* pose : truth_of_frames(system, sequence))
      truth.push_back(pose ? short_vector(to_map * pose->T_w_c.t) : Json(nullptr));
    for (const TrueSign& sign : signs) {
      std::array<Vec3, 4> corners;
      for (std::size_t i = 0; i < 4; ++i) corners[i] = to_map * sign.corners[i];
      true_signs.push_back({{"id", sign.id}, {"word", sign.word}, {"corners", short_corners(corners)}});
    }
  }
  Json world = map_json(system.map());
  world.update({{"trajectory", trajectory}, {"truth", truth}, {"signs", true_signs}});
  return world;
}

Json series_json(const System& system, const Sequence& sequence, const RunSummary& summary) {
  Json times = Json::array(), points = Json::array(), texts = Json::array(), errors = Json::array(),
       live_errors = Json::array(), costs = Json::array(), live_costs = Json::array();
  std::string states;
  const Similarity map_world = inverse(system.live_world());
  const bool aligned = is_aligned(summary);
  const bool live_aligned = aligned && textplane::is_ok(summary.live.status);
  const auto truth = truth_of_frames(system, sequence);
  const auto error = [](const Similarity& alignment, const Vec3& position, const StampedPose& pose) {
    return short_number((alignment * position - pose.T_w_c.t).norm());
  };
  for (std::size_t i = 0; i < system.records().size(); ++i) {
    const FrameRecord& record = system.records()[i];
    const bool tracked = record.state == FrameState::tracked;
    times.push_back(short_number(record.timestamp - system.records().front().timestamp));
    states += tracked ? (record.live ? 't' : 'f') : record.state == FrameState::lost ? 'l' : 'w';
    points.push_back(tracked ? record.points : 0);
    texts.push_back(tracked ? record.texts : 0);
    const std::vector<SeenPoint> seen = points_of(system, i);
    const bool known = truth[i] != nullptr;
    const SE3d T_w_c = tracked ? system.final_pose(record) : SE3d{};
    errors.push_back(aligned && tracked && known ? error(summary.trajectory.alignment, T_w_c.t, *truth[i]) : Json());
    live_errors.push_back(
        live_aligned && record.live && known ? error(summary.live.alignment, record.T_w_c_live.t, *truth[i]) : Json());
    costs.push_back(tracked ? short_number(seen_error(system.map(), seen, T_w_c.inverse())) : Json());
    const SE3d T_w_c_live = map_world * record.T_w_c_live;
    live_costs.push_back(record.live ? short_number(seen_error(system.map(), seen, T_w_c_live.inverse())) : Json());
  }
  return {{"time", times},   {"state", states},           {"points", points}, {"texts", texts},
          {"error", errors}, {"error_live", live_errors}, {"cost", costs},    {"cost_live", live_costs}};
}

}  // namespace textslam
