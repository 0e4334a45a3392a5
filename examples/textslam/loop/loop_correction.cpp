// Loop closure, the part that changes the map.
#include <algorithm>

#include "textplane/landmarks/text_merge.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/loop/loop_alignment.hpp"
#include "textslam/loop/loop_closure.hpp"
#include "textslam/loop/pose_graph.hpp"
#include "textslam/loop/spanner.hpp"
#include "textslam/map/observations.hpp"

namespace textslam {
namespace {

// Distributes the drift over the path since the camera was at the place before.
class DriftCorrection {
 public:
  DriftCorrection(Map& map, const Parameters& parameters, const Loop& loop)
      : map_(map), parameters_(parameters), loop_(loop), unit_(median_depth(map, loop.keyframe)) {}

  // Where the key frames would be without drift; false where that is not known.
  bool solve() {
    if (!(unit_ > 0)) return false;
    for (const KeyFrame& keyframe : map_.keyframes) before_.push_back(similarity_of(keyframe.T_w_c));
    nodes_ = before_;
    add_paths();
    const LoopAlignment aligned = align_loop(map_, parameters_, loop_.link, loop_.keyframe);
    const Similarity& newest = node(before_, loop_.keyframe);
    GraphEdge edge = edge_of(loop_.met, loop_.keyframe, parameters_.loop_min_length);
    edge.S_a_b =
        compose(inverse(node(before_, loop_.met)), aligned.ok ? aligned.S_w_k : compose(loop_.link.S_a_b, newest));
    if (aligned.ok) edge.information = aligned.information;
    edges_.push_back(edge);
    return relax(nodes_, edges_, 0, parameters_);
  }

  // Of the newest key frame against the one that it met.
  Drift drift() const {
    const Similarity is = compose(inverse(node(nodes_, loop_.met)), node(nodes_, loop_.keyframe));
    const Similarity was = compose(inverse(node(before_, loop_.met)), node(before_, loop_.keyframe));
    return {(is.t - was.t).norm() / path_length_between(map_, loop_.met, loop_.keyframe),
            degrees(is.R.transpose() * was.R), is.scale};
  }

  // Moves the map: points with their host, planes with theirs. Returns the scales of the key frames.
  std::vector<double> apply() {
    for (MapPoint& point : map_.points) {
      if (point.bad) continue;
      const int host = point.observations.front().keyframe;
      point.p_w = node(nodes_, host) * (inverse(node(before_, host)) * point.p_w);
      point.normal_w = node(nodes_, host).R * (node(before_, host).R.transpose() * point.normal_w);
    }
    for (TextObject& text : map_.texts) {
      const double s = node(nodes_, text.host).scale;
      text.theta /= s;
      text.covariance /= s * s;
    }
    std::vector<double> scales;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      map_.keyframes[i].T_w_c = SE3d{nodes_[i].R, nodes_[i].t};
      scales.push_back(nodes_[i].scale);
    }
    return scales;
  }

 private:
  static const Similarity& node(const std::vector<Similarity>& nodes, int id) {
    return nodes[static_cast<std::size_t>(id)];
  }

  // As the map has it, with the drift of a path of this length, in depths.
  GraphEdge edge_of(int a, int b, double length) const {
    GraphEdge edge;
    edge.a = a;
    edge.b = b;
    edge.S_a_b = compose(inverse(node(before_, a)), node(before_, b));
    edge.information *= 1 / (parameters_.loop_drift * parameters_.loop_drift * length);
    edge.information.topLeftCorner<3, 3>() /= unit_ * unit_;
    return edge;
  }

  // The shortest ways between key frames that share points, and between neighbours in time, which connect the graph
  // where nothing else does. Culled key frames hang on it by one edge.
  void add_paths() {
    std::vector<PathEdge> paths;
    const auto add = [&](int a, int b) {
      const Similarity S_a_b = compose(inverse(node(before_, a)), node(before_, b));
      const double turn = textplane::so3_log<double>(S_a_b.R).norm();
      paths.push_back({a, b, parameters_.loop_min_length + S_a_b.t.norm() / unit_ + turn});
    };
    std::vector<int> order;
    for (int b = 0; b < static_cast<int>(nodes_.size()); ++b) {
      order.push_back(b);
      const std::vector<int> shared = shared_points(map_, map_.keyframe(b).points);
      for (int a = 0; a < b; ++a)
        if (shared[static_cast<std::size_t>(a)] >= parameters_.local_min_shared) add(a, b);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return map_.keyframe(a).frame.index < map_.keyframe(b).frame.index; });
    int before = order.front();
    for (std::size_t i = 1; i < order.size(); ++i) {
      add(before, order[i]);
      if (!map_.keyframe(order[i]).culled) before = order[i];
    }
    for (const PathEdge& path :
         greedy_spanner(static_cast<int>(nodes_.size()), std::move(paths), parameters_.loop_stretch))
      edges_.push_back(edge_of(path.a, path.b, path.length));
  }

  Map& map_;
  const Parameters& parameters_;
  const Loop& loop_;
  double unit_;
  std::vector<Similarity> before_, nodes_;
  std::vector<GraphEdge> edges_;
};

bool observes(const Map& map, int point, int keyframe) {
  return observed_in(map.point(point).observations, keyframe) != nullptr;
}

void merge_points(Map& map, int kept, int other) {
  MapPoint& from = map.point(other);
  map.point(kept).visible += from.visible;
  map.point(kept).found += from.found;
  from.bad = true;
  for (const PointObservation& o : std::exchange(from.observations, {})) {
    erase(map.keyframe(o.keyframe).points, other);
    if (!observes(map, kept, o.keyframe)) add_observation(map, kept, o.keyframe, o.px);
  }
}

// Largest distance, px, between two points in the key frames that show both.
double distance_seen(const Map& map, const Loop& loop, int old_point, int recent_point) {
  double largest = 0;
  for (const LinkSighting& sighting : loop.link.sightings)
    for (const Track& track : sighting.tracks)
      for (const PointObservation& o : map.point(recent_point).observations)
        if (track.point == old_point && o.keyframe == sighting.keyframe)
          largest = std::max(largest, (o.px - track.px.cast<double>()).norm());
  return largest;
}

// Median distance, px, between where the map expects the old points in the newest key frame and where they are.
double shift_seen(const Map& map, const Loop& loop) {
  const SE3d T_c_w = map.keyframe(loop.keyframe).T_w_c.inverse();
  std::vector<double> shifts;
  for (const Track& track : loop.seen.tracks) {
    if (track.point < 0 || !track.inlier) continue;
    const Vec3 p = T_c_w * map.point(track.point).p_w;
    shifts.push_back(map.camera.in_domain(p) ? (map.camera.project(p) - track.px.cast<double>()).norm() : map.width);
  }
  return median(std::move(shifts));
}

}  // namespace

LoopCorrection close_loop(Map& map, const Parameters& parameters, const Loop& loop) {
  LoopCorrection out;
  for (std::size_t i = 0; i < map.points.size(); ++i) out.points.push_back(static_cast<int>(i));
  out.scales.assign(map.keyframes.size(), 1);
  DriftCorrection correction(map, parameters, loop);
  if (correction.solve()) {
    out.found = correction.drift();
    out.corrected = shift_seen(map, loop) > parameters.loop_max_shift;
    if (out.corrected) out.scales = correction.apply();
  }

  for (const auto& [kept, other] : loop.link.points) {
    if (map.point(kept).bad || map.point(other).bad ||
        distance_seen(map, loop, kept, other) > parameters.loop_same_point)
      continue;
    merge_points(map, kept, other);
    out.points[static_cast<std::size_t>(other)] = kept;
  }
  for (const auto& [a, b] : loop.link.texts) merge_texts(parameters.text, map.text(a), map.text(b));
  for (const LinkSighting& sighting : loop.link.sightings)
    for (const Track& track : sighting.tracks)
      if (!map.point(track.point).bad && !observes(map, track.point, sighting.keyframe))
        add_observation(map, track.point, sighting.keyframe, track.px.cast<double>());
  return out;
}

}  // namespace textslam
