// ORB key points all over the image, and matches between them: by projection, by descriptors, along epipolar lines.
#ifndef FOREIGN_TRACKER_MATCHER_HPP
#define FOREIGN_TRACKER_MATCHER_HPP

#include <cstddef>
#include <opencv2/features2d.hpp>
#include <utility>
#include <vector>

#include "foreign_tracker/map.hpp"

namespace foreign {

using Matches = std::vector<std::pair<std::size_t, std::size_t>>;  // key points of one frame and of another

/// Key points, descriptors and cells of frame.image: the strongest corners of every cell of a grid, as in ORB-SLAM.
void extract(const Camera& camera, Frame& frame);

/// Gives key points without a point the points of `points` that project near them (within `radius` px times the scale
/// of the level) and look alike: at most `distance` bits apart and `ratio` times the second best. Points that the frame
/// has already are left out. Returns how many.
int match_by_projection(const Camera& camera, const std::vector<MapPoint*>& points, double radius, int distance,
                        double ratio, Frame& frame);

/// The key point of `frame` that fits the point best by these rules, with or without a point; -1: none.
int best_key(const Camera& camera, const MapPoint& point, double radius, int distance, double ratio,
             const Frame& frame);

/// Mutual nearest neighbours by descriptor. `with_points`: only key points of `a` that have points.
Matches match_by_descriptor(const Frame& a, const Frame& b, bool with_points, double ratio);

/// Mutual matches of key points without points that lie on each other's epipolar lines.
Matches match_along_lines(const Camera& camera, const Frame& a, const Frame& b);

}  // namespace foreign

#endif  // FOREIGN_TRACKER_MATCHER_HPP
