// System, the part that closes loops.
#include <algorithm>

#include "textslam/adjust/adjustment.hpp"
#include "textslam/system.hpp"
#include "textslam/text/text_merge.hpp"

namespace textslam {

// What records and tracks hold of the map, after a loop changed it.
void System::apply(const LoopCorrection& correction) {
  const auto is_gone = [&](int point) { return map_.point(point).bad; };
  for (FrameRecord& record : records_) {
    if (record.map != map_.number || record.keyframe < 0) continue;
    record.T_k_c.t *= correction.scales[static_cast<std::size_t>(record.keyframe)];
    for (SeenPoint& seen : record.seen) seen.point = correction.points[static_cast<std::size_t>(seen.point)];
  }
  std::vector<Track>& tracks = tracker_->tracks();
  for (Track& track : tracks)
    if (track.point >= 0) track.point = correction.points[static_cast<std::size_t>(track.point)];
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [&](const Track& track) { return track.point >= 0 && is_gone(track.point); }),
               tracks.end());
}

// The key frame just added may show a part of the map that has drifted away.
void System::close_loops(FrameRecord& record) {
  Loop loop = find_loop(map_, local_, parameters_);
  if (!loop.ok) return;
  // In real time an adjustment may be under way: it is waited for, and where it moved the map the loop is found again.
  const Adjuster::Collected adjusted = adjuster_.settle(map_);
  take_over(adjusted);
  if (adjusted.changed) loop = find_loop(map_, local_, parameters_);
  if (!loop.ok) return;
  LoopRecord closed;
  closed.frame = map_.keyframe(loop.keyframe).frame.index;
  closed.met_frame = map_.keyframe(loop.met).frame.index;
  if (!loop.link.texts.empty())
    closed.word = map_.texts[static_cast<std::size_t>(loop.link.texts.front().first)].word();
  const LoopCorrection correction = close_loop(map_, parameters_, loop);
  closed.spread = correction.spread;
  closed.found = correction.found;
  if (parameters_.mode == Mode::text) merge_duplicate_texts(map_, parameters_);
  if (correction.spread) {
    adjust_all(map_, parameters_, parameters_.final_iterations);
    if (parameters_.mode == Mode::text) text_mapper_.observe_again();
  } else {
    adjust_local(map_, parameters_);
  }
  apply(correction);
  closed.left = drift_left(map_, parameters_, loop);
  loops_.push_back(closed);

  local_ = local_map(map_, parameters_, last_keyframe_);
  const SE3d T_c_w = map_.keyframe(last_keyframe_).T_w_c.inverse();
  tracker_->correct(T_c_w, correction.scales[static_cast<std::size_t>(last_keyframe_)]);
  align_live_world();
  set_pose(record, T_c_w);
}

}  // namespace textslam
