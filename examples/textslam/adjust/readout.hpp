// The readout of a rolling shutter, as the errors of the map's points ask for it.
#ifndef TEXTSLAM_ADJUST_READOUT_HPP
#define TEXTSLAM_ADJUST_READOUT_HPP

#include "textslam/map/map.hpp"

namespace textslam {

/// Of the cost of the points, sum rho(|e|^2 / sigma^2) / 2, by the readout, with poses and points held: by seconds and
/// their square. After an adjustment the slope is that of the adjusted cost, too.
struct ReadoutSlope {
  double slope = 0, curvature = 0;
};

/// By the motion that each key frame has; its shutter's readout may be 0.
ReadoutSlope readout_slope(const Map& map, const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_ADJUST_READOUT_HPP
