// From tracks to points of the map: observations of a new key frame, and triangulation.
#ifndef TEXTSLAM_TRACK_POINT_MAPPER_HPP
#define TEXTSLAM_TRACK_POINT_MAPPER_HPP

#include "textslam/track/track.hpp"

namespace textslam {

/// Adds a key frame, and an observation of each inlier track to its point, else to the track. Returns its id.
int insert_keyframe(Map& map, const Frame& frame, const SE3d& T_w_c, std::vector<Track>& tracks);

/// Makes points of tracks with enough parallax (degrees) that agree within max_reprojection. Returns how many.
int triangulate_tracks(Map& map, const Parameters& parameters, double min_parallax, std::vector<Track>& tracks);

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_POINT_MAPPER_HPP
