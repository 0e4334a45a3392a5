#include "textslam/track/rotation_prior.hpp"

#include "textplane/photometry/residual.hpp"

namespace textslam {
namespace {

constexpr double kDamping = 1.0001;    // of the diagonal: keeps the system regular
constexpr double kSettledTurn = 1e-5;  // radians

}  // namespace

RotationPrior align_rotation(const Frame& a, const Frame& b, const Pinhole<double>& camera,
                             const Eigen::Matrix3d& start, const Parameters& parameters) {
  const int level = std::min(a.image->levels(), b.image->levels()) - 1;
  const textplane::ImageView8 from = a.image->level(level), to = b.image->level(level);
  textplane::PatchLevel patch;
  const int step = parameters.rotation_pixel_step;
  for (int y = 1; y + 1 < from.height(); y += step)
    for (int x = 1; x + 1 < from.width(); x += step) {
      patch.x.push_back(static_cast<float>(x));
      patch.y.push_back(static_cast<float>(y));
      patch.intensity.push_back(static_cast<float>(from(x, y)));
    }
  textplane::PhotometricWorkspace workspace;
  workspace.reserve(patch.view().n);
  const Pinhole<double> level_camera = camera.at_level(level);
  const textplane::PhotometricInput input{patch.view(), level_camera, level_camera, to};
  textplane::PhotometricOptions options;
  const Vec3 far_plane(0, 0, 1e-9);  // with t = 0 any plane in front of the camera is the plane at infinity

  RotationPrior prior;
  prior.R_b_a = start;
  double best_cost = 0;
  Eigen::Matrix3d R = start;
  for (int iteration = 0; iteration < parameters.rotation_iterations; ++iteration) {
    const auto eq = textplane::linearise<textplane::Parameters::pose>(
        textplane::ResidualRequest{input, far_plane, SE3d{R, Vec3::Zero()}, options}, workspace);
    if (!textplane::is_ok(eq.status) || eq.visible < parameters.rotation_min_overlap * patch.view().n) break;
    if (iteration > 0 && eq.cost >= best_cost) break;
    best_cost = eq.cost;
    prior.R_b_a = R;
    prior.zncc = eq.zncc;
    Eigen::Matrix3d H = eq.H.bottomRightCorner<3, 3>();
    H.diagonal() *= kDamping;
    const textplane::Ldlt<double, 3> ldlt(H);
    if (!ldlt.ok()) break;
    const Vec3 turn = -ldlt.solve(eq.b.tail<3>());
    R = textplane::so3_exp(turn) * R;
    if (turn.norm() < kSettledTurn) break;
  }
  return prior;
}

}  // namespace textslam
