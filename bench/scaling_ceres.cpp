#include "scaling_ceres.hpp"

#include <ceres/ceres.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "stopwatch.hpp"
#include "textplane/photometry/residual.hpp"

namespace textplane_bench {

namespace {

// A pose is (t, quaternion x y z w). Cost functions write derivatives by xi of T Exp(xi) into the first six of its seven
// columns, so that the Jacobian of the manifold is a plain selection.
constexpr int kPose = 7;
using Pose = std::array<double, kPose>;

tp::SE3d to_se3(const double* pose) {
  tp::SE3d T;
  T.t = Eigen::Map<const tp::Vector3<double>>(pose);
  T.R = Eigen::Map<const Eigen::Quaterniond>(pose + 3).toRotationMatrix();
  return T;
}

void from_se3(const tp::SE3d& T, double* pose) {
  Eigen::Map<tp::Vector3<double>>{pose} = T.t;
  Eigen::Map<Eigen::Quaterniond>{pose + 3} = Eigen::Quaterniond(T.R).normalized();
}

class RightPerturbation : public ceres::Manifold {
 public:
  int AmbientSize() const override { return kPose; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* out) const override {
    from_se3(to_se3(x) * tp::se3_exp<double>(Eigen::Map<const tp::Vector6<double>>(delta)), out);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, kPose, 6, Eigen::RowMajor>>{jacobian}.setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* out) const override {
    Eigen::Map<tp::Vector6<double>>{out} = tp::se3_log(to_se3(x).inverse() * to_se3(y));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, kPose, Eigen::RowMajor>>{jacobian}.setIdentity();
    return true;
  }
};

template <int Rows>
void write_pose_rows(const Eigen::Matrix<double, Rows, 6>& J, double* out) {
  Eigen::Map<Eigen::Matrix<double, Rows, kPose, Eigen::RowMajor>> rows(out);
  rows.template leftCols<6>() = J;
  rows.template rightCols<1>().setZero();
}

class PointCost : public ceres::SizedCostFunction<2, kPose, 3> {
 public:
  PointCost(const tp::Pinhole<double>& camera, const tp::WindowPointObservation& o)
      : camera_(camera), px_(o.px), scale_(1 / o.sigma) {}

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const tp::SE3d T = to_se3(parameters[0]);
    const tp::Vector3<double> p = T.R.transpose() * (Eigen::Map<const tp::Vector3<double>>(parameters[1]) - T.t);
    if (!(p[2] > 1e-6)) return false;
    Eigen::Matrix<double, 2, 3> J;
    Eigen::Map<tp::Vector2<double>>{residuals} = scale_ * (camera_.project(p, &J) - px_);
    if (!jacobians) return true;
    J *= scale_;
    if (jacobians[0]) {
      Eigen::Matrix<double, 2, 6> pose;
      pose << -J, J * tp::hat(p);
      write_pose_rows<2>(pose, jacobians[0]);
    }
    if (jacobians[1]) Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>{jacobians[1]} = J * T.R.transpose();
    return true;
  }

 private:
  const tp::Pinhole<double> camera_;
  const tp::Vector2<double> px_;
  const double scale_;
};

// J = L^T and r = L^-1 b of the semi-definite H = L L^T: pose and plane share a scale, so that one pivot is rounding.
void square_root(const Eigen::Matrix<double, 9, 9>& H, const Eigen::Matrix<double, 9, 1>& b,
                 Eigen::Matrix<double, 9, 9>* J, Eigen::Matrix<double, 9, 1>* r) {
  constexpr double kRounding = 1e-6;
  J->setZero();
  r->setZero();
  for (int k = 0; k < 9; ++k) {
    double pivot = H(k, k), rest = b[k];
    for (int m = 0; m < k; ++m) {
      pivot -= (*J)(m, k) * (*J)(m, k);
      rest -= (*J)(m, k) * (*r)[m];
    }
    if (!(pivot > kRounding * H(k, k))) continue;
    (*J)(k, k) = std::sqrt(pivot);
    (*r)[k] = rest / (*J)(k, k);
    for (int c = k + 1; c < 9; ++c) {
      double s = H(k, c);
      for (int m = 0; m < k; ++m) s -= (*J)(m, k) * (*J)(m, c);
      (*J)(k, c) = s / (*J)(k, k);
    }
  }
}

class TextCost : public ceres::SizedCostFunction<10, kPose, kPose, 3> {
 public:
  TextCost(const tp::PhotometricInput& input, double weight, const tp::WindowOptions& options,
           tp::PhotometricWorkspace& workspace)
      : input_(input), weight_(weight), options_(options), workspace_(workspace) {}

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const tp::SE3d T = to_se3(parameters[1]).inverse() * to_se3(parameters[0]);
    const tp::Vector3<double> theta = Eigen::Map<const tp::Vector3<double>>(parameters[2]);
    Eigen::Map<Eigen::Matrix<double, 10, 1>> out(residuals);
    if (!jacobians) {
      const tp::PhotometricCost cost = tp::evaluate(input_, theta, T, options_.photometric, workspace_);
      out.setZero();
      out[9] = factor(cost.visible) * std::sqrt(cost.cost);
      return tp::is_ok(cost.status);
    }
    const tp::NormalEquations<9> sums = tp::linearise_pose_plane(input_, theta, T, options_.photometric, workspace_);
    if (!tp::is_ok(sums.status)) return false;
    Eigen::Matrix<double, 9, 9> J;
    Eigen::Matrix<double, 9, 1> r;
    square_root(sums.H, sums.b, &J, &r);
    const double scale = factor(sums.visible);
    J *= scale;
    out.head<9>() = scale * r;
    out[9] = scale * std::sqrt(std::max(sums.cost - r.squaredNorm(), 0.0));
    const Eigen::Matrix<double, 9, 6> by_pose = J.leftCols<6>();
    if (jacobians[0]) write_pose_rows<10>(padded<6>(by_pose * tp::adjoint(T)), jacobians[0]);
    if (jacobians[1]) write_pose_rows<10>(padded<6>(-by_pose), jacobians[1]);
    if (jacobians[2])
      Eigen::Map<Eigen::Matrix<double, 10, 3, Eigen::RowMajor>>{jacobians[2]} = padded<3>(J.rightCols<3>());
    return true;
  }

 private:
  double factor(int visible) const {
    return std::sqrt(weight_ * tp::text_weight(options_.weighting, options_.sigma_rep, options_.sigma_photo, visible));
  }
  template <int Columns>
  static Eigen::Matrix<double, 10, Columns> padded(const Eigen::Matrix<double, 9, Columns>& J) {
    Eigen::Matrix<double, 10, Columns> out;
    out << J, Eigen::Matrix<double, 1, Columns>::Zero();
    return out;
  }

  const tp::PhotometricInput input_;
  const double weight_;
  const tp::WindowOptions& options_;
  tp::PhotometricWorkspace& workspace_;
};

ceres::Solver::Options ceres_options(const tp::WindowOptions& o, CeresSolver solver) {
  ceres::Solver::Options out;
  out.linear_solver_type = solver == CeresSolver::sparse_schur ? ceres::SPARSE_SCHUR : ceres::DENSE_SCHUR;
  out.max_num_iterations = o.max_iterations;
  out.function_tolerance = o.cost_tolerance;
  out.gradient_tolerance = 0;  // Has no counterpart in solve_window().
  out.parameter_tolerance = o.step_tolerance;
  out.initial_trust_region_radius = 1 / o.initial_lambda;
  out.num_threads = 1;
  out.logging_type = ceres::SILENT;
  return out;
}

}  // namespace

CeresResult solve_with_ceres(tp::Window& w, const tp::WindowOptions& o, CeresSolver solver) {
  const Stopwatch building;
  int longest = 0;
  std::vector<Pose> poses(w.frames.size());
  for (std::size_t f = 0; f < poses.size(); ++f) from_se3(w.frames[f].T_w_c, poses[f].data());
  for (const tp::WindowText& t : w.texts) longest = std::max(longest, t.patch->max_pixels());
  tp::PhotometricWorkspace workspace(longest);

  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.disable_all_safety_checks = true;
  RightPerturbation manifold;
  ceres::HuberLoss huber(o.point_robust.delta);
  ceres::Problem problem(ownership);
  ceres::Solver::Options options = ceres_options(o, solver);
  options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t f = 0; f < poses.size(); ++f) {
    problem.AddParameterBlock(poses[f].data(), kPose, &manifold);
    if (w.frames[f].fixed) problem.SetParameterBlockConstant(poses[f].data());
    options.linear_solver_ordering->AddElementToGroup(poses[f].data(), 1);
  }
  for (const tp::WindowPointObservation& k : w.point_observations)
    problem.AddResidualBlock(new PointCost(w.camera, k), &huber, poses[static_cast<std::size_t>(k.frame)].data(),
                             w.points[static_cast<std::size_t>(k.point)].p_w.data());
  for (const tp::WindowTextObservation& k : w.text_observations) {
    tp::WindowText& t = w.texts[static_cast<std::size_t>(k.text)];
    const tp::PhotometricInput input = tp::photometric_input(
        *t.patch, o.text_level, w.frames[static_cast<std::size_t>(k.frame)].image, w.camera, k.scale_shift);
    problem.AddResidualBlock(new TextCost(input, k.weight, o, workspace), nullptr,
                             poses[static_cast<std::size_t>(t.host)].data(),
                             poses[static_cast<std::size_t>(k.frame)].data(), t.theta.data());
  }
  for (tp::WindowPoint& p : w.points) options.linear_solver_ordering->AddElementToGroup(p.p_w.data(), 0);
  for (tp::WindowText& t : w.texts) options.linear_solver_ordering->AddElementToGroup(t.theta.data(), 0);

  CeresResult out;
  out.build_ms = building.ms();
  const Stopwatch solving;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  out.solve_ms = solving.ms();
  out.cpu_ms = solving.cpu_ms();
  out.converged = summary.termination_type == ceres::CONVERGENCE;
  out.iterations = static_cast<int>(summary.iterations.size()) - 1;  // The first is the start.
  out.final_cost = 2 * summary.final_cost;                           // Ceres halves squares.
  for (std::size_t f = 0; f < poses.size(); ++f) w.frames[f].T_w_c = to_se3(poses[f].data());
  return out;
}

}  // namespace textplane_bench
