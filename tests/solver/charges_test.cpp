// What a text or a point that a trial loses costs, and what chi2 is: both by their formulas, with weights and
// deviations that are not 1.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "solver/pose_scene.hpp"
#include "solver/window_scene.hpp"
#include "textplane/solver/plane.hpp"
#include "textplane/solver/window.hpp"

namespace charges_test {
namespace tp = textplane;
using tp::Status;

constexpr double kMost = std::numeric_limits<double>::max();

// rho(2) of Huber's cost with delta 0.5: E = 2 is what two patches without correlation have.
const double kLostText = 2 * 0.5 * std::sqrt(2.0) - 0.25;

tp::Vector6<double> turn(int axis, double angle) { return angle * tp::Vector6<double>::Unit(3 + axis); }

TEST(Charges, ALostTextOfAPose) {
  pose_test::Input input(false, 0);
  input.texts.resize(1);
  input.texts[0].weight = 1.7;
  input.workspace.reserve(input.texts.data(), 1, 0);
  tp::PoseOptions options;
  options.sigma_photo = 0.4;
  options.sigma_rep = 1.5;
  const tp::PyramidViewF view = input.target.view();
  tp::detail::PoseProblem<tp::PyramidViewF> problem(input.texts.data(), 1, nullptr, 0, view, input.scene.camera,
                                                    options, input.workspace);
  ASSERT_TRUE(tp::is_ok(problem.linearise(input.truth).status));
  const int visible = problem.visible_pixels();
  const tp::Evaluation e = problem.evaluate(problem.retract(input.truth, turn(1, -0.65)));
  EXPECT_EQ(e.lost_fraction, 1);
  EXPECT_NEAR(e.cost, 1.7 * visible * std::pow(1.5 / 0.4, 2) * kLostText, 1e-9 * e.cost);
}

// A point behind the camera: the error of one as far off as the focal length, in its deviations.
TEST(Charges, ALostPointOfAPose) {
  pose_test::Input input(true, 3);
  const double sigmas[] = {0.5, 2, 7};
  double expected = 0;
  tp::PoseOptions options;
  options.point_robust = {tp::RobustKind::huber, 2};
  for (std::size_t i = 0; i < 3; ++i) {
    input.points[i].sigma = sigmas[i];
    const double r = input.scene.camera.fx / sigmas[i];
    expected += 2 * 2 * r - 4;
  }
  input.workspace.reserve(nullptr, 0, 3);
  const tp::PyramidViewF view = input.target.view();
  tp::detail::PoseProblem<tp::PyramidViewF> problem(nullptr, 0, input.points.data(), 3, view, input.scene.camera,
                                                    options, input.workspace);
  ASSERT_TRUE(tp::is_ok(problem.linearise(input.truth).status));
  const tp::Evaluation e = problem.evaluate(problem.retract(input.truth, turn(1, 3.14159)));
  EXPECT_EQ(e.lost_fraction, 1);
  EXPECT_NEAR(e.cost, expected, 1e-9 * expected);
}

TEST(Charges, ALostTargetOfAPlane) {
  const pose_test::Input input(false, 0);
  const auto& sign = input.scene.signs[0];
  const tp::PlaneTargetF target{input.target.view(), input.truth};
  tp::PlaneWorkspace workspace;
  workspace.reserve(input.patches[0], 1);
  const tp::PlaneOptions options;
  tp::detail::PlaneProblem<tp::PyramidViewF> problem(input.patches[0], &target, 1, input.scene.camera, options,
                                                     workspace);
  ASSERT_TRUE(tp::is_ok(problem.linearise(sign.theta).status));
  const tp::Evaluation e = problem.evaluate(-sign.theta);  // behind the camera
  EXPECT_EQ(e.lost_fraction, 1);
  EXPECT_NEAR(e.cost, problem.visible_pixels() * kLostText, 1e-9 * e.cost);
}

TEST(Charges, ALostTextOfAWindow) {
  textplane_test::WindowScene scene;
  scene.add_frames(2);
  scene.texts.push_back({0, {0.05, -0.03, 0.26}, 90, 80, 170, 130});
  tp::Window w = scene.finish();
  w.frames[0].fixed = true;
  w.frames[1].fixed = true;
  w.text_observations[0].weight = 2.5;
  tp::WindowOptions o;
  o.sigma_rep = 1.5;
  o.sigma_photo = 0.4;
  tp::detail::WindowState x;
  tp::detail::WindowTerms terms;
  tp::detail::WindowStructure s;
  tp::detail::WindowSchur system;
  x.read(w);
  terms.prepare(w, o, x);
  ASSERT_EQ(s.build(w, o), Status::ok);
  terms.accumulate(w, o, x, s, system);
  terms.report(w, o, x, s);
  const int visible = w.text_observations[0].visible;
  ASSERT_GT(visible, 100);
  tp::detail::WindowState y = x;
  y.T_w_c[1] = y.T_w_c[1] * tp::se3_exp<double>(turn(1, 1.2));
  const tp::detail::WindowTrial trial = terms.evaluate(w, o, x, s, y);
  EXPECT_EQ(trial.lost_fraction, 1);
  EXPECT_NEAR(trial.cost, 2.5 * visible * std::pow(1.5 / 0.4, 2) * kLostText, 1e-9 * trial.cost);
}

TEST(Chi2, OfAPoseIsInUnitsOfBothDeviations) {
  pose_test::Input input(true, 4);
  tp::PoseOptions options;
  options.sigma_rep = 2;
  options.solve.max_iterations = 0;
  input.workspace.reserve(nullptr, 0, 4);
  const double off[] = {10, 14, 15, 20};  // px, of a deviation of 6 px
  for (std::size_t i = 0; i < 4; ++i) {
    input.points[i].sigma = 3;
    input.points[i].px =
        input.scene.camera.project(input.truth * input.points[i].p_w) + off[i] * tp::Vector2<double>(0.6, -0.8);
  }
  float chi2[4];
  const tp::PyramidViewF view = input.target.view();
  const tp::PoseFit fit = tp::refine_pose(nullptr, 0, input.points.data(), 4, view, input.scene.camera, input.truth,
                                          options, input.workspace, nullptr, chi2);
  ASSERT_TRUE(tp::is_ok(fit.status));
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(chi2[i], off[i] * off[i] / 36, 1e-4) << i;
  EXPECT_EQ(fit.inlier_points, 2);  // 14^2 / 36 = 5.4, 15^2 / 36 = 6.25; the bound is 5.99
}

struct Points {
  textplane_test::WindowScene scene;
  tp::Window w;
  Points() {
    textplane_test::Noise noise(5);
    scene.add_frames(3);
    scene.add_points(20, noise);
    w = scene.finish();
    w.frames[0].fixed = w.frames[1].fixed = true;
  }
};

TEST(Chi2, OfAWindowIsInUnitsOfTheDeviation) {
  Points points;
  tp::Window& w = points.w;
  for (std::size_t k = 0; k < w.point_observations.size(); ++k) {
    w.point_observations[k].sigma = 0.5 + 0.5 * static_cast<double>(k % 5);
    w.point_observations[k].px[0] += k % 2 == 0 ? 3 : -2;
  }
  tp::solve_window(w, {});
  for (const tp::WindowPointObservation& k : w.point_observations) {
    const auto& T = w.frames[static_cast<std::size_t>(k.frame)].T_w_c;
    const tp::Vector2<double> e =
        w.camera.project(T.inverse() * w.points[static_cast<std::size_t>(k.point)].p_w) - k.px;
    EXPECT_NEAR(k.chi2, e.squaredNorm() / (k.sigma * k.sigma), 1e-9 * (1 + k.chi2));
  }
}

TEST(Chi2, BeyondTheLargestDoubleIsThat) {
  Points points;
  tp::Window& w = points.w;
  w.point_observations[0].px[0] = 1e200;
  w.point_observations[1].px[1] = -1e300;
  tp::WindowOptions o;
  o.point_robust = {tp::RobustKind::tukey, 4.7};  // whose cost is bounded: the window is solved all the same
  const tp::WindowSummary sum = tp::solve_window(w, o);
  EXPECT_TRUE(tp::is_ok(sum.status)) << tp::to_string(sum.status);
  EXPECT_EQ(w.point_observations[0].status, Status::ok);
  EXPECT_EQ(w.point_observations[0].chi2, kMost);
  EXPECT_EQ(w.point_observations[1].chi2, kMost);
  EXPECT_LT(w.point_observations[2].chi2, 1);
}

}  // namespace charges_test
