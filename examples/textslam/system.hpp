// System: monocular SLAM with points and planar text, one frame at a time.
//
// Frame -> (initialiser | tracker | recovery) -> key frame? -> points, text, local adjustment. Single-threaded and without
// random draws: the same frames give the same bytes.
#ifndef TEXTSLAM_SYSTEM_HPP
#define TEXTSLAM_SYSTEM_HPP

#include <functional>
#include <memory>
#include <vector>

#include "textslam/initialiser.hpp"
#include "textslam/map.hpp"
#include "textslam/parameters.hpp"
#include "textslam/pose_refit.hpp"
#include "textslam/text_mapper.hpp"
#include "textslam/tracker.hpp"

namespace textslam {

enum class FrameState {
  waiting,  ///< No map yet.
  tracked,
  lost,
};

/// What became of a frame.
struct FrameRecord {
  double timestamp = 0;
  FrameState state = FrameState::waiting;
  int keyframe = -1;  ///< The key frame that the pose is relative to.
  SE3d T_k_c;         ///< Camera to that key frame.
  SE3d T_w_c_live;    ///< Camera to world as known when the frame was processed; tracked frames alone.
  bool live = false;  ///< Tracked when it came, not filled in afterwards.
  int points = 0, texts = 0;
  std::vector<SeenPoint> seen;  ///< Between key frames: what the pose rests on.
  double detect_ms = 0, track_ms = 0, klt_ms = 0, pose_ms = 0, reobserve_ms = 0, map_ms = 0, adjust_ms = 0;
};

class System {
 public:
  System(const Pinhole<double>& camera, int width, int height, const Parameters& parameters);

  /// Takes the next frame; indices count up from 0.
  /// `detect_ms` is what the detector took, for the record.
  const FrameRecord& process(const Frame& frame, double detect_ms = 0);

  /// Gives poses to the frames before the map began, by tracking them backwards from its first frame. `load` returns
  /// the frame of an index again.
  void fill_in(const std::function<Frame(int)>& load);

  /// The adjustment over all key frames at the end.
  void finish();

  const Map& map() const { return map_; }
  const std::vector<FrameRecord>& records() const { return records_; }
  /// Final pose of a tracked frame.
  SE3d final_pose(const FrameRecord& record) const { return map_.keyframe(record.keyframe).T_w_c * record.T_k_c; }

 private:
  void begin_map(const Frame& frame, std::vector<Track> tracks, FrameRecord& record);
  void follow(const Frame& frame, FrameRecord& record);
  bool track(const Frame& frame, FrameRecord& record);
  bool recover(const Frame& frame, FrameRecord& record);
  void restart();
  void set_pose(FrameRecord& record, const SE3d& T_c_w);
  bool keyframe_needed(const Frame& frame) const;
  void add_keyframe(const Frame& frame, FrameRecord& record);
  void refit_poses();

  Parameters parameters_;
  Map map_;
  Initialiser initialiser_;
  TextMapper text_mapper_;
  std::unique_ptr<Tracker> tracker_;  // null until the map begins
  std::vector<FrameRecord> records_;
  int last_keyframe_ = -1;        // id of the newest
  int last_keyframe_points_ = 0;  // tracked in it
  int lost_frames_ = 0;           // in a row
};

}  // namespace textslam

#endif  // TEXTSLAM_SYSTEM_HPP
