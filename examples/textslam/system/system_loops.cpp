// System, the part that closes loops.
#include "textplane/landmarks/text_merge.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

// Updates what records and tracks hold of the map after a loop changed it.
void System::apply(const LoopCorrection& correction) {
  for (FrameRecord& record : records_) {
    if (record.map != map_.number || record.keyframe < 0) continue;
    const double scale = correction.scales[static_cast<std::size_t>(record.keyframe)];
    record.T_k_c.t *= scale;
    record.information = rescaled(record.information, scale);
    for (SeenPoint& seen : record.seen) seen.point = correction.points[static_cast<std::size_t>(seen.point)];
  }
  std::vector<Track>& tracks = tracker_->tracks();
  for (Track& track : tracks)
    if (track.point >= 0) track.point = correction.points[static_cast<std::size_t>(track.point)];
  erase_bad_tracks(map_, tracks);
}

// The key frame just added may show a part of the map that has drifted away. While the map still settles after the last
// loop, none is looked for: the drift is not known.
void System::close_loops(FrameRecord& record) {
  if (adjuster_.is_correcting()) return;
  Loop loop = find_loop(map_, local_, parameters_);
  if (!loop.ok) return;
  // In real time an adjustment may be under way. Where it moved the map, the loop is searched for again.
  const Adjuster::Collected adjusted = adjuster_.settle(map_);
  take_over(adjusted);
  if (adjusted.changed) loop = find_loop(map_, local_, parameters_);
  if (!loop.ok) return;
  LoopRecord closed;
  closed.frame = map_.keyframe(loop.keyframe).frame.index;
  closed.met_frame = map_.keyframe(loop.met).frame.index;
  if (!loop.link.texts.empty()) closed.word = textplane::consensus(map_.text(loop.link.texts.front().first).votes);
  const LoopCorrection correction = close_loop(map_, parameters_, loop);
  closed.corrected = correction.corrected;
  closed.found = correction.found;
  loops_.push_back(closed);
  if (parameters_.mode == Mode::text)
    textplane::merge_duplicate_texts(parameters_.text, textplane::KeyframeLookup(map_), map_.texts);
  if (correction.corrected) {
    open_loop_ = loop;
    if (adjuster_.map_corrected(map_)) settled();
  } else {
    adjuster_.keyframe_added(map_);
    loops_.back().left = drift_left(map_, parameters_, loop);
  }
  apply(correction);
  map_changed(map_.keyframe(last_keyframe_).T_w_c.inverse(), &record,
              correction.scales[static_cast<std::size_t>(last_keyframe_)]);
}

// After a loop or a join moved parts of the map, and all of it was adjusted.
void System::settled() {
  if (parameters_.mode == Mode::text) text_mapper_.observe_again();
  if (open_loop_) loops_.back().left = drift_left(map_, parameters_, *open_loop_);
  open_loop_.reset();
}

}  // namespace textslam
