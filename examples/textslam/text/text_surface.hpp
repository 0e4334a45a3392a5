// The surface that a text lies on: a page, a cover or a board is larger than its words, and where these are small, little is
// known of their plane alone. The map points in and beside a text tell more of it, those that keep to the plane.
#ifndef TEXTSLAM_TEXT_TEXT_SURFACE_HPP
#define TEXTSLAM_TEXT_TEXT_SURFACE_HPP

#include <vector>

#include "textslam/common/parameters.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// A map point in or beside a text, in the frame of the text's host.
struct SurfacePoint {
  Vec3 p = Vec3::Zero();
  double sigma = 0;  ///< Across the plane: of the point, and of how far the surface may be off the plane there.
};

/// The map points within surface_reach of a text with a plane, whose observations tell how far they are.
std::vector<SurfacePoint> points_beside(const Map& map, const Parameters& parameters, const TextObject& text);

/// Theta and covariance by what was known of them and by the points together. `centre`: of the text, on the plane, about which the
/// surface may be bent (surface_bend). A point that is farther off the plane than its sigma and that of the plane at its place
/// explain counts for less, or not at all. False, and nothing changed, where less than surface_min_points count.
bool fit_to_surface(const std::vector<SurfacePoint>& points, const Vec3& centre, const Parameters& parameters,
                    Vec3* theta, Eigen::Matrix3d* covariance);

/// The same for a text of the map, with the points beside it.
void fit_to_surface(const Map& map, const Parameters& parameters, TextObject& text);

/// Theta and covariance by the points alone, for a text that has no plane yet. False, and nothing changed, where its host sees less
/// than surface_min_points in and beside it, or where they leave its normal unknown (surface_max_sigma).
bool plane_from_surface(const Map& map, const Parameters& parameters, TextObject& text);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_SURFACE_HPP
