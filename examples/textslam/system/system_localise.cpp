// System, the part that goes on in a map of earlier sessions, or only localises in it.
#include <algorithm>

#include "io/clock.hpp"
#include "textslam/relocalise/relocalisation.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

void System::go_on_in(Map earlier) {
  earlier_ = earlier.number = maps_++;
  earlier.camera = map_.camera;
  stored_.push_back(std::move(earlier));
}

void System::localise_in(Map earlier) {
  earlier_ = earlier.number = maps_++;
  earlier.camera = map_.camera;
  map_ = std::move(earlier);
  last_keyframe_ = map_.newest_keyframe();
  only_localises_ = true;
}

bool System::is_in_earlier() const {
  return std::any_of(records_.begin(), records_.end(), [&](const FrameRecord& record) {
    return earlier_ >= 0 && record.state == FrameState::tracked && record.map == earlier_;
  });
}

const FrameRecord& System::localise(const Frame& frame, FrameRecord& record) {
  const double start = now_ms();
  const bool found = track_or_find(frame, record);
  record.track_ms = now_ms() - start;
  if (found) {
    lost_frames_ = 0;
    record.rows = tracker_->frame().rows;
    set_pose(record, tracker_->pose());
    record.seen = seen_points(tracker_->tracks(), static_cast<std::size_t>(parameters_.refit_max_points));
  } else {
    record.state = FrameState::lost;
    record.by = FoundBy::nothing;
    ++lost_frames_;
  }
  remember(frame, record);
  return record;
}

// The tracker alone would pass on a pose from frame to frame that nothing but the frame before speaks for.
bool System::track_or_find(const Frame& frame, FrameRecord& record) {
  if (tracker_ && lost_frames_ == 0) {
    const TrackReport report = tracker_->track(frame);
    if (holds(map_, parameters_, report, tracker_->tracks())) {
      record.by = FoundBy::tracking;
      record.take(report);
      local_ = local_map(map_, parameters_, report.found);
      return true;
    }
  }
  return recover(frame, record);
}

}  // namespace textslam
