// System: monocular SLAM with points and planar text, one frame at a time.
//
// Frame -> (initialiser | tracker | relocalisation) -> key frame? -> points, text, local adjustment. No random draws,
// and one thread but for the adjustment in real time: without that the same frames give the same bytes. Redundant key
// frames are culled: the map grows with the ground seen, not with time.
//
// One map is worked on at a time. After a long loss it is stored, and another begins. Lost frames are searched for in
// the stored maps, and a key frame that shows one joins the two. In the end the map with most frames is the result. A
// young map that most of its points contradict is dropped instead.
//
// A map of earlier sessions begins as such a stored map; where a frame was found in it, it is the result. Or frames are
// only localised in it: then nothing changes.
#ifndef TEXTSLAM_SYSTEM_SYSTEM_HPP
#define TEXTSLAM_SYSTEM_SYSTEM_HPP

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "io/evaluate.hpp"
#include "textslam/adjust/adjuster.hpp"
#include "textslam/detect/text_detector.hpp"
#include "textslam/init/initialiser.hpp"
#include "textslam/loop/loop_closure.hpp"
#include "textslam/text/text_mapper.hpp"
#include "textslam/track/pose_refit.hpp"

namespace textslam {

/// A loop that was closed.
struct LoopRecord {
  int frame = -1;          ///< Index of the frame at which it was closed.
  int met_frame = -1;      ///< Index of the key frame that it met.
  std::string word;        ///< Of a text that is in both parts; empty where points alone closed it.
  bool corrected = false;  ///< Else there was too little drift.
  Drift found, left;
};

enum class FrameState {
  waiting,  ///< No map yet.
  tracked,
  lost,
};

/// The result of a frame.
struct FrameRecord {
  double timestamp = 0;
  FrameState state = FrameState::waiting;
  int map = -1;       ///< Number of the map that it was tracked in. In the end only frames of map() are not lost.
  int keyframe = -1;  ///< The key frame that the pose is relative to.
  SE3d T_k_c;         ///< Camera to that key frame.
  Matrix6 information = Matrix6::Zero();  ///< Of that, see PoseEstimate; zero where the pose is a key frame's.
  SE3d T_w_c_live;  ///< Camera to the live world as known when the frame was processed; tracked frames alone.
  SE3d T_w_m_live;  ///< The same at the time of the middle row, see System::at_stamp().
  FoundBy by = FoundBy::nothing;  ///< What gave it its live pose.
  bool live = false;              ///< Tracked in the map when it came, not filled in or joined afterwards.
  double position_sigma = 0;      ///< Of the camera, as a share of the scene's depth, as tracked.
  int points = 0, texts = 0;
  std::vector<SeenPoint> seen;                            ///< Between key frames: what the pose rests on.
  std::shared_ptr<const textplane::RowMotion> rows = {};  ///< See Frame.
  double detect_ms = 0, track_ms = 0, klt_ms = 0, pose_ms = 0, reobserve_ms = 0, map_ms = 0, adjust_ms = 0;

  /// What the pose rests on, as the tracker reports it.
  void take(const TrackReport& report) {
    points = report.inliers;
    texts = report.texts;
    information = report.information;
    position_sigma = report.position_sigma;
  }
};

class System {
 public:
  /// The lens of the camera, if it has one, must outlive the system. Time stamps belong to the row0 of `shutter`.
  System(const CameraView& camera, int width, int height, const Parameters& parameters,
         const textplane::RollingShutter& shutter = {});

  /// Before the first frame: goes on in a map of earlier sessions (earlier_frame_index() of map_file.hpp), of the same
  /// camera. The live world is the map's.
  void go_on_in(Map earlier);
  /// Likewise, but frames are only localised in it. A pose is given where it holds (relocalisation.hpp), else none.
  void localise_in(Map earlier);

  /// Takes the next frame; indices count up from 0. `detect_ms` is what the detector took, for the record.
  const FrameRecord& process(const Frame& frame, double detect_ms = 0);

  /// Late detections of frame `frame`. In a key frame of the map new texts begin with them; in another tracked frame
  /// they count for known texts; elsewhere they are ignored. Only between two calls of process(), before finish().
  void add_detections(int frame, std::vector<Detection> detections, double detect_ms);

  /// After finish(): gives poses to frames that have none, tracking on from others or looking for them in the whole
  /// map. `load` returns a frame again.
  void fill_in(const std::function<Frame(int)>& load);

  /// The map with most frames becomes the result; the adjustment over all its key frames.
  void finish();

  /// After finish(): multiplies all lengths, those of the live world too.
  void scale_by(double factor);

  /// After finish(): reads the mapped texts, see text_reading.hpp.
  void read_texts(TextReader& reader);

  /// The map that is worked on, in the end the result.
  const Map& map() const { return map_; }
  /// Frames tracked in each map, those of map() first, then by size.
  std::vector<std::size_t> map_frames() const;
  const std::deque<FrameRecord>& records() const { return records_; }
  std::size_t live_frames() const;
  const std::vector<LoopRecord>& loops() const { return loops_; }
  bool estimates_readout() const noexcept { return parameters_.estimate_readout; }
  /// Map to the live world, in which live poses are given. Adjustments move all of a monocular map. This similarity
  /// fits the poses of all frames, as the map has them now, to their live poses, so that the live world stays in place.
  const Similarity& live_world() const { return live_world_; }
  /// Whether a frame was found in the map of earlier sessions, which then is map() once finish() was called.
  bool is_in_earlier() const;
  /// Final pose of a tracked frame, at its time stamp.
  SE3d final_pose(const FrameRecord& record) const { return at_stamp(record, middle_pose(record)); }

 private:
  void follow_on(const std::function<Frame(int)>& load, int step);
  bool find_rest(const std::function<Frame(int)>& load);
  void give_pose(FrameRecord& record, int keyframe, const TrackReport& report, const Frame& frame);
  void remember(const Frame& frame, const FrameRecord& record);
  bool track(const Frame& frame, FrameRecord& record);
  void follow(const Frame& frame, FrameRecord& record);
  void lose(FrameRecord& record);
  void begin_map(const Frame& frame, std::vector<Track> tracks, FrameRecord& record);
  void begin_tracking(const Frame& frame, const SE3d& T_c_w, std::vector<Track> tracks);
  bool keyframe_needed(const Frame& frame) const;
  void add_keyframe(const Frame& frame, FrameRecord& record);
  void update_texts(const Frame& frame, std::vector<Track>& tracks);
  void cull_keyframes();
  void take_over(const Adjuster::Collected& adjusted);
  void map_changed(const SE3d& T_c_w, FrameRecord* newest, double scale = 1);
  SE3d middle_pose(const FrameRecord& record) const { return map_.keyframe(record.keyframe).T_w_c * record.T_k_c; }
  SE3d at_stamp(const FrameRecord& record, const SE3d& T_w_c) const;
  const std::shared_ptr<const textplane::RowMotion>& rows_of(const FrameRecord& record) const;
  bool is_rolling() const;
  bool is_readout_due() const;
  void set_readout(double seconds);
  void estimate_readout(double settled);  // s, the last change of it
  Frame turned(const Frame& frame);
  void roll_first_keyframe();
  void roll(std::size_t index);
  void roll_all();
  void set_pose(FrameRecord& record, const SE3d& T_c_w);
  void align_live_world();
  void refit(FrameRecord& record) const;

  // system_localise.cpp
  const FrameRecord& localise(const Frame& frame, FrameRecord& record);
  bool track_or_find(const Frame& frame, FrameRecord& record);

  // system_detections.cpp
  void host_late(int id);

  // system_loops.cpp
  void close_loops(FrameRecord& record);
  void apply(const LoopCorrection& correction);
  void settled();

  // system_maps.cpp
  bool recover(const Frame& taken, FrameRecord& record);
  bool is_contradicted(const TrackReport& report) const;
  void drop_map();
  void store_map();
  void take_map(std::size_t stored);
  void join_stored(const Frame& frame, FrameRecord& record);
  void join(std::size_t stored, const MapLink& link);
  void keep_largest();
  std::map<int, std::size_t> frames_by_map() const;

  Parameters parameters_;
  double stamp_row_;            // that time stamps belong to; see at_stamp()
  const double start_readout_;  // s; 0: not known before the map
  double readout_bend_ = 0.1;   // curvature of the adjusted cost by the readout, in parts of that with the map held
  Map map_;
  LocalMap local_;           // around the newest key frame
  std::vector<Map> stored_;  // in the order in which they were left
  int maps_ = 0;             // begun so far
  int earlier_ = -1;         // number of the map of earlier sessions
  bool only_localises_ = false;
  Initialiser initialiser_;
  FrameTurns turns_;  // of frames without a pose; behind a rolling shutter, as is the next
  Frame previous_;
  TextMapper text_mapper_;
  Adjuster adjuster_;
  std::unique_ptr<Tracker> tracker_;  // null until the map begins
  std::deque<FrameRecord> records_;   // grows without copies of itself
  std::vector<LoopRecord> loops_;
  std::optional<Loop> open_loop_;  // the last of them, while the map settles after it
  Similarity live_world_;          // see live_world()
  int last_keyframe_ = -1;         // id of the newest
  int last_keyframe_points_ = 0;   // tracked in it
  int lost_frames_ = 0;            // in a row
  double lost_since_ = 0;          // time of the first of them, s
};

}  // namespace textslam

#endif  // TEXTSLAM_SYSTEM_SYSTEM_HPP
