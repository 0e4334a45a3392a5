// The centre of a text in the world, and how well it is known: along the ray by the covariance of the plane, across it
// by the detector's box in the host, whose corners err by some pixels.
#ifndef TEXTSLAM_TEXT_TEXT_CENTRE_HPP
#define TEXTSLAM_TEXT_TEXT_CENTRE_HPP

#include "textslam/map/map.hpp"

namespace textslam {

struct TextCentre {
  Vec3 at = Vec3::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Vec3 in_host = Vec3::Zero();  ///< In the camera of the host.
  double corner_px = 0;         ///< Standard deviation of a corner of the box.
};

/// Standard deviation of a text's distance from its host, as a share. Of a text that has a plane, as what follows.
double distance_sigma(const TextObject& text);

TextCentre text_centre(const Map& map, const TextObject& text);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_CENTRE_HPP
