// Wall: what a sign says of a place where another one on the same wall is known already.
//
// Signs hang on walls everywhere. A place that is not the one looked for has walls with signs beside each other, too:
// there the second quad is no quad anywhere in the image, but a rectangle on the wall of the first. That has four
// numbers (position along the wall and across it, width, height), not the eight of four corners.
#ifndef TEXTSLAM_SIGN_INDEX_WALL_HPP
#define TEXTSLAM_SIGN_INDEX_WALL_HPP

#include <array>

#include "textslam/common/geometry.hpp"

namespace textslam {

/// Corners of a sign in the map's frame, clockwise as readers see them.
using SignCorners = std::array<Vec3, 4>;

/// Unit normal, towards the reader.
Vec3 sign_normal(const SignCorners& corners);

/// Do both lie in one plane and face the same way, to a tenth of their distance and to 10 degrees?
bool on_one_wall(const SignCorners& a, const SignCorners& b);

struct WallView {
  SE3d T_c_w;
  double sigma;   ///< Of each coordinate of a detected corner, normalised.
  double missed;  ///< PlaceOptions::missed
  double reach;   ///< SignIndex::reach()
};

/// Nats by which a sign that falls exactly there is likelier than another rectangle on its wall:
///
///   log (1 - missed) / m - log p(x, y, w, h) + log sqrt(det J^T J) - 2 log(2 pi sigma^2)
///
/// J is the derivative of the corners' eight coordinates by the rectangle's four numbers, m the mean number of other
/// signs on a wall, p their density: even along the wall and across it, and in the logarithm of width and height. The
/// sign has to be in front of the camera.
double log_wall_peak(const SignCorners& corners, const WallView& view);

}  // namespace textslam

#endif  // TEXTSLAM_SIGN_INDEX_WALL_HPP
