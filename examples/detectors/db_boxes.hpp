// Text boxes from the map of a DB network (Liao et al., AAAI 2020): the probability that a pixel is the core of a text.
#ifndef TEXTSLAM_DETECTORS_DB_BOXES_HPP
#define TEXTSLAM_DETECTORS_DB_BOXES_HPP

#include <vector>

#include "io/detections.hpp"

namespace textslam {

struct DbParameters {
  double min_probability = 0.3;  ///< Of a pixel of a core.
  double min_score = 0.6;        ///< Mean probability of a box.
  double unclip = 1.5;           ///< A core grows by this share of its area over its perimeter.
  double min_side = 3;           ///< px of the map, before it grows.
};

/// The map, row by row.
struct DbMap {
  int rows = 0, columns = 0;
  const float* probability = nullptr;
};

/// Rectangles of least area around the cores, grown, in px of the map and in the order of the cores' first pixels. A
/// value that is not finite is part of no core. Text is assumed to run to the right, or downwards if the box is 1.5
/// times as high as wide.
std::vector<Detection> decode_db(const DbMap& map, const DbParameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_DB_BOXES_HPP
