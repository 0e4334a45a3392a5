// System, the part that takes detections which come after their frame was tracked.
#include <algorithm>

#include "textslam/system/system.hpp"
#include "textslam/track/track_from_keyframe.hpp"

namespace textslam {

void System::add_detections(int frame, std::vector<Detection> detections, double detect_ms) {
  FrameRecord& record = records_[static_cast<std::size_t>(frame)];
  record.detect_ms = detect_ms;
  if (parameters_.mode == Mode::points) return;
  if (map_.keyframes.empty()) return initialiser_.add_detections(frame, std::move(detections), map_.camera);
  if (record.state != FrameState::tracked || record.map != map_.number) return;

  const auto newest_first = std::find_if(map_.keyframes.rbegin(), map_.keyframes.rend(),
                                         [&](const KeyFrame& keyframe) { return keyframe.frame.index == frame; });
  if (newest_first == map_.keyframes.rend()) {
    Frame seen;
    seen.index = frame;
    seen.timestamp = record.timestamp;
    seen.detections = std::move(detections);
    text_mapper_.associate(seen, middle_pose(record).inverse(), {});
    return;
  }
  if (newest_first->culled) return;
  newest_first->frame.detections = std::move(detections);
  host_late(static_cast<int>(map_.keyframes.rend() - newest_first) - 1);
}

// New texts of a key frame whose detections came late. Their corners are found in its image and tracked to the newest
// frame in one step. A text with too few of them is left to a later key frame.
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
      track_from_keyframe(host.frame, map_.camera, id, quads_of(fresh), then, now, tracker_->frame(), parameters_);

  std::vector<Track>& tracks = tracker_->tracks();
  for (const Detection& detection : fresh) {
    std::vector<Track> inside;
    for (const Track& corner : corners)
      if (textplane::contains(detection.quad, corner.observations.front().px)) inside.push_back(corner);
    std::size_t followed = inside.size();
    for (std::size_t i = 0; i < now.size(); ++i)
      followed += textplane::contains(detection.quad, Vec2(then[i].px.cast<double>())) ? 1U : 0U;
    if (followed < static_cast<std::size_t>(parameters_.text_late_corners)) continue;
    text_mapper_.add_candidates(id, {detection});
    tracks.insert(tracks.end(), inside.begin(), inside.end());
  }
}

}  // namespace textslam
