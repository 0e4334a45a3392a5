// Initialiser: begins a map from two views.
//
// Corners are followed from several reference frames (map_start.hpp): a camera that turns loses those of the oldest one
// from view, and the next one has its parallax already.
#ifndef TEXTSLAM_INIT_INITIALISER_HPP
#define TEXTSLAM_INIT_INITIALISER_HPP

#include <list>
#include <vector>

#include "textslam/init/map_start.hpp"
#include "textslam/track/frame_turns.hpp"

namespace textslam {

class Initialiser {
 public:
  explicit Initialiser(const Parameters& parameters) : parameters_(parameters) {}

  /// Takes the next frame. True when `map` now holds two key frames (a reference and this frame) and their points,
  /// with a median depth of 1, and `tracks` the corners in this frame.
  bool add(const Frame& frame, Map& map, std::vector<Track>* tracks);
  /// Late detections of a frame added before; used if it is a reference. `camera`: of the map.
  void add_detections(int frame, const std::vector<Detection>& detections, const CameraView& camera);
  /// The frame after the reference of the map just made.
  const Frame& beside() const { return beside_; }
  /// The next frame begins anew.
  void forget() { starts_.clear(); }

 private:
  void roll(const Eigen::Matrix3d& R_newest_last, const textplane::RollingShutter& shutter, Frame* newest);
  bool wants_reference() const;

  const Parameters& parameters_;
  std::list<MapStart> starts_;  // the oldest first, which alone is judged
  Frame beside_, last_;
  FrameTurns turns_;  // behind a rolling shutter
};

}  // namespace textslam

#endif  // TEXTSLAM_INIT_INITIALISER_HPP
