// Recovery: the pose of a frame after tracking was lost, from the signs that it shows and from the key frames that look most
// like it.
#ifndef TEXTSLAM_TRACK_RECOVERY_HPP
#define TEXTSLAM_TRACK_RECOVERY_HPP

#include <vector>

#include "textslam/track/text_recovery.hpp"
#include "textslam/track/tracker.hpp"

namespace textslam {

struct Recovery {
  bool ok = false;  ///< The frame was recognised; else nothing below counts.
  SE3d T_c_w;
  std::vector<Track> tracks;  ///< Map points found in the frame: what a tracker that starts there follows.
  TrackReport report;
};

/// The frame as seen from about T_c_w: texts and map points are looked for where that pose expects them, and the pose is
/// fitted to them.
Recovery observe_from(const Map& map, const Parameters& parameters, const Frame& frame, const SE3d& T_c_w);

/// The same, and whether the pose holds: the image shows enough of the points that it should see, and two texts agree with it
/// or there are points off the signs: signs are printed more than once.
Recovery recognise_from(const Map& map, const Parameters& parameters, const Frame& frame, const SE3d& T_c_w);

/// The first pose that holds of those that the frame's detections suggest, compared with the texts in one way after another.
Recovery relocalise_by_texts(const Map& map, const Parameters& parameters, const Frame& frame,
                             const std::vector<WordMatch>& ways);

/// Tries the poses that the frame's detections suggest (mode text), and where none holds the key frames whose coarsest images
/// correlate best with the frame's.
Recovery relocalise(const Map& map, const Parameters& parameters, const Frame& frame);

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_RECOVERY_HPP
