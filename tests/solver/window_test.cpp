// The window solver brings known scenes back to the truth, stays there, never raises the cost, and shrugs outliers off.
#include "textplane/solver/window.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "solver/window_scene.hpp"

namespace textplane_test {
namespace window_test {

tp::WindowOptions exact() {
  tp::WindowOptions o;
  o.max_iterations = 50;
  o.cost_tolerance = 1e-14;
  o.step_tolerance = 1e-13;
  return o;
}

TEST(Window, PointsReturnToTheTruthExactly) {
  WindowScene scene;
  Noise noise(1);
  scene.add_frames(6);
  scene.add_points(80, noise);
  tp::Window& truth = scene.finish();
  truth.frames[0].fixed = truth.frames[3].fixed = true;
  tp::Window w = truth;
  perturb(w, noise, 0.03, 0.1, 0);
  ASSERT_GT(distance(truth, w).position, 0.02);
  const tp::WindowSummary s = tp::solve_window(w, exact());
  EXPECT_EQ(s.status, tp::Status::converged);
  EXPECT_EQ(s.free_frames, 4);
  EXPECT_EQ(s.free_points, 80);
  EXPECT_LT(s.final_cost, 2e-20 * s.point_observations);  // The solver stops at 1e-10 sigma each.
  const Distance d = distance(truth, w);
  EXPECT_LT(d.position, 1e-10);
  EXPECT_LT(d.rotation, 1e-10);
  EXPECT_LT(d.point, 1e-9);
}

// Images are rounded to 8 bits and read by bilinear interpolation: E of 1e-4 a patch at the truth, so poses come back
// to a few hundredths of a px (1 px is 0.004 rad here), planes to what their own covariance says.
TEST(Window, TextsAloneReturnToTheTruth) {
  WindowScene scene;
  Noise noise(2);
  scene.add_frames(6);
  add_signs(scene);
  tp::Window& truth = scene.finish();
  truth.frames[0].fixed = truth.frames[5].fixed = true;
  tp::Window w = truth;
  perturb(w, noise, 0.006, 0, 0.03);
  const Distance before = distance(truth, w);
  const tp::WindowSummary s = tp::solve_window(w, exact());
  EXPECT_EQ(s.status, tp::Status::converged);
  EXPECT_EQ(s.free_texts, 3);
  EXPECT_EQ(s.text_observations, 15);
  const Distance d = distance(truth, w);
  EXPECT_LT(d.position, 2e-3);
  EXPECT_LT(d.rotation, 5e-4);
  EXPECT_LT(d.theta, 3e-3);
  EXPECT_GT(before.rotation, 10 * d.rotation);
  EXPECT_GT(before.theta, 10 * d.theta);
  for (std::size_t i = 0; i < w.texts.size(); ++i) {
    EXPECT_EQ(w.texts[i].status, tp::Status::ok);
    EXPECT_EQ(w.texts[i].used_observations, 5);
    EXPECT_GT(w.texts[i].zncc, 0.9995);
    // sigma_photo = 0.3 is pessimistic for these images: the error is well inside the reported deviation.
    const tp::Vector3<double> e = w.texts[i].theta - truth.texts[i].theta;
    EXPECT_LT(e.dot(w.texts[i].covariance.inverse() * e), 9.0);
  }
}

TEST(Window, PointsAndTextsTogether) {
  WindowScene scene;
  Noise noise(3);
  scene.add_frames(6);
  scene.add_points(60, noise);
  add_signs(scene);
  tp::Window& truth = scene.finish();
  truth.frames[0].fixed = truth.frames[3].fixed = true;
  tp::Window w = truth;
  perturb(w, noise, 0.006, 0.05, 0.03);
  const tp::WindowSummary s = tp::solve_window(w, exact());
  EXPECT_EQ(s.status, tp::Status::converged);
  const Distance d = distance(truth, w);
  EXPECT_LT(d.position, 1e-3);
  EXPECT_LT(d.rotation, 3e-4);
  EXPECT_LT(d.point, 2e-3);
  EXPECT_LT(d.theta, 3e-3);
}

TEST(Window, CoarseToFineReachesFurtherThanOneLevel) {
  WindowScene scene;
  Noise noise(4);
  scene.add_frames(5);
  add_signs(scene);
  tp::Window& truth = scene.finish();
  truth.frames[0].fixed = truth.frames[4].fixed = true;
  tp::Window w = truth;
  perturb(w, noise, 0.02, 0, 0.05);
  tp::WindowWorkspace workspace;
  tp::WindowOptions o = exact();
  for (int level = 2; level >= 0; --level) {
    o.text_level = level;
    EXPECT_EQ(tp::solve_window(w, o, workspace).status, tp::Status::converged) << level;
  }
  const Distance d = distance(truth, w);
  EXPECT_LT(d.rotation, 5e-4);
  EXPECT_LT(d.theta, 3e-3);
}

TEST(Window, FixedTextsAndPointsStayAndStillPull) {
  WindowScene scene;
  Noise noise(5);
  scene.add_frames(4);
  scene.add_points(30, noise);
  add_signs(scene);
  tp::Window& truth = scene.finish();
  for (tp::WindowPoint& p : truth.points) p.fixed = true;
  for (tp::WindowText& t : truth.texts) t.fixed = true;
  tp::Window w = truth;
  for (tp::WindowFrame& f : w.frames) f.T_w_c = f.T_w_c * tp::se3_exp<double>(0.01 * noise.vector<6>());
  const tp::WindowSummary s = tp::solve_window(w, exact());
  EXPECT_EQ(s.status, tp::Status::converged);  // Thirty fixed points are gauge enough.
  EXPECT_EQ(s.free_points + s.free_texts, 0);
  EXPECT_EQ(s.free_frames, 4);
  const Distance d = distance(truth, w);
  EXPECT_EQ(d.point, 0);
  EXPECT_EQ(d.theta, 0);
  EXPECT_LT(d.position, 1e-3);
  EXPECT_LT(d.rotation, 3e-4);
}

TEST(Window, HuberKeepsOutliersFromBendingTheMap) {
  WindowScene scene;
  Noise noise(6);
  scene.add_frames(6);
  scene.add_points(100, noise);
  tp::Window& truth = scene.finish();
  truth.frames[0].fixed = truth.frames[3].fixed = true;
  tp::Window w = truth;
  perturb(w, noise, 0.01, 0.03, 0);
  std::vector<bool> outlier;
  for (std::size_t k = 0; k < w.point_observations.size(); ++k) {
    outlier.push_back(k % 17 == 0);
    if (outlier.back()) w.point_observations[k].px += tp::Vector2<double>(30, -25);
  }
  tp::Window plain = w;
  tp::WindowOptions o = exact();
  // Exact inliers: with a small delta an outlier's pull is bounded by it.
  o.point_robust.delta = 0.05;
  EXPECT_TRUE(tp::is_ok(tp::solve_window(w, o).status));
  o.point_robust.kind = tp::RobustKind::l2;
  EXPECT_TRUE(tp::is_ok(tp::solve_window(plain, o).status));
  EXPECT_LT(distance(truth, w).rotation, 2e-4);
  EXPECT_GT(distance(truth, plain).rotation, 20 * distance(truth, w).rotation);
  for (std::size_t k = 0; k < outlier.size(); ++k) EXPECT_EQ(w.point_observations[k].chi2 > 5.99, outlier[k]) << k;
}

// One more iteration at a time: the cost after n iterations never rises with n, and every call starts where the last
// one ended.
TEST(Window, CostIsMonotone) {
  WindowScene scene;
  Noise noise(7);
  scene.add_frames(6);
  scene.add_points(60, noise);
  add_signs(scene);
  tp::Window& truth = scene.finish();
  truth.frames[0].fixed = truth.frames[3].fixed = true;
  for (bool texts : {false, true}) {
    tp::Window start = truth;
    if (!texts) start.text_observations.clear();
    perturb(start, noise, texts ? 0.01 : 0.15, 0.5, 0.03);
    tp::WindowOptions o = exact();
    double last = 0;
    for (int n = 0; n <= 12; ++n) {
      tp::Window w = start;
      o.max_iterations = n;
      const tp::WindowSummary s = tp::solve_window(w, o);
      ASSERT_TRUE(tp::is_ok(s.status)) << tp::to_string(s.status);
      if (n > 0) {
        EXPECT_LE(s.final_cost, last * (1 + 1e-12)) << n;
      } else {
        EXPECT_EQ(s.final_cost, s.initial_cost);
        EXPECT_EQ(s.accepted, 0);
      }
      last = s.final_cost;
    }
    EXPECT_LT(last, 1e6);
  }
}

TEST(Window, AWorkspaceCarriesNothingOver) {
  WindowScene scene, other;
  Noise noise(8);
  scene.add_frames(5);
  scene.add_points(40, noise);
  add_signs(scene);
  tp::Window& truth = scene.finish();
  truth.frames[0].fixed = truth.frames[3].fixed = true;
  perturb(truth, noise, 0.005, 0.03, 0.02);
  other.add_frames(8);
  other.add_points(90, noise);
  tp::Window big = other.finish();
  big.frames[0].fixed = big.frames[1].fixed = true;
  perturb(big, noise, 0.01, 0.05, 0);

  tp::Window a = truth, b = truth;
  tp::WindowWorkspace used;
  tp::solve_window(big, {}, used);
  tp::solve_window(a, {}, used);
  tp::solve_window(b);
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    EXPECT_EQ(a.frames[i].T_w_c.t, b.frames[i].T_w_c.t);
    EXPECT_EQ(a.frames[i].T_w_c.R, b.frames[i].T_w_c.R);
  }
  for (std::size_t i = 0; i < a.points.size(); ++i) EXPECT_EQ(a.points[i].p_w, b.points[i].p_w);
  for (std::size_t i = 0; i < a.texts.size(); ++i) {
    EXPECT_EQ(a.texts[i].theta, b.texts[i].theta);
    EXPECT_EQ(a.texts[i].covariance, b.texts[i].covariance);
  }
}

}  // namespace window_test
}  // namespace textplane_test
