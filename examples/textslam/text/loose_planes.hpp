// Loose planes: text planes from map points alone, the paper's comparison for planes that take part in tracking.
//
// A text object lives as in mode `text` (host key frame, quad, detections, votes, n_min; see text_mapper.hpp), but its
// plane is the one that three-point RANSAC finds in the map points that project into its quad, found anew with every
// key frame. No pixel of the text is compared (its zncc stays 0), and poses and points know nothing of it: they are
// those of mode `points`.
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

/// The plane of most of the points p_i = m_i / rho_i of a host frame (m_i = (x, y, 1)). Draws of three points, all of
/// them or loose_draws by a generator of fixed seed, are judged by the truncated squares of the relative depth error
/// theta^T m / rho - 1; the best one's inliers give theta by least squares in inverse depth, twice. The same points in
/// the same order give the same bytes.
LoosePlane fit_loose_plane(const std::vector<Vec3>& m, const std::vector<double>& rho, const Parameters& parameters);

/// After key frame `id` was added and adjusted: planes, observations, promotion and dropping of all text objects. A key
/// frame observes a text where it shows the whole quad and loose_seen_points of the plane's points were tracked in it.
void update_loose_planes(Map& map, const Parameters& parameters, int id);

/// After poses and points changed: the planes of the points as they are now. One that no longer has enough stays.
void refresh_loose_planes(Map& map, const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_LOOSE_PLANES_HPP
