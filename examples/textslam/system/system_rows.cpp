// System, the part that knows how the camera moved while a rolling shutter took the rows of a frame: by its neighbours.
#include <algorithm>
#include <cmath>

#include "textslam/adjust/adjustment.hpp"
#include "textslam/adjust/readout.hpp"
#include "textslam/system/system.hpp"
#include "textslam/track/rotation_prior.hpp"
#include "textslam/track/tracker.hpp"

namespace textslam {
namespace {

constexpr double kLongest = 0.1;  // s, readout either way
// Shares of a readout that was known before the map, by turns: noise of the speeds makes that one too short.
constexpr double kLeastShare = 0.9, kMostShare = 2;

// While a camera turns fast a young map errs by more than that.
double within_bounds(double readout, double start) {
  if (start == 0) return std::clamp(readout, -kLongest, kLongest);
  return start * std::clamp(readout / start, kLeastShare, kMostShare);
}

}  // namespace

// Within the system a pose is that of the middle row: rows before and after it hold it in place. A pose of the first
// row would be the middle's less half a readout of motion. That motion is told by the poses before, so errors of poses
// would feed themselves, and grow where the readout takes nearly a frame's time.
SE3d System::at_stamp(const FrameRecord& record, const SE3d& T_w_c) const {
  const auto& rows = rows_of(record);
  if (!rows || stamp_row_ == map_.shutter.row0) return T_w_c;
  return T_w_c * rows->at(stamp_row_).inverse();
}

// A key frame's are those of the map, which adjustments correct.
const std::shared_ptr<const textplane::RowMotion>& System::rows_of(const FrameRecord& record) const {
  const KeyFrame& keyframe = map_.keyframe(record.keyframe);
  const int index = keyframe.frame.index;  // negative where it is of an earlier session
  const bool is_keyframe = index >= 0 && &records_[static_cast<std::size_t>(index)] == &record;
  return is_keyframe ? keyframe.frame.rows : record.rows;
}

bool System::is_rolling() const { return textslam::is_rolling(map_, parameters_); }

// A frame without a pose, with the motion of its rows by the turn from the frame before.
Frame System::turned(const Frame& frame) {
  Frame out = frame;
  const double seconds = frame.timestamp - previous_.timestamp;
  if (!is_rolling() || records_.size() < 2 || !(seconds > 0)) return out;
  const RotationPrior prior = find_rotation(previous_, frame, map_.camera, Eigen::Matrix3d::Identity(), parameters_);
  turns_.add(prior.R_b_a, seconds);
  out.rows = turning_rows(turns_.newest(), map_.shutter);
  return out;
}

void System::remember(const Frame& frame, const FrameRecord& record) {
  if (!is_rolling()) return;
  previous_ = frame;
  if (record.state == FrameState::tracked) turns_.clear();
}

// The first key frame of a new map has no frame before it: the one after it tells.
void System::roll_first_keyframe() {
  const KeyFrame& first = map_.keyframe(0);
  const Frame& beside = initialiser_.beside();
  if (!is_rolling() || beside.index != first.frame.index + 1) return;
  Tracker tracker(map_, parameters_);
  const SE3d T_c_w = first.T_w_c.inverse();
  tracker.start(first.frame, T_c_w, tracks_of_keyframe(map_, 0));
  const TrackReport report = tracker.track(beside);
  if (!report.ok) return;
  const textplane::RowMotion rows{
      textplane::velocity_between(T_c_w, report.T_c_w, beside.timestamp - first.frame.timestamp), map_.shutter};
  map_.set_rows(0, std::make_shared<const textplane::RowMotion>(rows));
}

// The motion of the frame `index` by the frames on both sides of it, or on one where it has no motion yet.
void System::roll(std::size_t index) {
  constexpr double kFarthest = 0.25;  // s; motion does not stay the same for longer
  FrameRecord& record = records_[index];
  const auto is_tracked = [&](const FrameRecord& r) {
    return r.state == FrameState::tracked && r.map == map_.number &&
           std::abs(r.timestamp - record.timestamp) <= kFarthest;
  };
  if (!is_rolling() || !is_tracked(record)) return;
  const bool has_before = index > 0 && is_tracked(records_[index - 1]),
             has_after = index + 1 < records_.size() && is_tracked(records_[index + 1]);
  const int id = record.keyframe;
  const bool is_keyframe = map_.keyframe(id).frame.index == static_cast<int>(index);
  const bool known = record.rows != nullptr;
  if ((!has_before && !has_after) || (known && !(has_before && has_after))) return;
  const FrameRecord &before = has_before ? records_[index - 1] : record,
                    &after = has_after ? records_[index + 1] : record;
  const Vector6 velocity = textplane::velocity_between(middle_pose(before).inverse(), middle_pose(after).inverse(),
                                                       after.timestamp - before.timestamp);
  record.rows = std::make_shared<const textplane::RowMotion>(textplane::RowMotion{velocity, map_.shutter});
  if (is_keyframe) map_.set_rows(id, record.rows);
}

void System::roll_all() {
  for (std::size_t i = 0; i < records_.size(); ++i) roll(i);
}

// While the map is young, each time that its key frames have doubled.
bool System::is_readout_due() const {
  const std::size_t n = map_.keyframe_ids().size();
  return n == 10 || n == 20 || n == 40 || n == 80;
}

// All key frames as if their rows took so long.
void System::set_readout(double seconds) {
  map_.shutter.readout = seconds;
  for (Map& map : stored_) map.shutter.readout = seconds;
  for (FrameRecord& record : records_)
    if (record.rows)
      record.rows =
          std::make_shared<const textplane::RowMotion>(textplane::RowMotion{record.rows->velocity, map_.shutter});
  for (const int id : map_.keyframe_ids())
    if (const auto rows = map_.keyframe(id).frame.rows)
      map_.set_rows(id,
                    std::make_shared<const textplane::RowMotion>(textplane::RowMotion{rows->velocity, map_.shutter}));
}

// The readout with the least adjusted cost: the root of its slope, by the secant through the last two readouts. The
// first step takes the secant of the last time: with the map held the cost bends ten times as much. A turn of 1 rad/s
// moves the last row by .25 px in 1 ms.
void System::estimate_readout(double settled) {
  constexpr int kRounds = 6;
  double before = 0, slope_before = 0;
  // Velocities that could change would take the readout's part.
  Parameters held = parameters_;
  held.row_speed_sigma = held.row_turn_sigma = 0;
  for (int round = 0; round < kRounds; ++round) {
    roll_all();
    adjust_all(map_, held, held.window_iterations);
    const ReadoutSlope now = readout_slope(map_, held);
    const double readout = map_.shutter.readout;
    if (!(now.curvature > 0)) return;
    // Where the secant bends the wrong way, or hardly, the map is too small to tell.
    if (round > 0)
      readout_bend_ = std::clamp((now.slope - slope_before) / ((readout - before) * now.curvature), 0.005, 1.0);
    before = readout;
    slope_before = now.slope;
    set_readout(within_bounds(readout - now.slope / (readout_bend_ * now.curvature), start_readout_));
    if (std::abs(map_.shutter.readout - before) < settled) return;
  }
}

}  // namespace textslam
