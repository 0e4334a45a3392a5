// The surface that a text lies on, as a page or a board. Beside a small text, map points determine the plane best.
#ifndef TEXTSLAM_TEXT_TEXT_SURFACE_HPP
#define TEXTSLAM_TEXT_TEXT_SURFACE_HPP

#include <vector>

#include "textslam/map/map.hpp"

namespace textslam {

/// A map point in or beside a text, in the frame of the text's host.
struct SurfacePoint {
  Vec3 p = Vec3::Zero();
  double sigma = 0;   ///< Across the plane: of the point and of the relief of the surface there.
  double beside = 0;  ///< Distance from the text, along its plane; 0 within it.
};

/// The map points within surface_reach of a text with a plane, whose observations tell how far they are.
std::vector<SurfacePoint> points_beside(const Map& map, const Parameters& parameters, const TextObject& text);

/// Theta and covariance from what was known and from the points. The surface may be bent about `centre`, the text's, on
/// the plane (surface_bend). Points beyond surface_sigmas are down-weighted (Tukey), by the sigmas of the point and of
/// the plane there. False, and nothing changed, with weights below surface_min_points.
bool fit_to_surface(const std::vector<SurfacePoint>& points, const Vec3& centre, const Parameters& parameters,
                    Vec3* theta, Eigen::Matrix3d* covariance);

/// The same for a text of the map, with the points beside it, if they show a surface that goes through its centre
/// (surface_gap) and has its slant (surface_sigmas). A sign that stands off its wall may be turned from it. A text that
/// hardly knows its own slant (surface_text_sigma) could not contradict a wrong surface, and stays as it was.
void fit_to_surface(const Map& map, const Parameters& parameters, TextObject& text);

/// The same for a text without a plane, by the points alone. False, and nothing changed, where its host sees fewer than
/// surface_min_points or the normal stays less certain than surface_max_sigma.
bool plane_from_surface(const Map& map, const Parameters& parameters, TextObject& text);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_SURFACE_HPP
