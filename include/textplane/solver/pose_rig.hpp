// Several cameras on one rig: what refine_pose() takes in place of one camera and its image.
//
// The unknown is the pose T_r_w of the rig, perturbed as that of one camera: T_r_w <- Exp(xi) T_r_w. Camera c has the
// pose T_c_w = T_r_c^-1 T_r_w, so it moves by Exp(A xi) with A = Ad(T_r_c^-1), and normal equations by its own pose
// become those by the rig's: H_r = A^T H_c A, b_r = A^T b_c.
#ifndef TEXTPLANE_SOLVER_POSE_RIG_HPP
#define TEXTPLANE_SOLVER_POSE_RIG_HPP

#include "textplane/core/cameras/camera_view.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/solver/levels.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A camera of a rig and the image it took. View is PyramidView or PyramidViewF.
template <class View>
struct BasicPoseCamera {
  CameraView camera;  ///< Of level 0, with its lens where the image is not undistorted.
  SE3d T_r_c;         ///< Camera to rig, held: the extrinsic calibration.
  View target;        ///< The image; may have no level where no text names this camera.
};
using PoseCamera = BasicPoseCamera<PyramidView>;    ///< Of an 8-bit image.
using PoseCameraF = BasicPoseCamera<PyramidViewF>;  ///< Of a float image.

namespace detail {
// Adds what a camera measured, `seen` by its own pose with all of H, to `system` by the rig's pose.
template <class System>
void add_moved(const System& seen, const SE3d& T_c_r, System& system) noexcept {
  const FixedMatrix<double, 6, 6> A = adjoint(T_c_r), HA = product(seen.H, A);
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) system.b[i] += A(k, i) * seen.b[k];
    for (int j = 0; j <= i; ++j)
      for (int k = 0; k < 6; ++k) system.H(i, j) += A(k, i) * HA(k, j);
  }
  system.cost += seen.cost;
}
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_POSE_RIG_HPP
