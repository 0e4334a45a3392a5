// The foreign tracker's solver: Ceres, over poses and points.
#ifndef FOREIGN_TRACKER_OPTIMISER_HPP
#define FOREIGN_TRACKER_OPTIMISER_HPP

#include <vector>

#include "foreign_tracker/map.hpp"

namespace foreign {

/// The pose of a frame from its points, which are held. Points that do not fit are taken from it. Returns how many
/// stay.
int optimise_pose(const Camera& camera, Frame& frame);

/// Poses of these key frames and all points that they see; other key frames that see these are held, and so is the
/// first of the map. Observations that do not fit are taken out.
void adjust(const Camera& camera, Map& map, const std::vector<Frame*>& window);

}  // namespace foreign

#endif  // FOREIGN_TRACKER_OPTIMISER_HPP
