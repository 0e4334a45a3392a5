// Where one photograph lies in another by the same camera that hardly moved, whatever the light: what trials take for
// the truth.
//
// None of textplane takes part, so that the truth does not lean to one aligner: corners of OpenCV, each with the square
// round it found in the other photograph by exhaustive correlation there and back, and one similarity through all that
// agree.
#ifndef TEXTPLANE_EXAMPLES_REGISTRATION_HPP
#define TEXTPLANE_EXAMPLES_REGISTRATION_HPP

#include <opencv2/core.hpp>
#include <vector>

#include "textplane/core/numeric.hpp"

namespace planar {

namespace tp = textplane;

/// A similarity (px of one photograph to px of another) and how far it can be trusted.
struct Registration {
  tp::Matrix3<double> H = tp::Matrix3<double>::Identity();
  int matches = 0;      ///< That agree to half a pixel.
  double residual = 0;  ///< px: their mean distance.
};

/// Registers photographs that were compared with their surroundings once: compare() of each. Throws std::runtime_error
/// where fewer than a dozen matches are found.
Registration register_still(const cv::Mat& first, const cv::Mat& other);

/// A grey photograph with the mean of its surroundings taken away and divided by their deviation.
cv::Mat compare(const cv::Mat& grey);

/// Mean and largest difference, px, at points between the registration 0 to j and that by way of i, over all pairs i <
/// j: from[i][j].
struct Consistency {
  double mean = 0, largest = 0;
};
Consistency round_trips(const std::vector<std::vector<Registration>>& from, const std::vector<cv::Point2d>& points);

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_REGISTRATION_HPP
