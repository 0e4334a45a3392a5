// Points of the map: observations of a new key frame, triangulation of tracks with enough parallax, and culling.
#ifndef TEXTSLAM_MAP_POINT_MAPPER_HPP
#define TEXTSLAM_MAP_POINT_MAPPER_HPP

#include <vector>

#include "textslam/common/parameters.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// Adds a key frame at T_w_c; every inlier track with a point becomes an observation of it, every other track keeps one.
/// Returns its id.
int insert_keyframe(Map& map, const Frame& frame, const SE3d& T_w_c, std::vector<Track>& tracks);

/// Makes points of tracks whose rays have opened by min_parallax and agree within max_reprojection. Returns how many.
int triangulate_tracks(Map& map, const Parameters& parameters, std::vector<Track>& tracks);

/// Adds the observation of `point` in `keyframe` to both.
void add_observation(Map& map, int point, int keyframe, const Vec2& px);

/// Flags a point bad and takes it from the key frames that observe it.
void drop_point(Map& map, int point);

/// Removes the observation of `point` in `keyframe` from both; a point left with fewer than two is flagged bad.
void remove_observation(Map& map, int point, int keyframe);

/// Flags points that are found too rarely, and frees the tracks of bad points.
void cull_points(Map& map, const Parameters& parameters, std::vector<Track>& tracks);

/// How many of the points each key frame observes.
std::vector<int> shared_points(const Map& map, const std::vector<int>& points);

/// Median depth of the points observed by key frame `id`, 0 where it has none.
double median_depth(const Map& map, int id);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_POINT_MAPPER_HPP
