// The width of a text in the map, from the boxes that the detector drew around it.
//
// The host's box alone errs as one box does. Each key frame that saw the text has a box of its own: all of them, on the
// text's plane, say how wide it is, and how well that is known.
#ifndef TEXTSLAM_TEXT_TEXT_WIDTH_HPP
#define TEXTSLAM_TEXT_TEXT_WIDTH_HPP

#include "textslam/map/map.hpp"

namespace textslam {

struct TextWidth {
  double width = 0;  ///< In the map's unit; 0: not known.
  double sigma = 0;  ///< Standard deviation, by the boxes and by the covariance of the plane.
  int boxes = 0;     ///< That it rests on.
};

/// The mean of the boxes' upper and lower edges on the plane, boxes weighed by their width in px squared. Those that
/// touch the image's border do not count, nor those far off the median.
TextWidth text_width(const Map& map, const Parameters& parameters, const TextObject& text);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_WIDTH_HPP
