// The foreign tracker's solver: Ceres, over poses and points.
#ifndef FOREIGN_TRACKER_OPTIMISER_HPP
#define FOREIGN_TRACKER_OPTIMISER_HPP

#include <vector>

#include "foreign_tracker/map.hpp"

namespace foreign {

/// The 95 % bound of chi-square with two degrees of freedom, on |e|^2 / sigma^2 of a point.
constexpr double kChiSquare95 = 5.991;

/// Optimises the pose of a frame with its points fixed. Removes its outliers. Returns how many points remain.
int optimise_pose(const Camera& camera, Frame& frame);

/// Optimises these key frames, and all points and texts that they see. Other key frames that see the points, and the
/// first of the map, are fixed. Removes outlying observations.
void adjust(const Camera& camera, Map& map, const std::vector<Frame*>& window, textplane::TextMap& texts);  // text

}  // namespace foreign

#endif  // FOREIGN_TRACKER_OPTIMISER_HPP
