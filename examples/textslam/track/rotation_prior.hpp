// Rotation between two frames by aligning their coarsest pyramid levels: the prediction that fast turns need.
//
// The whole image is one text patch on the plane at infinity (theta = 0, H = R), so the library's own kernel aligns it.
// Of an image behind a lens it is the part within 35 degrees of the optical axis.
#ifndef TEXTSLAM_TRACK_ROTATION_PRIOR_HPP
#define TEXTSLAM_TRACK_ROTATION_PRIOR_HPP

#include "textslam/common/parameters.hpp"
#include "textslam/common/rays.hpp"
#include "textslam/input/frame.hpp"

namespace textslam {

struct RotationPrior {
  Eigen::Matrix3d R_b_a = Eigen::Matrix3d::Identity();
  double zncc = -1;  ///< Of the aligned images; -1 where the alignment failed.
};

/// Rotation that takes directions of frame a to frame b, found from `start`.
RotationPrior align_rotation(const Frame& a, const Frame& b, const CameraView& camera, const Eigen::Matrix3d& start,
                             const Parameters& parameters);

/// The same; where the images do not agree well there, other rotations are tried, too.
RotationPrior find_rotation(const Frame& a, const Frame& b, const CameraView& camera, const Eigen::Matrix3d& start,
                            const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_ROTATION_PRIOR_HPP
