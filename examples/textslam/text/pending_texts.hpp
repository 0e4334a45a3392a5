// PendingTexts: detections of no known text in frames between key frames. A detector that misses most frames seldom
// finds a text in one that becomes a key frame.
#ifndef TEXTSLAM_TEXT_PENDING_TEXTS_HPP
#define TEXTSLAM_TEXT_PENDING_TEXTS_HPP

#include <array>
#include <vector>

#include "textslam/map/map.hpp"

namespace textslam {

/// A place that was detected, carried along by the poses of the frames: its corners are guessed to be as far as the map
/// points about it.
class PendingTexts {
 public:
  explicit PendingTexts(const Parameters& parameters) : parameters_(parameters) {}

  /// Remembers detections of a frame that show no known text, where the newest key frame has points about them. One
  /// that meets an older one takes its place. What is older than text_pending is forgotten.
  void add(const Map& map, const Frame& frame, const SE3d& T_c_w, const std::vector<Detection>& detections);

  /// Those seen at least twice, where a frame of this pose shows them.
  std::vector<Detection> carried_to(const Map& map, const SE3d& T_c_w) const;

  struct Count {
    int detections = 0, shown = 0;  ///< Frames that detected it, and frames with detections since the first of them.
  };
  /// Forgets what lies on this quad in a frame of this pose, and returns how often it was detected.
  Count take(const Map& map, const SE3d& T_c_w, const Quad<double>& quad);

 private:
  struct Pending {
    int map = -1;  // its number: poses of other maps say nothing
    double seen = 0;
    Count count;
    Detection newest;
    std::array<Vec3, 4> corners;  // in the world
  };
  bool project(const Map& map, const SE3d& T_c_w, const Pending& pending, Quad<double>* quad) const;

  const Parameters& parameters_;
  std::vector<Pending> all_;
};

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_PENDING_TEXTS_HPP
