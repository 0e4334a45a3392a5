#include "textslam/relocalise/places.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "textplane/features/fast.hpp"
#include "textplane/features/select.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/observations.hpp"

namespace textslam {
namespace {

constexpr int kLevels = 3;               // that corners are looked for on
constexpr int kSizes = 2 * kLevels - 1;  // that points are described at: half octaves
constexpr int kMostSizesApart = 2;       // of a match: twice as near or as far

double px_of_size(int size) { return std::exp2(0.5 * size); }

// On one level, in px of level 0, strongest first.
std::vector<Vec2f> corners_of_level(const Frame& frame, int level, const Parameters& parameters) {
  const textplane::ImageView8 image = frame.image->level(level);
  const int lowest = parameters.min_fast_threshold;
  std::vector<textplane::Corner> corners;
  textplane::detect_fast(image, std::min(parameters.fast_threshold, lowest), true, corners);
  const int cell = std::max(parameters.min_corner_cell, parameters.corner_cell / 2);
  textplane::select_spread(corners, image.width(), image.height(), cell, parameters.place_corners, {}, corners);
  std::vector<Vec2f> out;
  for (const textplane::Corner& c : corners) out.push_back(textplane::point_from_level(Vec2f(c.x, c.y), level));
  return out;
}

void add_look(const SmoothedLevels& levels, const Vec2f& px, int size, int point, std::vector<CornerLook>* out) {
  CornerLook look{px, size, point, {}};
  if (levels.describe(px, px_of_size(size), &look.descriptor)) out->push_back(look);
}

// Few, of the coarser levels, at three sizes: the camera of another frame may have come nearer or gone away.
std::vector<CornerLook> strong_corners(const Frame& frame, const SmoothedLevels& levels, const Parameters& parameters) {
  std::vector<CornerLook> out;
  for (int level = 1; level < std::min(kLevels, frame.image->levels()); ++level) {
    std::vector<Vec2f> corners = corners_of_level(frame, level, parameters);
    if (static_cast<int>(corners.size()) > parameters.place_rank_corners)
      corners.resize(static_cast<std::size_t>(parameters.place_rank_corners));
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (int size = 2 * level - 1; size <= 2 * level + 1; ++size)
        add_look(levels, corners[i], size, level * parameters.place_rank_corners + static_cast<int>(i), &out);
  }
  return out;
}

void keep(const KeyFrame& keyframe, std::vector<CornerLook> corners) {
  auto fresh = std::make_shared<KeyFrameLooks>();
  fresh->corners = std::move(corners);
  keyframe.looks = std::move(fresh);
}

// What the ranking compares; its points need not be described for it.
const std::vector<CornerLook>& corners_of_keyframe(const Map& map, int id, const Parameters& parameters) {
  const KeyFrame& keyframe = map.keyframe(id);
  if (!keyframe.looks)
    keep(keyframe, strong_corners(keyframe.frame, SmoothedLevels(*keyframe.frame.image, kLevels), parameters));
  return keyframe.looks->corners;
}

const KeyFrameLooks& looks_of_keyframe(const Map& map, int id, const Parameters& parameters) {
  const KeyFrame& keyframe = map.keyframe(id);
  std::vector<int> points = keyframe.points;
  std::sort(points.begin(), points.end());
  const auto* known = keyframe.looks.get();
  if (known && std::includes(known->points.begin(), known->points.end(), points.begin(), points.end())) return *known;
  auto fresh = std::make_shared<KeyFrameLooks>();
  const SmoothedLevels levels(*keyframe.frame.image, kLevels);
  for (const int point : points)
    if (const Vec2* px = observed_in(map.point(point).observations, id))
      for (int size = 0; size < kSizes; ++size) add_look(levels, px->cast<float>(), size, point, &fresh->looks);
  fresh->points = std::move(points);
  fresh->corners = known ? known->corners : strong_corners(keyframe.frame, levels, parameters);
  keyframe.looks = std::move(fresh);
  return *keyframe.looks;
}

struct LookMatch {
  int point = -1;
  int bits = kDescriptorBits;
  const CornerLook* found = nullptr;
  float turn = 0;  // from the key frame to the frame
};

// Wrong matches are turned anyhow, right ones all by the roll of the camera: those that agree with most others stay.
void keep_turned_alike(std::vector<LookMatch>* matches, const Parameters& parameters) {
  const auto most = static_cast<float>(radians(parameters.place_same_turn));
  const auto alike = [&](const LookMatch& a, const LookMatch& b) {
    return std::abs(std::remainder(a.turn - b.turn, static_cast<float>(2 * M_PI))) <= most;
  };
  std::ptrdiff_t best = 0;
  LookMatch middle;
  for (const LookMatch& match : *matches) {
    const auto count =
        std::count_if(matches->begin(), matches->end(), [&](const LookMatch& m) { return alike(m, match); });
    if (count <= best) continue;
    best = count;
    middle = match;
  }
  erase_if(*matches, [&](const LookMatch& match) { return !alike(match, middle); });
}

// For each point (its looks follow each other) what it is most like, where nothing else is nearly as like it.
std::vector<LookMatch> match_looks(const std::vector<CornerLook>& looks, const std::vector<CornerLook>& in_frame,
                                   const Parameters& parameters) {
  std::vector<LookMatch> matches;
  const auto apart = [&](const CornerLook* a, const CornerLook* b) {
    const auto most = static_cast<float>(parameters.place_same_corner * px_of_size(std::max(a->size, b->size)));
    return (a->px - b->px).squaredNorm() > most * most;
  };
  for (std::size_t i = 0; i < looks.size();) {
    LookMatch best{looks[i].point, kDescriptorBits, nullptr, 0};
    int second = kDescriptorBits;
    for (; i < looks.size() && looks[i].point == best.point; ++i)
      for (const CornerLook& other : in_frame) {
        if (std::abs(other.size - looks[i].size) > kMostSizesApart) continue;
        const int bits = bits_apart(looks[i].descriptor, other.descriptor);
        if (bits >= second) continue;
        const bool elsewhere = best.found && apart(best.found, &other);
        if (bits < best.bits) {
          if (elsewhere) second = best.bits;
          best.bits = bits;
          best.found = &other;
          best.turn = other.descriptor.angle - looks[i].descriptor.angle;
        } else if (elsewhere) {
          second = bits;
        }
      }
    if (best.found && best.bits <= parameters.place_max_bits && best.bits < parameters.place_ratio * second)
      matches.push_back(best);
  }
  // A corner of the frame is one point: that most like it.
  std::stable_sort(matches.begin(), matches.end(), [](const LookMatch& a, const LookMatch& b) {
    return a.found != b.found ? std::less<const CornerLook*>()(a.found, b.found) : a.bits < b.bits;
  });
  matches.erase(std::unique(matches.begin(), matches.end(),
                            [](const LookMatch& a, const LookMatch& b) { return a.found == b.found; }),
                matches.end());
  keep_turned_alike(&matches, parameters);
  return matches;
}

// Without those of points that have left the key frame.
std::vector<CornerLook> looks_still_observed(const Map& map, int keyframe, const Parameters& parameters) {
  std::vector<CornerLook> looks = looks_of_keyframe(map, keyframe, parameters).looks;
  std::vector<int> observed = map.keyframe(keyframe).points;
  std::sort(observed.begin(), observed.end());
  erase_if(looks,
           [&](const CornerLook& look) { return !std::binary_search(observed.begin(), observed.end(), look.point); });
  return looks;
}

PointMatch point_match(const Map& map, const Parameters& parameters, int point, const CornerLook& found) {
  return {point, map.point(point).p_w, found.px.cast<double>(), parameters.place_sigma * px_of_size(found.size)};
}

// The corner most like each point, near where a pose expects it: there it need not be clearly more alike than others.
void add_expected(const Map& map, const Parameters& parameters, const std::vector<CornerLook>& looks,
                  const std::vector<CornerLook>& in_frame, const CameraView& camera, const SE3d& T_c_w,
                  std::vector<PointMatch>* matches) {
  for (std::size_t i = 0; i < looks.size();) {
    const int point = looks[i].point;
    Vec2 seen = Vec2::Constant(-1e6);  // out of reach
    show(camera, T_c_w * map.point(point).p_w, &seen);
    const Vec2f px = seen.cast<float>();
    const CornerLook* found = nullptr;
    int best = parameters.place_max_bits + 1;
    for (; i < looks.size() && looks[i].point == point; ++i)
      for (const CornerLook& other : in_frame) {
        const auto most = static_cast<float>(parameters.relocation_search * px_of_size(other.size));
        if (!((other.px - px).squaredNorm() <= most * most) || std::abs(other.size - looks[i].size) > kMostSizesApart)
          continue;
        const int bits = bits_apart(looks[i].descriptor, other.descriptor);
        if (bits >= best) continue;
        best = bits;
        found = &other;
      }
    const bool known =
        std::any_of(matches->begin(), matches->end(), [&](const PointMatch& m) { return m.point == point; });
    if (found && !known) matches->push_back(point_match(map, parameters, point, *found));
  }
}

}  // namespace

const SmoothedLevels& FrameLooks::levels() {
  if (!levels_) levels_ = std::make_unique<SmoothedLevels>(*frame_.image, kLevels);
  return *levels_;
}

const std::vector<CornerLook>& FrameLooks::all() {
  if (!std::exchange(has_all_, true))
    for (int level = 0; level < levels().levels(); ++level)
      for (const Vec2f& px : corners_of_level(frame_, level, parameters_)) add_look(levels(), px, 2 * level, -1, &all_);
  return all_;
}

const std::vector<CornerLook>& FrameLooks::strong() {
  if (!std::exchange(has_strong_, true))
    for (const CornerLook& look : in_sizes())
      if (look.size % 2 == 0) strong_.push_back(look);  // of its level; half octaves are between
  return strong_;
}

const std::vector<CornerLook>& FrameLooks::in_sizes() {
  if (!std::exchange(has_sizes_, true)) in_sizes_ = strong_corners(frame_, levels(), parameters_);
  return in_sizes_;
}

void keep_corners(const Map& map, int keyframe, FrameLooks& looks) {
  if (!map.keyframe(keyframe).looks) keep(map.keyframe(keyframe), looks.in_sizes());
}

std::vector<PlaceRank> rank_places(const Map& map, const Parameters& parameters, FrameLooks& looks,
                                   const std::vector<int>& ids, int most, int frame) {
  std::vector<PlaceRank> ranks;
  const std::size_t stride = ids.size() / static_cast<std::size_t>(most) + 1;
  for (std::size_t i = static_cast<std::size_t>(std::max(frame, 0)) % stride; i < ids.size(); i += stride) {
    const std::vector<CornerLook>& known = corners_of_keyframe(map, ids[i], parameters);
    const auto matches = static_cast<int>(match_looks(known, looks.strong(), parameters).size());
    if (matches >= parameters.place_min_matches) ranks.push_back({ids[i], matches});
  }
  std::stable_sort(ranks.begin(), ranks.end(),
                   [](const PlaceRank& a, const PlaceRank& b) { return a.matches > b.matches; });
  if (static_cast<int>(ranks.size()) > parameters.place_candidates)
    ranks.resize(static_cast<std::size_t>(parameters.place_candidates));
  return ranks;
}

MatchedPose pose_by_places(const Map& map, const Parameters& parameters, FrameLooks& looks,
                           const std::vector<int>& keyframes) {
  std::vector<PointMatch> matches;
  for (const int id : keyframes) {
    const std::vector<CornerLook> known = looks_still_observed(map, id, parameters);
    for (const LookMatch& match : match_looks(known, looks.all(), parameters))
      if (has_ray(map.camera, match.found->px.cast<double>()))
        matches.push_back(point_match(map, parameters, match.point, *match.found));
  }
  const CameraView camera = map.view_of(looks.frame());
  MatchedPose pose = pose_of_matches(matches, camera, map.keyframe(keyframes.front()).T_w_c.inverse(), parameters);
  if (pose.inliers >= parameters.place_first_inliers) {
    matches.clear();
    for (const int id : keyframes)
      add_expected(map, parameters, looks_still_observed(map, id, parameters), looks.all(), camera, pose.T_c_w,
                   &matches);
    const MatchedPose settled = settled_pose(matches, camera, pose.T_c_w, parameters);
    if (settled.inliers >= pose.inliers) pose = settled;
  }
  if (pose.inliers < parameters.place_min_inliers) pose.inliers = 0;
  return pose;
}

}  // namespace textslam
