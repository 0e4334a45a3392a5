// Loose planes: text planes from map points alone, the paper's comparison for planes that take part in tracking.
//
// A text lives as in mode `text` (text_mapper.hpp), but every key frame finds its plane anew by three-point RANSAC over
// the map points in its quad. No pixel is compared (zncc stays 0); poses and points are those of mode `points`.
#ifndef TEXTSLAM_TEXT_LOOSE_PLANES_HPP
#define TEXTSLAM_TEXT_LOOSE_PLANES_HPP

#include <vector>

#include "textslam/map/map.hpp"

namespace textslam {

struct LoosePlane {
  bool ok = false;  ///< At least loose_min_points inliers, and loose_min_share of the points.
  Vec3 theta = Vec3::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::vector<int> inliers;  ///< Indices, rising.
};

/// The plane of most of the points p_i = m_i / rho_i of a host frame (m_i = (x, y, 1)). Draws of three points (fixed
/// seed) are judged by the truncated squares of theta^T m / rho - 1; the best one's inliers give theta by least
/// squares.
LoosePlane fit_loose_plane(const std::vector<Vec3>& m, const std::vector<double>& rho, const Parameters& parameters);

/// After key frame `id` was adjusted: planes, observations and states of all texts. A key frame observes a text where
/// it shows the whole quad and tracked loose_seen_points of the plane's points.
void update_loose_planes(Map& map, const Parameters& parameters, int id);

/// After poses and points changed: the planes of the points as they are now. One that no longer has enough stays.
void refresh_loose_planes(Map& map, const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_LOOSE_PLANES_HPP
