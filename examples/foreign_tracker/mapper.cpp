// The mapping half of the tracker: key frames, new points, adjustment.
#include <algorithm>
#include <cmath>

#include "foreign_tracker/optimiser.hpp"
#include "foreign_tracker/tracker.hpp"

namespace foreign {

void Tracker::make_key_frame(Frame made) {
  map_.key_frames.push_back(std::make_unique<Frame>(std::move(made)));
  Frame& frame = *map_.key_frames.back();
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    if (!frame.points[i]) continue;
    frame.points[i]->seen.emplace_back(&frame, i);
    frame.points[i]->descriptor = frame.descriptors.row(static_cast<int>(i));
  }
  cull(map_.key_frames.size());
  const std::size_t first_new = map_.points.size();
  std::vector<Frame*> neighbours = covisible(map_, frame, 8);
  for (Frame* other : neighbours) triangulate(*other, frame, match_along_lines(camera_, *other, frame));
  fuse(neighbours, first_new);
  neighbours.push_back(&frame);
  const int id = static_cast<int>(map_.key_frames.size()) - 1;                                // text
  texts_.add_keyframe(id, frame.pyramid(), frame.T_c_w(), frame.quads, frame.text_points());  // text
  adjust(camera_, map_, neighbours, texts_);                                                  // text
  reference_ = &frame;
  since_key_frame_ = 0;
  velocity_ = last_.T_w_c.inverse() * frame.T_w_c * velocity_;
  last_ = frame;
}

// Removes points that are rarely found soon after they were made.
void Tracker::cull(std::size_t now) {
  for (auto it = map_.points.rbegin(); it != map_.points.rend() && (*it)->made + 4 > now; ++it) {
    MapPoint& point = **it;
    if (point.bad) continue;
    point.bad = point.found < 0.25 * point.expected || (point.made + 2 < now && point.seen.size() < 3);
    for (const auto& [frame, key] : point.seen)
      if (point.bad) frame->points[key] = nullptr;
  }
}

// Triangulates matches of key points without a point that have parallax and fit both views. Returns how many.
int Tracker::triangulate(Frame& a, Frame& b, const Matches& matches) {
  const Se3 T_b_a = b.T_w_c.inverse() * a.T_w_c;
  int made = 0;
  for (const auto& [i, k] : matches) {
    const Eigen::Vector3d from = camera_.ray(a.keys[i].pt), turned = T_b_a.rotation() * from,
                          to = camera_.ray(b.keys[k].pt);
    if (a.points[i] || b.points[k] || turned.normalized().dot(to.normalized()) > 0.9998) continue;
    // depth_a turned - depth_b to = -t, least squares.
    const Eigen::Vector3d t = T_b_a.translation();
    Eigen::Matrix2d N;
    N << turned.dot(turned), -turned.dot(to), -turned.dot(to), to.dot(to);
    const Eigen::Vector2d depth = N.inverse() * Eigen::Vector2d(-turned.dot(t), to.dot(t));
    if (!(depth[0] > 0.02) || !(depth[1] > 0.02)) continue;
    const Eigen::Vector3d p = 0.5 * (depth[0] * from + T_b_a.inverse() * (depth[1] * to));
    const auto off = [&](const Frame& frame, std::size_t key, const Eigen::Vector3d& q) {
      return (camera_.project(q) - frame.px(key)).squaredNorm() / (frame.sigma(key) * frame.sigma(key));
    };
    if (off(a, i, p) > kChiSquare95 || off(b, k, T_b_a * p) > kChiSquare95) continue;
    auto point = std::make_unique<MapPoint>();
    point->p_w = a.T_w_c * p;
    point->descriptor = b.descriptors.row(static_cast<int>(k));
    point->reach = (T_b_a * p).norm() * b.sigma(k);
    point->seen = {{&a, i}, {&b, k}};
    point->made = map_.key_frames.size();
    a.points[i] = b.points[k] = point.get();
    map_.points.push_back(std::move(point));
    ++made;
  }
  return made;
}

// Finds the points from `first_new` on in other key frames, and fuses those that have a point there.
void Tracker::fuse(const std::vector<Frame*>& frames, std::size_t first_new) {
  for (std::size_t i = first_new; i < map_.points.size(); ++i) {
    MapPoint& point = *map_.points[i];
    for (Frame* frame : frames) {
      if (point.bad) break;
      if (std::any_of(point.seen.begin(), point.seen.end(), [&](const auto& s) { return s.first == frame; })) continue;
      const int best = best_key(camera_, point, 3, 50, 1.0, *frame);
      if (best < 0) continue;
      const auto key = static_cast<std::size_t>(best);
      if (MapPoint* other = frame->points[key]; other) {  // the older one has it
        for (const auto& [where, k] : point.seen) {
          const bool twice =
              std::any_of(other->seen.begin(), other->seen.end(), [w = where](const auto& s) { return s.first == w; });
          where->points[k] = twice ? nullptr : other;
          if (!twice) other->seen.emplace_back(where, k);
        }
        point.bad = true;
      } else {
        frame->points[key] = &point;
        point.seen.emplace_back(frame, key);
      }
    }
  }
}

}  // namespace foreign
