// Bundle adjustment of the map by the library's window solver: around the newest key frame, or over all of them.
#ifndef TEXTSLAM_ADJUST_ADJUSTMENT_HPP
#define TEXTSLAM_ADJUST_ADJUSTMENT_HPP

#include <memory>

#include "textslam/map/map.hpp"

namespace textslam {

/// Too few key frames to hold some of them fixed: such a map is adjusted as a whole.
inline bool is_too_young(const Map& map) { return map.keyframes.size() < 3; }

/// An adjustment in three steps. solve(), the long one, reads only copies and may run beside tracking.
class StagedAdjustment {
 public:
  /// Around the newest key frame, or of the whole map; null where the map is too young or nothing is free.
  static std::unique_ptr<StagedAdjustment> around_newest(const Map& map, const Parameters& parameters);
  static std::unique_ptr<StagedAdjustment> of_all(const Map& map, const Parameters& parameters);
  virtual ~StagedAdjustment() = default;
  virtual void solve() = 0;
  /// Writes the result into the map, which may have grown since: later key frames and points move along with the key
  /// frame that was the newest then. Returns this motion of the world.
  virtual SE3d apply(Map& map) const = 0;
};

/// Adjusts the newest key frame and those that share most points with it, with their points and text planes; key frames
/// around them stay fixed. Observations that no longer fit are removed.
void adjust_local(Map& map, const Parameters& parameters);

/// Adjusts everything; the first key frame is fixed, and the distance to its farthest neighbour fixes the scale.
void adjust_all(Map& map, const Parameters& parameters, int iterations);

}  // namespace textslam

#endif  // TEXTSLAM_ADJUST_ADJUSTMENT_HPP
