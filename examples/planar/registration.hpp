// Registration of two photographs by a camera that hardly moved, under any light: the truth of the trials.
//
// It uses nothing of textplane, so that the truth favours no aligner. Exhaustive correlation, forward and backward,
// finds the square round each OpenCV corner in the other photograph; one similarity is fitted to all matches that
// agree.
#ifndef TEXTPLANE_EXAMPLES_REGISTRATION_HPP
#define TEXTPLANE_EXAMPLES_REGISTRATION_HPP

#include <opencv2/core.hpp>
#include <vector>

#include "textplane/core/numeric.hpp"

namespace planar {

namespace tp = textplane;

/// A similarity (px of one photograph to px of another) and its precision.
struct Registration {
  tp::Matrix3<double> H = tp::Matrix3<double>::Identity();
  int matches = 0;      ///< Matches that agree to half a pixel.
  double residual = 0;  ///< px: their mean distance.
};

/// Registers photographs that were normalised by compare(). Throws std::runtime_error for fewer than a dozen matches.
Registration register_still(const cv::Mat& first, const cv::Mat& other);

/// A grey photograph minus the mean of its surroundings, divided by their deviation.
cv::Mat compare(const cv::Mat& grey);

/// Mean and largest difference, px at the points, between the registration 0 to j and that by way of i, over all pairs
/// i < j: from[i][j].
struct Consistency {
  double mean = 0, largest = 0;
};
Consistency round_trips(const std::vector<std::vector<Registration>>& from, const std::vector<cv::Point2d>& points);

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_REGISTRATION_HPP
