#include "textslam/loop/map_join.hpp"

#include <algorithm>

#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/landmarks/text_merge.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/map/text_views.hpp"

namespace textslam {
namespace {

// The same place in both maps, seen from a key frame.
struct Pair {
  Vec3 in_a, in_b;
  double depth = 0;  // in a, from the key frame
  int keyframe = -1;
  int point_a = -1, point_b = -1;  // -1: a corner of a text
};

class Linker {
 public:
  Linker(const Map& a, const Map& b, const Parameters& parameters) : a_(a), b_(b), parameters_(parameters) {}

  // Key frame `id` of b was recognised in a.
  void add(int id, const Relocalisation& seen) {
    const KeyFrame& keyframe = b_.keyframe(id);
    sightings_.push_back({id, seen.T_c_w.inverse(), {}});
    const std::vector<Track> in_b = tracks_of_keyframe(b_, id);
    for (const Track& track : seen.tracks) {
      if (track.point < 0 || !track.inlier) continue;
      sightings_.back().tracks.push_back(track);
      const auto nearest = std::min_element(in_b.begin(), in_b.end(), [&](const Track& p, const Track& q) {
        return (p.px - track.px).squaredNorm() < (q.px - track.px).squaredNorm();
      });
      if (nearest == in_b.end() || (nearest->px - track.px).norm() > parameters_.join_same_pixel) continue;
      const Vec3& in_a = a_.point(track.point).p_w;
      add_pair({in_a, b_.point(nearest->point).p_w, (seen.T_c_w * in_a).z(), id, track.point, nearest->point});
    }
    for (const TextObject& of_a : a_.texts)
      for (const TextObject& of_b : b_.texts) add_text(of_a, seen.T_c_w, of_b, keyframe.T_w_c.inverse(), id);
  }

  // Of the pairs of one key frame, whose pose is known in both maps.
  Similarity from_keyframe(int id, const SE3d& T_c_a) const {
    const SE3d &T_b_c = b_.keyframe(id).T_w_c, T_c_b = T_b_c.inverse();
    std::vector<double> ratios;
    for (const Pair& pair : pairs_) {
      const double depth = (T_c_b * pair.in_b).z();
      if (depth > 0 && pair.keyframe == id) ratios.push_back(pair.depth / depth);
    }
    const double scale = median(std::move(ratios));
    const Eigen::Matrix3d R = T_c_a.R.transpose() * T_b_c.R.transpose();
    return {scale, R, T_c_a.inverse().t - scale * (R * T_b_c.t)};
  }

  // The similarity that most pairs agree with.
  void solve(MapLink* link) {
    double limit = parameters_.join_first_tolerance * parameters_.join_tolerance;
    std::vector<char> agrees(pairs_.size(), 1);
    std::size_t count = pairs_.size();
    for (int round = 0; round < parameters_.join_rounds; ++round) {
      std::vector<Vec3> from, to;
      for (std::size_t i = 0; i < pairs_.size(); ++i) {
        if (!agrees[i]) continue;
        from.push_back(pairs_[i].in_b);
        to.push_back(pairs_[i].in_a);
      }
      if (!textplane::is_ok(align_points(from, to, true, &link->S_a_b))) return;
      count = 0;
      for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const Vec3 error = link->S_a_b * pairs_[i].in_b - pairs_[i].in_a;
        agrees[i] = error.norm() <= limit * pairs_[i].depth ? 1 : 0;
        count += agrees[i] ? 1U : 0U;
      }
      limit = std::max(parameters_.join_tolerance, parameters_.join_narrowing * limit);
    }
    for (const Sighting& sighting : sightings_) {
      const SE3d expected = link->S_a_b * b_.keyframe(sighting.keyframe).T_w_c;
      const double depth = link->S_a_b.scale * median_depth(b_, sighting.keyframe);
      const double turn = degrees(expected.R.transpose() * sighting.T_a_c.R);
      const double shift = (expected.t - sighting.T_a_c.t).norm();
      if (turn > parameters_.join_max_turn || shift > parameters_.join_tolerance * depth) continue;
      link->sightings.push_back({sighting.keyframe, sighting.tracks});
    }
    link->ok = static_cast<int>(count) >= parameters_.join_min_pairs &&
               static_cast<double>(count) >= parameters_.join_min_agreement * static_cast<double>(pairs_.size()) &&
               static_cast<int>(link->sightings.size()) >= parameters_.join_min_keyframes;
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      if (agrees[i] && pairs_[i].point_a >= 0) link->points.emplace_back(pairs_[i].point_a, pairs_[i].point_b);
    link->texts = texts_;
  }

 private:
  struct Sighting {
    int keyframe;
    SE3d T_a_c;
    std::vector<Track> tracks;
  };

  void add_pair(const Pair& pair) {
    if (pair.point_a >= 0)
      for (const Pair& other : pairs_)
        if (other.point_a == pair.point_a || other.point_b == pair.point_b) return;
    pairs_.push_back(pair);
  }

  // The corners of a's quad, and where their rays meet b's plane.
  void add_text(const TextObject& of_a, const SE3d& T_c_a, const TextObject& of_b, const SE3d& T_c_b, int id) {
    if (of_a.state != TextState::mapped || of_b.state != TextState::mapped) return;
    if (!textplane::words_agree(textplane::consensus(of_a.votes), textplane::consensus(of_b.votes), parameters_.text))
      return;
    Quad<double> quad_a, quad_b;
    if (!project_text(a_, of_a, T_c_a, &quad_a) || !project_text(b_, of_b, T_c_b, &quad_b) ||
        facing(a_, of_a, T_c_a) <= 0 || facing(b_, of_b, T_c_b) <= 0 ||
        textplane::iou(quad_a, quad_b) < parameters_.join_text_iou)
      return;
    Vec3 theta_a, theta_b;
    if (!textplane::is_ok(textplane::reanchor_plane<double>(of_a.theta, a_.T_c_h(T_c_a, of_a.host), &theta_a)) ||
        !textplane::is_ok(textplane::reanchor_plane<double>(of_b.theta, b_.T_c_h(T_c_b, of_b.host), &theta_b)))
      return;
    const SE3d T_a_c = T_c_a.inverse(), T_b_c = T_c_b.inverse();
    for (const Vec2& corner : quad_a.corner) {
      const Vec3 ray = ray_of(a_.camera, corner);
      Vec3 in_a, in_b;
      if (textplane::is_ok(textplane::plane_point(theta_a, ray, &in_a)) &&
          textplane::is_ok(textplane::plane_point(theta_b, ray, &in_b)))
        add_pair({T_a_c * in_a, T_b_c * in_b, in_a.z(), id, -1, -1});
    }
    const bool known = std::any_of(texts_.begin(), texts_.end(), [&](const std::pair<int, int>& pair) {
      return pair.first == of_a.id || pair.second == of_b.id;
    });
    if (!known) texts_.emplace_back(of_a.id, of_b.id);
  }

  const Map &a_, &b_;
  const Parameters& parameters_;
  std::vector<Sighting> sightings_;
  std::vector<Pair> pairs_;
  std::vector<std::pair<int, int>> texts_;
};

}  // namespace

MapLink link_maps(const Map& a, const Map& b, const Parameters& parameters, const Relocalisation& seen) {
  MapLink link;
  const int newest = b.newest_keyframe();
  Linker linker(a, b, parameters);
  linker.add(newest, seen);
  const Similarity guess = linker.from_keyframe(newest, seen.T_c_w);
  if (!(guess.scale > 0)) return link;
  for (int id = newest - 1; id >= 0 && id > newest - parameters.join_keyframes; --id) {
    const KeyFrame& keyframe = b.keyframe(id);
    const Relocalisation other = observe_from(a, parameters, keyframe.frame, (guess * keyframe.T_w_c).inverse());
    if (other.ok) linker.add(id, other);
  }
  linker.solve(&link);
  return link;
}

JoinedIds join_maps(Map& a, const Map& b, const MapLink& link, const Parameters& parameters) {
  JoinedIds ids;
  ids.first_keyframe = static_cast<int>(a.keyframes.size());
  for (const KeyFrame& keyframe : b.keyframes)
    a.keyframes.push_back({keyframe.frame, link.S_a_b * keyframe.T_w_c, {}, keyframe.culled});

  ids.points.assign(b.points.size(), -1);
  for (const auto& [of_a, of_b] : link.points) ids.points[static_cast<std::size_t>(of_b)] = of_a;
  for (std::size_t i = 0; i < b.points.size(); ++i) {
    const MapPoint& point = b.points[i];
    int& id = ids.points[i];
    if (point.bad || (id >= 0 && a.point(id).bad)) id = -1;
    if (point.bad) continue;
    if (id < 0) {
      id = static_cast<int>(a.points.size());
      a.points.push_back({link.S_a_b * point.p_w});
      a.points.back().normal_w = link.S_a_b.R * point.normal_w;
    }
    a.point(id).visible += point.visible;
    a.point(id).found += point.found;
    for (const PointObservation& o : point.observations) add_observation(a, id, ids.first_keyframe + o.keyframe, o.px);
  }

  const double s = link.S_a_b.scale;
  for (const TextObject& text : b.texts) {
    if (text.state == TextState::dropped) continue;
    const auto same = std::find_if(link.texts.begin(), link.texts.end(),
                                   [&](const std::pair<int, int>& pair) { return pair.second == text.id; });
    if (same != link.texts.end()) {
      add_observations_of(text, ids.first_keyframe, parameters.text, a.text(same->first));
      continue;
    }
    TextObject moved = text;
    moved.id = static_cast<int>(a.texts.size());
    moved.host += ids.first_keyframe;
    moved.theta /= s;
    moved.covariance /= s * s;
    for (int& view : moved.views) view += ids.first_keyframe;
    a.texts.push_back(std::move(moved));
  }
  return ids;
}

}  // namespace textslam
