// Code that must not compile. compile_failures.cmake looks for the text after "expected:" in the errors.
#include "textplane/adapters/sophus.hpp"
#include "textplane/photometry/residual.hpp"

namespace tp = textplane;

// expected: textplane: a camera of integers
auto camera() { return tp::Pinhole(500, 500, 320, 240); }

// expected: textplane: a pose of integers
tp::SE3<int> pose;

// expected: textplane: target images are 8-bit or float
tp::BasicPhotometricInput<double> input;

// expected: textplane: residuals\(\) are by pose, plane, or pose_plane
void world(const tp::PhotometricInput& in, tp::PhotometricWorkspace& workspace, double* r) {
  tp::reference::residuals<tp::Parameters::host_target_plane>(tp::ResidualRequest{in, {0, 0, 1}, tp::SE3d()}, workspace,
                                                              r, nullptr);
}

// expected: textplane: the pose has neither rotationMatrix\(\) nor so3\(\).matrix\(\)
struct Bare {
  using Scalar = double;
};
auto bare() { return tp::adapters::from_sophus(Bare()); }

// expected: textplane: the pose cannot be made of a quaternion and a translation
auto made() { return tp::adapters::to_sophus<Bare>(tp::SE3d()); }
