// Initialiser: follows corners from a reference frame until two views give a reliable map. Where several motions
// explain the two views, all are kept until further views leave one (motion_hypotheses.hpp).
#ifndef TEXTSLAM_INIT_INITIALISER_HPP
#define TEXTSLAM_INIT_INITIALISER_HPP

#include <optional>
#include <vector>

#include "textslam/init/motion_hypotheses.hpp"
#include "textslam/track/frame_turns.hpp"

namespace textslam {

class Initialiser {
 public:
  explicit Initialiser(const Parameters& parameters) : parameters_(parameters), hypotheses_(parameters) {}

  /// Takes the next frame. True when `map` now holds two key frames (the reference and this frame) and their points,
  /// with a median depth of 1, and `tracks` the corners in this frame.
  bool add(const Frame& frame, Map& map, std::vector<Track>* tracks);
  /// Late detections of a frame added before; used if it is the reference. `camera`: of the map.
  void add_detections(int frame, std::vector<Detection> detections, const CameraView& camera);
  /// The frame after the reference of the map just made.
  const Frame& beside() const { return beside_; }
  /// The next frame begins anew.
  void forget() {
    tracks_.clear();
    hypotheses_.clear();
  }

 private:
  /// From the reference frame to the newest, up to scale.
  struct Motion {
    SE3d T_b_a;
    std::vector<char> inlier;  // per track
  };

  void restart(const Frame& frame, const CameraView& camera);
  void roll(const Eigen::Matrix3d& R_newest_last, const textplane::RollingShutter& shutter, Frame* newest);
  int matches_needed() const;
  std::optional<Motion> motion_of_two_views(const CameraView& camera);
  std::optional<Motion> motion_of_hypotheses(const CameraView& camera);
  double error_of_rows(double parallax) const;
  double parallax(const Motion& motion, const CameraView& camera) const;
  bool build(const Frame& frame, const Motion& motion, Map& map, std::vector<Track>* tracks);

  const Parameters& parameters_;
  Frame reference_, beside_, last_;  // beside_: the frame after the reference
  std::vector<Track> tracks_;        // observations: in the reference frame, then in the hypotheses' views, standing
  int corners_ = 0;                  // that the reference frame had
  MotionHypotheses hypotheses_;      // empty while two views may decide
  double began_ = 0;                 // time of the frame that the hypotheses are from, s
  FrameTurns turns_;                 // behind a rolling shutter
  double reference_unsure_ = 0;      // of the reference's rows, as FrameTurns has it
};

}  // namespace textslam

#endif  // TEXTSLAM_INIT_INITIALISER_HPP
