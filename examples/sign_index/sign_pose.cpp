#include "sign_index/sign_pose.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "textplane/core/numeric.hpp"

namespace textslam {
namespace {

constexpr int kSteps = 5;
constexpr double kNear = 1e-3;  // of the distance: nearer to the camera's plane a corner says nothing
using Rows = Eigen::Matrix<double, 2, 6>;

bool project(const Vec3& p, Vec2* at, Rows* J) {
  if (!(p.z() > kNear * p.norm())) return false;
  const double iz = 1 / p.z(), u = p.x() * iz, v = p.y() * iz;
  *at = {u, v};
  // de / dxi of p + v + omega x p.
  *J << iz, 0, -u * iz, -u * v, 1 + u * u, -v, 0, iz, -v * iz, -1 - v * v, u * v, u;
  return true;
}

// Adds the tilt of the camera, u = R up, which is (0, -1, 0) when upright; du = omega x u.
void add_tilt(const Upright& upright, const SE3d& T_c_w, double sigma, Matrix6* H, Vector6* b, double* cost) {
  const Vec3 u = T_c_w.R * upright.up;
  Rows J = Rows::Zero();
  J.rightCols<3>() << 0, u.z(), -u.y(), u.y(), -u.x(), 0;
  const Vec2 weight(sigma / upright.roll, sigma / upright.pitch);
  J = weight.asDiagonal() * J;
  const Vec2 e(weight[0] * u.x(), weight[1] * u.z());
  H->noalias() += J.transpose() * J;
  b->noalias() += J.transpose() * e;
  *cost += e.squaredNorm();
}

struct Problem {
  const std::vector<SeenSign>& seen;
  double sigma;
  const std::optional<Upright>& upright;
};

// Normal equations at T; false where a corner is not in front.
bool linearise(const Problem& problem, const SE3d& T_c_w, Matrix6* H, Vector6* b, double* cost) {
  H->setZero();
  b->setZero();
  *cost = 0;
  for (const SeenSign& sign : problem.seen)
    for (std::size_t k = 0; k < 4; ++k) {
      Vec2 at;
      Rows J;
      if (!project(T_c_w * sign.corners[k], &at, &J)) return false;
      const Vec2 e = at - sign.quad.corner[k];
      H->noalias() += J.transpose() * J;
      b->noalias() += J.transpose() * e;
      *cost += e.squaredNorm();
    }
  if (problem.upright) add_tilt(*problem.upright, T_c_w, problem.sigma, H, b, cost);
  return true;
}

}  // namespace

bool refine_sign_pose(const std::vector<SeenSign>& seen, double sigma, const std::optional<Upright>& upright,
                      SignPose* pose) {
  const Problem problem{seen, sigma, upright};
  Matrix6 H, H_trial;
  Vector6 b, b_trial;
  double cost, cost_trial, damping = 1e-6;
  if (!linearise(problem, pose->T_c_w, &H, &b, &cost)) return false;
  for (int step = 0; step < kSteps; ++step) {
    Matrix6 damped = H;
    damped.diagonal() *= 1 + damping;
    const textplane::Ldlt<double, 6> factors(damped);
    if (!factors.ok()) return false;
    const SE3d trial = textplane::se3_exp<double>(-factors.solve(b)) * pose->T_c_w;
    if (linearise(problem, trial, &H_trial, &b_trial, &cost_trial) && cost_trial <= cost) {
      const bool done = cost - cost_trial < 1e-2 * sigma * sigma;
      pose->T_c_w = trial;
      H = H_trial;
      b = b_trial;
      cost = cost_trial;
      damping *= 0.1;
      if (done) break;
    } else {
      damping = std::max(1e-4, 30 * damping);
    }
  }
  pose->T_c_w = textplane::renormalised(pose->T_c_w);
  const Matrix6 information = H / (sigma * sigma);
  const Eigen::LLT<Matrix6> factors(information);
  if (factors.info() != Eigen::Success) return false;
  pose->covariance = factors.solve(Matrix6::Identity());
  pose->log_volume = 0;
  for (int i = 0; i < 6; ++i) pose->log_volume -= std::log(factors.matrixL()(i, i));
  pose->chi2 = cost / (sigma * sigma);
  return std::isfinite(pose->log_volume) && std::isfinite(pose->chi2);
}

bool view_of_centre(const SignPose& pose, const Vec3& centre, CentreView* view) {
  Rows J;
  if (!project(pose.T_c_w * centre, &view->at, &J)) return false;
  view->covariance = J * pose.covariance * J.transpose();
  return true;
}

}  // namespace textslam
