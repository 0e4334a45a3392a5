// Text boxes from the map of a DB network (Liao et al., AAAI 2020): the probability that a pixel is the core of a text.
#ifndef TEXTSLAM_DETECTORS_DB_BOXES_HPP
#define TEXTSLAM_DETECTORS_DB_BOXES_HPP

#include <opencv2/core/mat.hpp>
#include <vector>

#include "io/detections.hpp"

namespace textslam {

struct DbParameters {
  double min_probability = 0.3;  ///< Of a pixel of a core.
  double min_score = 0.6;        ///< Mean probability of a box.
  double unclip = 1.5;           ///< A core grows by this share of its area over its perimeter.
  double min_side = 3;           ///< px of the map, before it grows.
};

/// `probability`: CV_32F. Boxes in px of the map, rectangles of least area around the cores and grown; along the text, which
/// is taken to run to the right, or downwards where the box is half as high again as it is wide. In the order of OpenCV's contours.
std::vector<Detection> decode_db(const cv::Mat& probability, const DbParameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_DB_BOXES_HPP
