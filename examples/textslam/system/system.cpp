#include "textslam/system/system.hpp"

#include <algorithm>

#include "io/clock.hpp"
#include "textslam/adjust/adjustment.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/common/wide_view.hpp"
#include "textslam/map/culling.hpp"
#include "textslam/map/point_normals.hpp"
#include "textslam/track/feature_tracks.hpp"
#include "textslam/track/point_mapper.hpp"

namespace textslam {

System::System(const CameraView& camera, int width, int height, const Parameters& parameters,
               const textplane::RollingShutter& shutter)
    : parameters_(at_view(at_size(parameters, width, height), camera, width, height)),
      stamp_row_(shutter.rows > 1 ? shutter.row0 : all_at_once(height).row0),
      start_readout_(at_middle(shutter, height).readout),
      initialiser_(parameters_),
      text_mapper_(map_, local_, parameters_),
      adjuster_(parameters_) {
  map_.camera = camera;
  map_.width = width;
  map_.height = height;
  map_.shutter = at_middle(shutter, height);
}

const FrameRecord& System::process(const Frame& frame, double detect_ms) {
  FrameRecord& record = records_.emplace_back();
  record.timestamp = frame.timestamp;
  record.detect_ms = detect_ms;
  const double start = now_ms();
  if (only_localises_) return localise(frame, record);
  take_over(adjuster_.collect(map_));
  const bool found = (tracker_ && lost_frames_ == 0 && track(frame, record)) || recover(frame, record);
  record.track_ms = now_ms() - start;
  if (found) {
    follow(frame, record);
  } else if (tracker_) {
    lose(record);
  } else {
    std::vector<Track> tracks;
    const bool begun = initialiser_.add(frame, map_, &tracks);
    record.track_ms = now_ms() - start;
    if (begun) begin_map(frame, std::move(tracks), record);
  }
  const auto remembered = static_cast<std::size_t>(parameters_.refit_frames);
  if (records_.size() > remembered) {
    FrameRecord& oldest = records_[records_.size() - remembered - 1];
    refit(oldest);
    std::vector<SeenPoint>().swap(oldest.seen);
  }
  remember(frame, record);
  return record;
}

// After each change of the map's key frames, what depends on them is updated here: the tracker (the last frame's pose,
// and lengths by `scale`) and the live world; for `newest`, that frame as newest key frame, also local map and pose.
void System::map_changed(const SE3d& T_c_w, FrameRecord* newest, double scale) {
  if (newest) local_ = local_map(map_, parameters_, last_keyframe_);
  if (tracker_) tracker_->correct(T_c_w, scale);
  align_live_world();
  if (newest) set_pose(*newest, T_c_w);
}

void System::set_pose(FrameRecord& record, const SE3d& T_c_w) {
  record.state = FrameState::tracked;
  record.live = true;
  record.map = map_.number;
  record.keyframe = last_keyframe_;
  const SE3d T_w_c = T_c_w.inverse();
  record.T_k_c = map_.keyframe(last_keyframe_).T_w_c.inverse() * T_w_c;
  record.T_w_m_live = live_world_ * T_w_c;
  record.T_w_c_live = live_world_ * at_stamp(record, T_w_c);
}

// Without the newest frame, whose live pose is yet to be given. By poses of the middle row: near the start the camera
// has moved no farther than the others differ by chance.
void System::align_live_world() {
  std::vector<const FrameRecord*> live;
  for (const FrameRecord& record : records_)
    if (record.live && record.map == map_.number && &record != &records_.back()) live.push_back(&record);
  const std::size_t step = std::max<std::size_t>(1, live.size() / static_cast<std::size_t>(parameters_.live_frames));
  std::vector<SE3d> now, given;
  for (std::size_t i = 0; i < live.size(); i += step) {
    now.push_back(middle_pose(*live[i]));
    given.push_back(live[i]->T_w_m_live);
  }
  align_poses(now, given, &live_world_);  // or it stays as it was
}

void System::begin_map(const Frame& frame, std::vector<Track> tracks, FrameRecord& record) {
  const double start = now_ms();
  map_.number = maps_++;
  const KeyFrame& first = map_.keyframe(0);
  FrameRecord& first_record = records_[static_cast<std::size_t>(first.frame.index)];
  first_record.state = FrameState::tracked;
  first_record.map = map_.number;
  first_record.keyframe = 0;
  last_keyframe_ = 1;
  live_world_ = {};
  const SE3d T_c_w = map_.keyframe(1).T_w_c.inverse();
  set_pose(record, T_c_w);
  record.points = static_cast<int>(map_.points.size());

  if (parameters_.mode != Mode::points)
    text_mapper_.add_candidates(0, text_mapper_.new_detections(first.frame, first.T_w_c.inverse(), {}));
  last_keyframe_points_ = static_cast<int>(tracks.size());
  update_texts(frame, tracks);
  local_ = local_map(map_, parameters_, last_keyframe_);
  begin_tracking(frame, T_c_w, std::move(tracks));
  roll_first_keyframe();
  record.map_ms = now_ms() - start;
}

void System::begin_tracking(const Frame& frame, const SE3d& T_c_w, std::vector<Track> tracks) {
  tracker_ = std::make_unique<Tracker>(map_, parameters_);
  tracker_->look_for(&local_);
  tracker_->start(frame, T_c_w, std::move(tracks));
}

bool System::track(const Frame& frame, FrameRecord& record) {
  const TrackReport report = tracker_->track(frame);
  record.klt_ms = report.klt_ms;
  record.pose_ms = report.pose_ms;
  record.reobserve_ms = report.reobserve_ms;
  record.points = report.inliers;
  record.texts = report.texts;
  if (!report.ok) return false;
  if (is_contradicted(report)) {
    drop_map();
    return false;
  }
  record.by = FoundBy::tracking;
  record.information = report.information;
  record.position_sigma = report.position_sigma;
  for (const int id : report.visible) ++map_.point(id).visible;
  for (const int id : report.found) ++map_.point(id).found;
  return true;
}

void System::follow(const Frame& frame, FrameRecord& record) {
  lost_frames_ = 0;
  record.rows = tracker_->frame().rows;
  set_pose(record, tracker_->pose());
  if (records_.size() > 1) roll(records_.size() - 2);
  const double start = now_ms();
  if (parameters_.mode != Mode::points) text_mapper_.associate(frame, tracker_->pose(), tracker_->tracks());
  record.seen = seen_points(tracker_->tracks(), static_cast<std::size_t>(parameters_.refit_max_points));
  if (keyframe_needed(frame)) {
    add_keyframe(frame, record);
    if (parameters_.loop_closure) close_loops(record);
    join_stored(frame, record);
  }
  record.map_ms = now_ms() - start;
}

void System::lose(FrameRecord& record) {
  record.state = FrameState::lost;
  if (lost_frames_++ == 0) lost_since_ = record.timestamp;
  const bool young = static_cast<int>(map_.keyframes.size()) < parameters_.young_map_keyframes;
  const double patience = young ? parameters_.young_map_patience : parameters_.lost_patience;
  if (record.timestamp - lost_since_ >= patience) store_map();
}

bool System::keyframe_needed(const Frame& frame) const {
  const KeyFrame& last = map_.keyframe(last_keyframe_);
  const bool recent = frame.timestamp - last.frame.timestamp < parameters_.keyframe_min_gap;
  std::vector<double> flow;
  int points = 0;
  for (const Track& track : tracker_->tracks()) {
    points += track.point >= 0 && track.inlier ? 1 : 0;
    const auto& observations = observations_of(map_, track);
    if (!observations.empty() && observations.back().keyframe == last_keyframe_)
      flow.push_back((observations.back().px - track.px.cast<double>()).norm());
  }
  const double share = recent ? parameters_.keyframe_urgent_share : parameters_.keyframe_min_share;
  if (static_cast<int>(flow.size()) < parameters_.keyframe_min_tracks || points < share * last_keyframe_points_)
    return true;
  return median(std::move(flow)) > parameters_.keyframe_flow ||
         (parameters_.mode == Mode::text &&
          text_mapper_.has_parallax(tracker_->pose(), tracker_->tracks(), last_keyframe_));
}

void System::add_keyframe(const Frame& frame, FrameRecord& record) {
  std::vector<Track>& tracks = tracker_->tracks();
  last_keyframe_ = insert_keyframe(map_, tracker_->frame(), tracker_->pose().inverse(), tracks);
  record.information.setZero();  // from here on the pose is the key frame's
  const bool scarce = record.points < parameters_.scarce_points;
  triangulate_tracks(map_, parameters_, scarce ? parameters_.scarce_parallax : parameters_.min_parallax, tracks);

  const double start = now_ms();
  if (parameters_.estimate_readout && is_readout_due()) {
    take_over(adjuster_.settle(map_));
    estimate_readout(2e-4);
  } else {
    adjuster_.keyframe_added(map_);
  }
  record.adjust_ms = now_ms() - start;
  cull_points(map_, parameters_);
  erase_bad_tracks(map_, tracks);
  fit_point_normals(map_, parameters_, last_keyframe_);
  map_changed(map_.keyframe(last_keyframe_).T_w_c.inverse(), &record);
  update_texts(frame, tracks);
  cull_keyframes();
  last_keyframe_points_ = 0;
  for (const Track& track : tracks) last_keyframe_points_ += track.point >= 0 ? 1 : 0;
  record.seen.clear();
}

// Texts of the newest key frame, and new corners: on new texts, too.
void System::update_texts(const Frame& frame, std::vector<Track>& tracks) {
  std::vector<Quad<double>> quads;
  if (parameters_.mode != Mode::points) {
    text_mapper_.update(last_keyframe_, tracks);
    const std::vector<Detection> fresh =
        text_mapper_.new_detections(frame, map_.keyframe(last_keyframe_).T_w_c.inverse(), tracks);
    text_mapper_.add_candidates(last_keyframe_, fresh);
    if (parameters_.mode == Mode::text) quads = quads_of(fresh);
  }
  add_corners(frame, map_.camera, last_keyframe_, quads, parameters_, tracks);
}

// The pose of a frame that is relative to a culled key frame becomes relative to the key frame before it.
void System::cull_keyframes() {
  for (int id = 0; (id = find_redundant_keyframe(map_, parameters_, local_, id)) >= 0;) {
    const KeyFrame& keyframe = map_.keyframe(id);
    const int before = keyframe_before(map_, id);
    const SE3d T_before_id = map_.keyframe(before).T_w_c.inverse() * keyframe.T_w_c;
    const int frame = keyframe.frame.index;  // negative where it is of an earlier session
    if (frame >= 0 && static_cast<int>(records_.size()) - frame <= parameters_.refit_frames)
      records_[static_cast<std::size_t>(frame)].seen =
          seen_points(tracks_of_keyframe(map_, id), static_cast<std::size_t>(parameters_.refit_max_points));
    for (FrameRecord& record : records_) {
      if (record.map != map_.number || record.keyframe != id) continue;
      record.keyframe = before;
      record.T_k_c = T_before_id * record.T_k_c;
    }
    cull_keyframe(map_, id);
    forget_keyframe(id, tracker_->tracks());
  }
}

// The frames since that key frame were tracked in the map before the adjustment.
void System::take_over(const Adjuster::Collected& adjusted) {
  if (!adjusted.changed) return;
  records_[static_cast<std::size_t>(adjusted.frame)].adjust_ms = adjusted.ms;
  if (adjusted.corrected) settled();
  map_changed(tracker_ ? tracker_->pose() * adjusted.moved.inverse() : SE3d{}, nullptr);
}

}  // namespace textslam
