// The part of the map that an adjustment takes: key frames and points, what is fixed, and what holds the scale.
#ifndef TEXTSLAM_ADJUST_ADJUSTMENT_SELECTION_HPP
#define TEXTSLAM_ADJUST_ADJUSTMENT_SELECTION_HPP

#include <vector>

#include "textslam/map/map.hpp"

namespace textslam {

struct AdjustmentSelection {
  std::vector<int> free_frames, fixed_frames;
  std::vector<int> points;
  int scale_frame =
      -1;  ///< Its distance to the first of the fixed frames is kept; -1: the fixed frames hold the scale.
};

/// Around the newest key frame; no free frames where there is nothing to adjust.
AdjustmentSelection local_selection(const Map& map, const Parameters& parameters);

/// All but the first key frame, which is fixed; the distance to its farthest neighbour holds the scale.
AdjustmentSelection whole_selection(const Map& map, const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_ADJUST_ADJUSTMENT_SELECTION_HPP
