// Lengths of a map, multiplied.
#ifndef TEXTSLAM_MAP_SCALE_MAP_HPP
#define TEXTSLAM_MAP_SCALE_MAP_HPP

#include "textslam/map/map.hpp"

namespace textslam {

/// Multiplies all lengths by `factor`. What images show stays the same.
void scale_map(double factor, Map* map);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_SCALE_MAP_HPP
