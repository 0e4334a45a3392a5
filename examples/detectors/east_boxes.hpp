// Text boxes from the maps of EAST (Zhou et al., CVPR 2017): a score a cell, and of each cell its box.
#ifndef TEXTSLAM_DETECTORS_EAST_BOXES_HPP
#define TEXTSLAM_DETECTORS_EAST_BOXES_HPP

#include <vector>

#include "io/detections.hpp"

namespace textslam {

struct EastParameters {
  double min_score = 0.5;    ///< Of a cell.
  double max_overlap = 0.3;  ///< IoU of two boxes that stay; of more, the better scored does.
};

/// Five maps of rows x columns each, row by row. A cell stands for 4 x 4 pixels, its box is told from the pixel (4 column, 4 row):
/// distances to its top, right, bottom and left, px, and the angle by which it is turned counter-clockwise on the screen, radians.
struct EastMaps {
  int rows = 0, columns = 0;
  const float* score = nullptr;     ///< rows * columns
  const float* geometry = nullptr;  ///< 5 * rows * columns: top, right, bottom, left, angle
};

/// Boxes in px of the network's input, best first, unread. Cells that are not finite, and boxes without area, are passed over.
std::vector<Detection> decode_east(const EastMaps& maps, const EastParameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_EAST_BOXES_HPP
