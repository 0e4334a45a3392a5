// Relative pose of two views from matches, for planar and general scenes alike.
//
// Gauss-Newton minimises the epipolar (Sampson) distance over rotation and direction of translation, with Huber
// weights, from several starts. Tracks of a video have few outliers and a small rotation, so no minimal solver and no
// random draws are needed. A plane shows as a second minimum of almost the same cost: motion_hypotheses.hpp decides.
#ifndef TEXTSLAM_INIT_TWO_VIEW_HPP
#define TEXTSLAM_INIT_TWO_VIEW_HPP

#include <vector>

#include "textslam/common/geometry.hpp"
#include "textslam/common/parameters.hpp"

namespace textslam {

/// A motion that explains the matches.
struct TwoViewMotion {
  SE3d T_b_a;       ///< |t| = 1.
  double cost = 0;  ///< px^2, sum of the robust epipolar distances.
};

/// Degrees of freedom of the motion.
constexpr double kTwoViewFreedom = 5;

struct TwoView {
  bool ok = false;           ///< A solution with most points in front of both cameras was found.
  SE3d T_b_a;                ///< |t| = 1.
  std::vector<char> inlier;  ///< Per match: epipolar distance of at most init_inlier.
  int inliers = 0;
  double rms = 0;                      ///< px, of the inliers.
  double parallax = 0;                 ///< Degrees, median of the inliers.
  double direction_sigma = 0;          ///< Radians: largest standard deviation of the direction of translation.
  std::vector<TwoViewMotion> motions;  ///< All distinct ones with most points in front, T_b_a's first, then by cost.
};

/// `a`, `b`: normalised homogeneous points of the matches; `focal`: px, the unit of the distances reported.
TwoView estimate_two_view(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double focal,
                          const Parameters& parameters = {});

}  // namespace textslam

#endif  // TEXTSLAM_INIT_TWO_VIEW_HPP
