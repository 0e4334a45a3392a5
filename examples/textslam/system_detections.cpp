// System, the part that takes detections which come after their frame was tracked.
#include <algorithm>

#include "textslam/system.hpp"
#include "textslam/track/late_corners.hpp"

namespace textslam {
namespace {

constexpr std::size_t kMinCorners = 8;  // of a late candidate, that reach the newest frame: its plane asks for 6

// Tracks as they were in key frame `id`: first those that are followed still, `now` is where these are now; then its other
// map points.
std::vector<Track> tracks_in_keyframe(const Map& map, int id, const std::vector<Track>& tracks,
                                      std::vector<Vec2f>* now) {
  std::vector<Track> in_keyframe;
  std::vector<char> taken(map.points.size(), 0);
  const auto add = [&](const Track& track, const std::vector<PointObservation>& observations) {
    for (const PointObservation& o : observations) {
      if (o.keyframe != id) continue;
      in_keyframe.push_back(track);
      in_keyframe.back().px = o.px.cast<float>();
      if (track.point >= 0) taken[static_cast<std::size_t>(track.point)] = 1;
      return true;
    }
    return false;
  };
  for (const Track& track : tracks)
    if (add(track, track.point >= 0 ? map.point(track.point).observations : track.observations))
      now->push_back(track.px);
  for (const int point : map.keyframe(id).points) {
    if (taken[static_cast<std::size_t>(point)] != 0) continue;
    Track track;
    track.point = point;
    add(track, map.point(point).observations);
  }
  return in_keyframe;
}

}  // namespace

void System::add_detections(int frame, std::vector<Detection> detections, double detect_ms) {
  FrameRecord& record = records_[static_cast<std::size_t>(frame)];
  record.detect_ms = detect_ms;
  if (parameters_.mode == Mode::points) return;
  if (map_.keyframes.empty()) return initialiser_.add_detections(frame, std::move(detections));
  if (record.state != FrameState::tracked || record.map != map_.number) return;

  const auto newest_first = std::find_if(map_.keyframes.rbegin(), map_.keyframes.rend(),
                                         [&](const KeyFrame& keyframe) { return keyframe.frame.index == frame; });
  if (newest_first == map_.keyframes.rend()) {
    Frame seen;
    seen.index = frame;
    seen.detections = std::move(detections);
    text_mapper_.associate(seen, final_pose(record).inverse(), {});
    return;
  }
  if (newest_first->culled) return;
  newest_first->frame.detections = std::move(detections);
  host_late(static_cast<int>(map_.keyframes.rend() - newest_first) - 1);
}

// New texts of a key frame whose detections came late. Their corners are looked for in its image, and followed from there to
// the newest frame in one step; a text too few of whose corners get there is left to a later key frame.
void System::host_late(int id) {
  const KeyFrame& host = map_.keyframe(id);
  const SE3d T_c_w = host.T_w_c.inverse();
  const bool following = tracker_ && lost_frames_ == 0;
  std::vector<Vec2f> now;
  const std::vector<Track> then =
      tracks_in_keyframe(map_, id, following ? tracker_->tracks() : std::vector<Track>(), &now);
  text_mapper_.associate(host.frame, T_c_w, then);
  if (!following) return;
  const std::vector<Detection> fresh = text_mapper_.new_detections(host.frame, T_c_w, then);
  if (parameters_.mode == Mode::loose) return text_mapper_.add_candidates(id, fresh);

  const std::vector<Track> corners =
      late_corners(host.frame, id, quads_of(fresh), then, now, tracker_->frame(), parameters_);

  std::vector<Track>& tracks = tracker_->tracks();
  for (const Detection& detection : fresh) {
    std::vector<Track> inside;
    for (const Track& corner : corners)
      if (textplane::contains(detection.quad, corner.observations.front().px)) inside.push_back(corner);
    std::size_t followed = inside.size();
    for (std::size_t i = 0; i < now.size(); ++i)
      followed += textplane::contains(detection.quad, Vec2(then[i].px.cast<double>())) ? 1 : 0;
    if (followed < kMinCorners) continue;
    text_mapper_.add_candidates(id, {detection});
    tracks.insert(tracks.end(), inside.begin(), inside.end());
  }
}

}  // namespace textslam
