// How a text of the map looks from a camera: its quad, slant and scale. T_c_w is the camera's world-to-camera pose.
#ifndef TEXTSLAM_MAP_TEXT_GEOMETRY_HPP
#define TEXTSLAM_MAP_TEXT_GEOMETRY_HPP

#include "textslam/map/map.hpp"

namespace textslam {

/// The text's quad as seen by the camera; false where a corner is behind it.
bool project_text(const Map& map, const TextObject& text, const SE3d& T_c_w, Quad<double>* quad);

/// Cosine of the angle between the text's normal and the ray to its centre; positive where the camera sees its front.
double facing(const Map& map, const TextObject& text, const SE3d& T_c_w);

/// The slant test, for the cosine that facing() returns.
bool is_too_slanted(const Parameters& parameters, double facing);

/// As project_text(), and whether the camera sees enough of the text's front to compare it with the host: not too
/// slanted, at least `min_area` px^2, and `min_share` of it inside the image (1: the whole quad, off the border).
bool is_in_view(const Map& map, const Parameters& parameters, const TextObject& text, const SE3d& T_c_w,
                double min_area, double min_share, Quad<double>* quad);

/// The same as tracking asks for it: by text_min_area and text_min_share.
bool text_in_view(const Map& map, const Parameters& parameters, const TextObject& text, const SE3d& T_c_w,
                  Quad<double>* quad);

/// Does the plane lie in front of its host, not too slanted, over the whole quad?
bool is_plausible_plane(const Map& map, const Parameters& parameters, const Quad<double>& quad, const Vec3& theta);

/// Which pyramid levels of host and view show the text at one scale, for its quad in the view: see photometric_input().
int scale_shift(const TextObject& text, const Quad<double>& quad);

/// Largest standard deviation of the direction of a text's normal n = -theta / |theta|, radians.
double normal_sigma(const TextObject& text);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_TEXT_GEOMETRY_HPP
