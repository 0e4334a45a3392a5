// The window solver and Ceres stop at the same optimum of the same problem: reprojection errors under Huber's loss, and
// of a text either every pixel's residual, whose derivatives adapter_test.cpp proves, or the sums of the kernels.
#include <gtest/gtest.h>

#include <cstddef>

#include "solver/window_scene.hpp"
#include "textplane/adapters/ceres_window.hpp"

namespace textplane_test {
namespace {

using tp::adapters::TextRows;

/// Adjusts the window in place; returns its cost.
double solve_with_ceres(tp::Window& w, const tp::WindowOptions& o, TextRows rows, int threads = 1) {
  tp::adapters::WindowProblem problem(w, o, rows);
  EXPECT_EQ(problem.status(), tp::Status::ok);
  EXPECT_EQ(problem.left_out(), 0);
  ceres::Solver::Options options = problem.solver_options();
  options.num_threads = threads;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem.problem(), &summary);
  problem.write_back();
  return 2 * summary.final_cost;  // Ceres halves squares.
}

// A window of usual size with 1 px of noise and some wild observations, so that both robust costs are at work.
struct WindowAgainstCeres : testing::Test {
  WindowScene scene;
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
  const double cost = solve_with_ceres(peer, options, TextRows::sums);
  EXPECT_LT(s.final_cost, 0.9 * s.initial_cost);
  EXPECT_NEAR(s.final_cost, cost, 1e-9 * cost);
  const Distance d = distance(ours, peer);
  EXPECT_LT(d.position, 1e-6);
  EXPECT_LT(d.rotation, 1e-6);
  EXPECT_LT(d.point, 1e-5);
}

TEST_F(WindowAgainstCeres, PointsAndTextsHaveTheSameOptimum) {
  make(true);
  tp::Window ours = start;
  const tp::WindowSummary s = tp::solve_window(ours, options);
  EXPECT_EQ(s.text_observations, 21);
  EXPECT_LT(s.final_cost, 0.9 * s.initial_cost);
  for (TextRows rows : {TextRows::pixels, TextRows::sums}) {
    tp::Window peer = start;
    const double cost = solve_with_ceres(peer, options, rows);
    EXPECT_NEAR(s.final_cost, cost, 1e-6 * cost);
    const Distance d = distance(ours, peer);
    EXPECT_LT(d.position, 1e-4);
    EXPECT_LT(d.rotation, 1e-4);
    EXPECT_LT(d.point, 1e-3);
    EXPECT_LT(d.theta, 1e-3);
  }
}

// Costs are evaluated by several threads at a time, each with a workspace of its own.
TEST_F(WindowAgainstCeres, ThreadsDoNotChangeTheOptimum) {
  make(true);
  tp::Window one = start, two = start;
  options.max_iterations = 5;
  const double cost = solve_with_ceres(one, options, TextRows::sums);
  EXPECT_NEAR(solve_with_ceres(two, options, TextRows::sums, 2), cost, 1e-9 * cost);
  EXPECT_LT(distance(one, two).position, 1e-9);
}

// What solve_window() would leave out is left out, and told.
TEST_F(WindowAgainstCeres, UnusableObservationsAreLeftOut) {
  make(true);
  start.points.push_back({tp::Vector3<double>(0, 0, -50), false, tp::Status::ok});  // Behind every camera.
  for (int f : {1, 2}) {
    tp::WindowPointObservation o;
    o.frame = f;
    o.point = static_cast<int>(start.points.size()) - 1;
    start.point_observations.push_back(o);
  }
  tp::WindowTextObservation itself;
  itself.text = 0;
  itself.frame = start.texts[0].host;
  start.text_observations.push_back(itself);
  tp::adapters::WindowProblem problem(start, options);
  EXPECT_EQ(problem.left_out(), 3);
  EXPECT_EQ(problem.problem().NumResidualBlocks(),
            static_cast<int>(start.point_observations.size() + start.text_observations.size()) - 3);

  start.texts[0].host = 99;
  tp::adapters::WindowProblem broken(start, options);
  EXPECT_EQ(broken.status(), tp::Status::invalid_argument);
  EXPECT_EQ(broken.problem().NumResidualBlocks(), 0);
}

// What only solve_window() adjusts is refused rather than taken for something else.
TEST_F(WindowAgainstCeres, RowsRigsAndUnknownCamerasAreUnsupported) {
  const tp::RowMotion rows{tp::Vector6<double>::Constant(0.1), {0.03, 119.5, kHeight}};
  const tp::CameraView other(scene.camera);
  tp::WindowCalibration calibration;
  calibration.camera = scene.camera;
  calibration.hold();
  make(false);
  for (int what = 0; what < 4; ++what) {
    tp::Window w = start;
    if (what == 0) w.frames[1].rows = &rows;
    if (what == 1) w.frames[1].base = 0;
    if (what == 2) w.frames[1].camera = &other;
    if (what == 3) w.calibration = &calibration;
    tp::adapters::WindowProblem problem(w, options);
    EXPECT_EQ(problem.status(), tp::Status::unsupported) << what;
    EXPECT_EQ(problem.problem().NumResidualBlocks(), 0) << what;
  }
}

}  // namespace
}  // namespace textplane_test
