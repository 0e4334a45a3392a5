// System, the part that deals with several maps.
#include <algorithm>

#include "textslam/common/algorithms.hpp"
#include "textslam/loop/map_join.hpp"
#include "textslam/relocalise/relocalisation.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

// Two views from nearly the same place may have a wrong motion by chance, and even so the first points agree with it.
// Soon they part: a young map in which many points disagree is wrong, whatever it began with.
bool System::is_contradicted(const TrackReport& report) const {
  return map_.number != earlier_ && static_cast<int>(map_.keyframe_ids().size()) <= parameters_.trial_keyframes &&
         report.inliers < parameters_.trial_inliers * report.points;
}

// Its frames have no pose from now on, as those before it. fill_in() may find them in the map to come.
void System::drop_map() {
  for (FrameRecord& record : records_) {
    if (record.map != map_.number) continue;
    FrameRecord without;
    without.timestamp = record.timestamp;
    without.detect_ms = record.detect_ms;
    record = std::move(without);
  }
  store_map();
  stored_.pop_back();
}

void System::store_map() {
  take_over(adjuster_.settle(map_));
  if (!map_.keyframes.empty()) stored_.push_back(std::move(map_));
  map_.clear();
  local_ = {};
  tracker_.reset();
  initialiser_.forget();
  lost_frames_ = 0;
}

// A stored map is worked on again.
void System::take_map(std::size_t stored) {
  Map taken = std::move(stored_[stored]);
  stored_.erase(stored_.begin() + static_cast<std::ptrdiff_t>(stored));
  store_map();
  map_ = std::move(taken);
  last_keyframe_ = map_.newest_keyframe();
  map_changed({}, nullptr);
}

bool System::recover(const Frame& taken, FrameRecord& record) {
  if (map_.keyframes.empty() && stored_.empty()) return false;
  Relocalisation found;
  const Frame frame = turned(taken);
  FrameLooks looks(frame, parameters_);
  if (!map_.keyframes.empty()) found = relocalise(map_, parameters_, frame, looks, true);
  // The map that was left last is the likeliest.
  for (std::size_t i = stored_.size(); i > 0 && !found.ok; --i) {
    found = relocalise(stored_[i - 1], parameters_, frame, looks, true);
    if (found.ok) take_map(i - 1);
  }
  if (!found.ok) return false;
  record.by = found.by;
  record.take(found);
  last_keyframe_points_ = found.inliers;
  // The motion since the last frame is not known: the tracker starts without a velocity.
  local_ = local_map(map_, parameters_, found.found);
  begin_tracking(frame, found.T_c_w, std::move(found.tracks));
  return true;
}

// The key frame just added may show a stored map. Then the map that is worked on moves into it; the map of earlier
// sessions never does, so that its world and its ids stay.
void System::join_stored(const Frame& frame, FrameRecord& record) {
  if (map_.number == earlier_ || stored_.empty()) return;
  Frame in_stored = frame;  // lengths of a stored map differ, turns do not
  if (const auto& rows = tracker_->frame().rows) in_stored.rows = turning_rows(rows->velocity.tail<3>(), rows->shutter);
  FrameLooks looks(in_stored, parameters_);
  for (std::size_t i = stored_.size(); i > 0; --i) {
    const Relocalisation seen = relocalise(stored_[i - 1], parameters_, in_stored, looks, false);
    if (!seen.ok) continue;
    take_over(adjuster_.settle(map_));
    const MapLink link = link_maps(stored_[i - 1], map_, parameters_, seen);
    if (!link.ok) continue;
    join(i - 1, link);
    const SE3d T_c_w = map_.keyframe(last_keyframe_).T_w_c.inverse();
    begin_tracking(frame, T_c_w, std::vector<Track>(std::move(tracker_->tracks())));
    return map_changed(T_c_w, &record);
  }
}

void System::join(std::size_t stored, const MapLink& link) {
  Map joined = std::move(stored_[stored]);
  stored_.erase(stored_.begin() + static_cast<std::ptrdiff_t>(stored));
  const JoinedIds ids = join_maps(joined, map_, link, parameters_);
  const auto point_in_joined = [&](int id) { return ids.points[static_cast<std::size_t>(id)]; };
  for (FrameRecord& record : records_) {
    if (record.map != map_.number) continue;
    record.map = joined.number;
    record.keyframe += ids.first_keyframe;
    record.T_k_c.t *= link.S_a_b.scale;
    record.information = rescaled(record.information, link.S_a_b.scale);
    record.live = false;
    for (SeenPoint& seen : record.seen) seen.point = point_in_joined(seen.point);
    erase_if(record.seen, [](const SeenPoint& seen) { return seen.point < 0; });
  }
  std::vector<Track>& tracks = tracker_->tracks();
  for (Track& track : tracks) {
    if (track.point >= 0) track.point = point_in_joined(track.point);
    for (PointObservation& o : track.observations) o.keyframe += ids.first_keyframe;
  }
  map_ = std::move(joined);
  last_keyframe_ += ids.first_keyframe;

  roll_all();
  if (adjuster_.map_corrected(map_)) settled();
  erase_bad_tracks(map_, tracks);
}

std::map<int, std::size_t> System::frames_by_map() const {
  std::map<int, std::size_t> counts;
  for (const FrameRecord& record : records_)
    if (record.map >= 0) ++counts[record.map];
  return counts;
}

std::size_t System::live_frames() const {
  const auto is_live = [](const FrameRecord& record) { return record.live; };
  return static_cast<std::size_t>(std::count_if(records_.begin(), records_.end(), is_live));
}

std::vector<std::size_t> System::map_frames() const {
  std::map<int, std::size_t> counts = frames_by_map();
  std::vector<std::size_t> frames;
  for (const auto& [number, count] : counts)
    if (number != map_.number) frames.push_back(count);
  std::sort(frames.rbegin(), frames.rend());
  if (counts.count(map_.number) > 0) frames.insert(frames.begin(), counts[map_.number]);
  return frames;
}

void System::keep_largest() {
  std::map<int, std::size_t> counts = frames_by_map();
  std::size_t largest = stored_.size();
  if (counts.count(earlier_) > 0) counts[earlier_] = records_.size();  // whatever else was begun
  std::size_t most = map_.keyframes.empty() ? 0 : counts[map_.number];
  for (std::size_t i = 0; i < stored_.size(); ++i)
    if (counts[stored_[i].number] > most || (stored_[i].number == earlier_ && most == 0)) {
      most = counts[stored_[i].number];
      largest = i;
    }
  if (largest < stored_.size()) take_map(largest);
  for (FrameRecord& record : records_) {
    if (record.state != FrameState::tracked || record.map == map_.number) continue;
    record.state = FrameState::lost;
    record.live = false;
  }
}

}  // namespace textslam
