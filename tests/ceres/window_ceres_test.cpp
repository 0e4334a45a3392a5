// The window solver and Ceres stop at the same optimum of the same problem. Ceres is given the cost as it is defined, with
// derivatives by its own dual numbers: reprojection errors under Huber's loss, and of a text every pixel's residual r of
// reference::residuals_t() as sqrt(rho(r^2)), since a loss on a block would act on the whole patch.
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "solver/window_scene.hpp"
#include "textplane/photometry/residual_autodiff.hpp"

namespace textplane_test {
namespace {

constexpr int kPose = 7;  // Quaternion x y z w, then t.
using PoseManifold = ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;

template <class T>
tp::SE3<T> pose(const T* x) {
  tp::SE3<T> out;
  out.R = Eigen::Map<const Eigen::Quaternion<T>>(x).toRotationMatrix();
  out.t = Eigen::Map<const tp::Vector3<T>>(x + 4);
  return out;
}

struct PointError {
  const tp::Pinhole<double>& camera;
  const tp::WindowPointObservation& o;

  template <class T>
  bool operator()(const T* frame, const T* point, T* r) const {
    const tp::SE3<T> T_w_c = pose(frame);
    const tp::Vector3<T> p = T_w_c.R.transpose() * (Eigen::Map<const tp::Vector3<T>>(point) - T_w_c.t);
    r[0] = (camera.fx * p[0] / p[2] + camera.cx - o.px[0]) / o.sigma;
    r[1] = (camera.fy * p[1] / p[2] + camera.cy - o.px[1]) / o.sigma;
    return p[2] > T(0);
  }
};

struct TextError {
  tp::PhotometricInput input;
  tp::Robust robust;
  double factor;                    // sqrt(lambda_w / N)
  std::vector<std::uint8_t> every;  // All pixels stay visible in this scene.

  template <class T>
  bool operator()(const T* host, const T* target, const T* theta, T* r) const {
    using std::sqrt;
    const tp::SE3<T> T_t_h = pose(target).inverse() * pose(host);
    const tp::Vector3<T> plane = Eigen::Map<const tp::Vector3<T>>(theta);
    if (!tp::is_ok(tp::reference::residuals_t(input, plane, T_t_h, every.data(), nullptr, r))) return false;
    const double root = std::sqrt(static_cast<double>(input.patch.n)), d = robust.delta;
    for (int i = 0; i < input.patch.n; ++i) {
      const T e = root * r[i];
      const bool inside = e * e <= T(d * d);
      r[i] = factor * (inside ? e : sqrt(2 * d * (e < T(0) ? -e : e) - d * d));
    }
    return true;
  }
};

/// Adjusts the window in place; returns its cost.
double solve_with_ceres(tp::Window& w, const tp::WindowOptions& o) {
  std::vector<std::array<double, kPose>> poses(w.frames.size());
  PoseManifold manifold;
  ceres::HuberLoss huber(o.point_robust.delta);
  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (std::size_t f = 0; f < poses.size(); ++f) {
    Eigen::Map<Eigen::Quaterniond>{poses[f].data()} = Eigen::Quaterniond(w.frames[f].T_w_c.R);
    Eigen::Map<tp::Vector3<double>>{poses[f].data() + 4} = w.frames[f].T_w_c.t;
    problem.AddParameterBlock(poses[f].data(), kPose, &manifold);
    if (w.frames[f].fixed) problem.SetParameterBlockConstant(poses[f].data());
  }
  const auto frame = [&](int f) { return poses[static_cast<std::size_t>(f)].data(); };
  for (const tp::WindowPointObservation& k : w.point_observations)
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PointError, 2, kPose, 3>(new PointError{w.camera, k}),
                             &huber, frame(k.frame), w.points[static_cast<std::size_t>(k.point)].p_w.data());
  for (const tp::WindowTextObservation& k : w.text_observations) {
    tp::WindowText& t = w.texts[static_cast<std::size_t>(k.text)];
    const tp::PhotometricInput input =
        tp::photometric_input(*t.patch, o.text_level, w.frames[static_cast<std::size_t>(k.frame)].image, w.camera);
    const int n = input.patch.n;
    auto* error = new TextError{input, o.photometric.robust,
                                std::sqrt(k.weight * tp::text_weight(o.weighting, o.sigma_rep, o.sigma_photo, n) / n),
                                std::vector<std::uint8_t>(static_cast<std::size_t>(n), 1)};
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<TextError, ceres::DYNAMIC, kPose, kPose, 3>(error, n),
                             nullptr, frame(t.host), frame(k.frame), t.theta.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_SCHUR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-14;
  options.gradient_tolerance = options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (std::size_t f = 0; f < poses.size(); ++f) w.frames[f].T_w_c = pose<double>(poses[f].data());
  return 2 * summary.final_cost;  // Ceres halves squares.
}

// A window of usual size with 1 px of noise and some wild observations, so that both robust costs are at work.
struct WindowAgainstCeres : testing::Test {
  Scene scene;
  tp::Window start;
  tp::WindowOptions options;

  void make(bool signs) {
    Noise noise(7);
    scene.add_frames(8);
    scene.add_points(300, noise);
    if (signs) add_signs(scene);
    start = scene.finish();
    start.frames[0].fixed = start.frames[4].fixed = true;
    for (std::size_t k = 0; k < start.point_observations.size(); ++k)
      start.point_observations[k].px += (k % 29 == 0 ? 12.0 : 1.0) * noise.vector<2>();
    perturb(start, noise, 0.004, 0.05, 0.01);
    options.max_iterations = 200;
    options.cost_tolerance = options.step_tolerance = 1e-14;
    options.photometric.precise = true;
    options.photometric.robust.delta = 0.05;  // Rendered without noise: so that some pixels exceed it.
  }
};

TEST_F(WindowAgainstCeres, PointsHaveTheSameOptimum) {
  make(false);
  tp::Window ours = start, peer = start;
  const tp::WindowSummary s = tp::solve_window(ours, options);
  const double cost = solve_with_ceres(peer, options);
  EXPECT_LT(s.final_cost, 0.9 * s.initial_cost);
  EXPECT_NEAR(s.final_cost, cost, 1e-9 * cost);
  const Distance d = distance(ours, peer);
  EXPECT_LT(d.position, 1e-6);
  EXPECT_LT(d.rotation, 1e-6);
  EXPECT_LT(d.point, 1e-5);
}

TEST_F(WindowAgainstCeres, PointsAndTextsHaveTheSameOptimum) {
  make(true);
  tp::Window ours = start, peer = start;
  const tp::WindowSummary s = tp::solve_window(ours, options);
  const double cost = solve_with_ceres(peer, options);
  EXPECT_EQ(s.text_observations, 21);
  EXPECT_LT(s.final_cost, 0.9 * s.initial_cost);
  EXPECT_NEAR(s.final_cost, cost, 1e-6 * cost);
  const Distance d = distance(ours, peer);
  EXPECT_LT(d.position, 1e-4);
  EXPECT_LT(d.rotation, 1e-4);
  EXPECT_LT(d.point, 1e-3);
  EXPECT_LT(d.theta, 1e-3);
}

}  // namespace
}  // namespace textplane_test
