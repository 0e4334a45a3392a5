// Text boxes from the maps of EAST (Zhou et al., CVPR 2017): a score a cell, and of each cell its box.
#ifndef TEXTSLAM_DETECTORS_EAST_BOXES_HPP
#define TEXTSLAM_DETECTORS_EAST_BOXES_HPP

#include <vector>

#include "io/detections.hpp"

namespace textslam {

struct EastParameters {
  double min_score = 0.5;    ///< Of a cell.
  double max_overlap = 0.3;  ///< IoU of two boxes; above it only the better scored stays.
};

/// Five maps of rows x columns, row by row. A cell covers 4 x 4 pixels. Its box is relative to the pixel (4 column, 4
/// row): the distances to top, right, bottom and left in px, and the counter-clockwise angle on the screen in radians.
struct EastMaps {
  int rows = 0, columns = 0;
  const float* score = nullptr;     ///< rows * columns
  const float* geometry = nullptr;  ///< 5 * rows * columns: top, right, bottom, left, angle
};

/// Unread boxes in px of the network's input, best first, without cells that are not finite and boxes without area.
std::vector<Detection> decode_east(const EastMaps& maps, const EastParameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_EAST_BOXES_HPP
