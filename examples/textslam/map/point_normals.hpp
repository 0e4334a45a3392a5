// Normals of the surfaces that map points lie on, by their neighbours in an image.
//
// A patch that is seen again from elsewhere is warped by the plane of its surface. A narrow camera sees most surfaces
// nearly from the front, and a plane parallel to the image does. A wide one sees walls, floor and ceiling at a slant.
#ifndef TEXTSLAM_MAP_POINT_NORMALS_HPP
#define TEXTSLAM_MAP_POINT_NORMALS_HPP

#include "textslam/map/map.hpp"

namespace textslam {

/// In wide views (wide_view.hpp), renews MapPoint::normal_w of the points that a key frame sees; else does nothing. The
/// plane goes through the point; its neighbours within normal_reach say how it is slanted, each by its inverse
/// distance, and those off the surface are left out (Tukey's weights). A prior says that it faces the camera: it
/// decides where there are no neighbours.
void fit_point_normals(Map& map, const Parameters& parameters, int keyframe);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_POINT_NORMALS_HPP
