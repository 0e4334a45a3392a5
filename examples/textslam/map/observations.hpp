// Observations: which key frame sees which point. Both store it; these functions keep the two consistent.
#ifndef TEXTSLAM_MAP_OBSERVATIONS_HPP
#define TEXTSLAM_MAP_OBSERVATIONS_HPP

#include <vector>

#include "textslam/map/map.hpp"

namespace textslam {

/// Adds the observation of `point` in `keyframe` to both.
void add_observation(Map& map, int point, int keyframe, const Vec2& px);

/// Removes the observation of `point` in `keyframe` from both; a point left with fewer than two is flagged bad.
void remove_observation(Map& map, int point, int keyframe);

/// Flags a point bad and removes it from the key frames that observe it.
void drop_point(Map& map, int point);

/// Where key frame `keyframe` observes the point; null where it does not.
const Vec2* observed_in(const std::vector<PointObservation>& observations, int keyframe);

/// How many of the points each key frame observes.
std::vector<int> shared_points(const Map& map, const std::vector<int>& points);

/// px, rms over all observations of the points: how well the map explains where it was seen. 0 without points.
double reprojection_error(const Map& map);

/// Median depth of the points observed by key frame `id`, 0 where it has none.
double median_depth(const Map& map, int id);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_OBSERVATIONS_HPP
