// Pose and plane of one object in one image as a problem for tp::minimise().
#ifndef TEXTPLANE_EXAMPLES_POSE_PLANE_PROBLEM_HPP
#define TEXTPLANE_EXAMPLES_POSE_PLANE_PROBLEM_HPP

#include "textplane/photometry/residual.hpp"
#include "textplane/solver/gauss_newton.hpp"

namespace planar {

namespace tp = textplane;

/// Pose T_t_h and plane theta (host frame) of an object in one image.
struct PlaneState {
  tp::SE3d T_t_h;
  tp::Vector3<double> theta = tp::Vector3<double>::UnitZ();
};

/// Pose and plane as a problem for tp::minimise(): nine parameters (v, omega, theta), some with a prior at the start.
class PosePlaneProblem {
 public:
  using State = PlaneState;
  static constexpr int kParameters = 9;

  /// `from`: the mean of the priors on rotation and theta, with these weights.
  PosePlaneProblem(const tp::PhotometricInput& input, const State& from, double turn, double plane,
                   const tp::PhotometricOptions& options, tp::PhotometricWorkspace& workspace)
      : input_(input), from_(from), options_(options), workspace_(workspace) {
    weight_ << 0, 0, 0, turn, turn, 0, plane, plane, plane;
  }

  tp::NormalEquations<9> linearise(const State& x) noexcept {
    auto sums =
        tp::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{input_, x.theta, x.T_t_h, options_}, workspace_);
    const Eigen::Matrix<double, 9, 1> off = distance(x);
    sums.H.diagonal() += weight_;
    sums.b += weight_.cwiseProduct(off);
    sums.cost += off.dot(weight_.cwiseProduct(off));
    return sums;
  }
  tp::Evaluation evaluate(const State& x) noexcept {
    const auto c =
        tp::evaluate(tp::ResidualRequest{input_, x.theta, x.T_t_h, options_}, workspace_, workspace_.visible());
    const Eigen::Matrix<double, 9, 1> off = distance(x);
    return {c.cost + off.dot(weight_.cwiseProduct(off)), static_cast<double>(c.lost) / input_.patch.n, c.status};
  }
  State retract(const State& x, const Eigen::Matrix<double, 9, 1>& step) const noexcept {
    return {tp::se3_exp<double>(step.head<6>()) * x.T_t_h, x.theta + step.tail<3>()};
  }

 private:
  Eigen::Matrix<double, 9, 1> distance(const State& x) const noexcept {
    Eigen::Matrix<double, 9, 1> off;
    off << tp::Vector3<double>::Zero(), tp::so3_log<double>(x.T_t_h.R * from_.T_t_h.R.transpose()),
        x.theta - from_.theta;
    return off;
  }

  const tp::PhotometricInput& input_;
  const State from_;
  const tp::PhotometricOptions& options_;
  tp::PhotometricWorkspace& workspace_;
  Eigen::Matrix<double, 9, 1> weight_;
};

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_POSE_PLANE_PROBLEM_HPP
