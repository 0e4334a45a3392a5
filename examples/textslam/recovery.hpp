// Recovery: the pose of a frame after tracking was lost, from the key frames that look most like it.
#ifndef TEXTSLAM_RECOVERY_HPP
#define TEXTSLAM_RECOVERY_HPP

#include <memory>

#include "textslam/tracker.hpp"

namespace textslam {

struct Recovery {
  std::unique_ptr<Tracker> tracker;  ///< At the frame, ready to go on; null where the frame was not recognised.
  TrackReport report;
};

/// Tries the key frames whose coarsest images correlate best with the frame's; the one with most consistent points wins.
Recovery relocalise(const Map& map, const Parameters& parameters, const Frame& frame);

}  // namespace textslam

#endif  // TEXTSLAM_RECOVERY_HPP
