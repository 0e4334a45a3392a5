// System, the part that gives poses to frames that had none when they came: before the map began, or while it was lost.
// The map is whole now, and may show what it did not then.
#include "textslam/relocalise/relocalisation.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

void System::fill_in(const std::function<Frame(int)>& load) {
  if (map_.keyframes.size() < 2 || only_localises_) return;
  follow_on(load, -1);
  if (!find_rest(load)) return;
  follow_on(load, -1);
  follow_on(load, 1);
}

// Tracks on from frames with a pose to those without: to earlier ones (-1) or later ones (1).
void System::follow_on(const std::function<Frame(int)>& load, int step) {
  Tracker tracker(map_, parameters_);
  bool going = false;  // the frame beside this one was tracked so
  const int frames = static_cast<int>(records_.size());
  for (int index = step > 0 ? 1 : frames - 2; index >= 0 && index < frames; index += step) {
    FrameRecord& record = records_[static_cast<std::size_t>(index)];
    const FrameRecord& beside = records_[static_cast<std::size_t>(index - step)];
    if (record.state == FrameState::tracked || beside.state != FrameState::tracked || beside.map != map_.number) {
      going = false;
      continue;
    }
    if (!going) {
      Frame start = load(index - step);
      start.rows = rows_of(beside);
      const SE3d T_c_w = middle_pose(beside).inverse();
      tracker.start(start, T_c_w, observe_from(map_, parameters_, start, T_c_w).tracks);
    }
    const TrackReport report = tracker.track(load(index));
    going = report.ok;
    if (going) give_pose(record, beside.keyframe, report, tracker.frame());
  }
}

// Looks for frames that no neighbour leads to, each by itself. Returns whether any was found.
bool System::find_rest(const std::function<Frame(int)>& load) {
  bool any = false;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    FrameRecord& record = records_[i];
    if (record.state == FrameState::tracked) continue;
    const int index = static_cast<int>(i);
    if (is_rolling() && i > 0 && previous_.index != index - 1) {
      turns_.clear();
      previous_ = load(index - 1);
    }
    const Frame taken = load(index), frame = i > 0 ? turned(taken) : taken;
    previous_ = taken;
    const Relocalisation found = relocalise(map_, parameters_, frame);
    if (!found.ok) continue;
    give_pose(record, map_.keyframe_ids().front(), found, frame);
    any = true;
  }
  return any;
}

void System::give_pose(FrameRecord& record, int keyframe, const TrackReport& report, const Frame& frame) {
  record.state = FrameState::tracked;
  record.map = map_.number;
  record.keyframe = keyframe;
  record.T_k_c = map_.keyframe(keyframe).T_w_c.inverse() * report.T_c_w.inverse();
  record.rows = frame.rows;
  record.take(report);
}

}  // namespace textslam
