// Tracker: the pose of a frame by the map. It never changes the map, so it also fills in frames before the map began,
// and tries a lost frame against an old key frame.
//
// Prediction (constant velocity, rotation by whole-image alignment) -> KLT of map points -> pose from points -> KLT of
// other corners, expected by that pose -> search for other map points and those that drifted, by their key frame's
// patch -> pose from points and text, coarse to fine. The pose holds where enough was found, and where its position is
// known to max_position_sigma of the scene's depth.
#ifndef TEXTSLAM_TRACK_TRACKER_HPP
#define TEXTSLAM_TRACK_TRACKER_HPP

#include <vector>

#include "textplane/solver/pose.hpp"
#include "textslam/map/local_map.hpp"
#include "textslam/track/point_search.hpp"
#include "textslam/track/track.hpp"

namespace textslam {

struct TrackReport {
  bool ok = false;
  SE3d T_c_w;
  Matrix6 information = Matrix6::Zero();  ///< Of T_c_w, as PoseEstimate has it.
  double position_sigma = 0;              ///< Of the camera, as a share of the median depth of what holds the pose.
  int points = 0;                         ///< Map points tracked.
  int inliers = 0;                        ///< Of them, consistent with the pose.
  int texts = 0;                          ///< Texts that took part with a good ZNCC.
  std::vector<int> visible;               ///< Ids of points that should be seen.
  std::vector<int> found;                 ///< Ids of points that were.
  double klt_ms = 0, pose_ms = 0, reobserve_ms = 0;
};

class Tracker {
 public:
  Tracker(const Map& map, const Parameters& parameters) : map_(map), parameters_(parameters) {}

  /// The part of the map in use; null, as at first: all of it. It must outlive the tracker.
  void look_for(const LocalMap* local) { local_ = local; }
  /// Begins at a frame of known pose, at rest, with tracks whose positions are in that frame.
  void start(const Frame& frame, const SE3d& T_c_w, std::vector<Track> tracks);
  /// The next frame. Behind a rolling shutter its `rows` are taken as known where they are given. On failure the
  /// tracks are those that survived and the pose is the prediction.
  TrackReport track(const Frame& taken);
  /// After the map changed: the last frame's pose in it, and the factor of lengths around the frame.
  void correct(const SE3d& T_c_w, double scale = 1);

  std::vector<Track>& tracks() { return tracks_; }
  const SE3d& pose() const { return T_c_w_; }
  const Frame& frame() const { return frame_; }

 private:
  struct Candidate {
    int point;
    PointPrediction prediction;
  };
  struct SeenText {
    const TextObject* text;
    textplane::PoseTextTerm term;
    float zncc = 0;
    double least = 0;  // ZNCC of one that agrees
  };

  SE3d predict(const Frame& frame) const;
  void roll(const SE3d& T_c_w, const Frame& taken, Frame* frame) const;
  std::vector<Track> take_corners();
  Vec2f guess(const Frame& frame, const Vec3& p_c, const Vec2f& otherwise) const;
  void follow_points(const Frame& frame, const SE3d& predicted);
  void follow_corners(const Frame& frame, const SE3d& T_c_w, std::vector<Track> corners);
  void reobserve(const Frame& frame, const SE3d& T_c_w, TrackReport* report);
  void relocate(const Frame& frame, const Candidate& candidate);
  void add_unmapped(const SE3d& T_c_w, std::vector<textplane::PosePointTerm>& points) const;
  std::vector<SeenText> texts_in_view(const Frame& frame, const SE3d& T_c_w) const;
  double least_zncc(const Frame& frame, const TextObject& text, const SE3d& T_c_w) const;
  bool refine(const Frame& frame, const std::vector<textplane::PosePointTerm>& points, std::vector<SeenText>& texts,
              std::vector<float>& chi2, SE3d* T_c_w, TrackReport* report) const;
  void judge_position(const SE3d& T_c_w, const std::vector<textplane::PosePointTerm>& points, int map_points,
                      const std::vector<SeenText>& texts, TrackReport* report) const;
  float chi2_of(const Track& track, const CameraView& camera, const SE3d& T_c_w) const;
  std::vector<std::size_t> tracks_of_points(const CameraView& camera, const SE3d& T_c_w, std::size_t* heard) const;
  bool fit_pose(const Frame& frame, bool with_text, SE3d* T_c_w, TrackReport* report);
  bool looks_for_point(int id) const { return !map_.point(id).bad && (!local_ || local_->has_point(id)); }

  const Map& map_;
  const Parameters& parameters_;
  const LocalMap* local_ = nullptr;
  Frame frame_;
  SE3d T_c_w_;
  SE3d velocity_;                    // T_now_before of the last two frames
  Vector6 speed_ = Vector6::Zero();  // of these two: by the time between them
  double seconds_ = 0;               // between them
  bool moving_ = false;
  std::vector<Track> tracks_;
};

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_TRACKER_HPP
