// Degenerate and unusable input of solve_window(): what is left out, and what is reported.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "solver/window_of_points.hpp"

namespace textplane_test {
namespace window_input_test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using WindowInput = WindowOfPoints;

TEST_F(WindowInput, EmptyWindows) {
  tp::Window empty;
  empty.camera = w.camera;
  EXPECT_EQ(tp::solve_window(empty, o).status, tp::Status::too_few);
  w.point_observations.clear();
  EXPECT_EQ(tp::solve_window(w, o).status, tp::Status::too_few);
  EXPECT_EQ(w.points[0].status, tp::Status::too_few);
  EXPECT_EQ(w.frames[0].status, tp::Status::too_few);
}

TEST_F(WindowInput, NanPosesAndCamerasAreRefused) {
  w.frames[0].fixed = w.frames[1].fixed = true;
  tp::Window x = w;
  x.frames[3].T_w_c.t[1] = kNan;
  EXPECT_EQ(tp::solve_window(x, o).status, tp::Status::non_finite);
  x = w;
  x.camera.pinhole.fx = kNan;
  EXPECT_EQ(tp::solve_window(x, o).status, tp::Status::non_finite);
  x = w;
  x.camera.pinhole.fy = -1;
  EXPECT_EQ(tp::solve_window(x, o).status, tp::Status::invalid_argument);
  x = w;
  x.point_observations[5].frame = 5;
  EXPECT_EQ(tp::solve_window(x, o).status, tp::Status::invalid_argument);
  x = w;
  x.point_observations[5].point = -1;
  EXPECT_EQ(tp::solve_window(x, o).status, tp::Status::invalid_argument);
  o.initial_lambda = 0;
  EXPECT_EQ(tp::solve_window(w, o).status, tp::Status::invalid_argument);
  for (double tp::WindowOptions::*member : {&tp::WindowOptions::cost_tolerance, &tp::WindowOptions::step_tolerance,
                                            &tp::WindowOptions::max_lost_fraction}) {
    tp::WindowOptions negative;
    negative.*member = -1e-9;
    EXPECT_EQ(tp::solve_window(w, negative).status, tp::Status::invalid_argument);
  }
}

TEST_F(WindowInput, NoIterationsAreTheCostAlone) {
  w.frames[0].fixed = w.frames[4].fixed = true;
  perturb(w, noise, 0.01, 0.03, 0);
  const tp::Window before = w;
  o.max_iterations = 0;
  const tp::WindowSummary s = tp::solve_window(w, o);
  EXPECT_EQ(s.status, tp::Status::iteration_limit);
  EXPECT_GT(s.initial_cost, 0);
  EXPECT_EQ(s.final_cost, s.initial_cost);
  expect_unchanged(before);
  o.max_iterations = -1;
  EXPECT_EQ(tp::solve_window(w, o).status, tp::Status::invalid_argument);
}

// Bad elements are left out, say so, and do not disturb the rest.
TEST_F(WindowInput, BadElementsAreLeftOut) {
  const tp::Window truth = w;
  w.frames[0].fixed = w.frames[4].fixed = true;
  perturb(w, noise, 0.01, 0.03, 0);
  w.points[4].p_w[0] = kNan;
  w.points.push_back({tp::Vector3<double>(0, 0, 5), false, tp::Status::ok});   // 50: nobody sees it.
  w.points.push_back({tp::Vector3<double>(0, 0, -3), false, tp::Status::ok});  // 51: behind everybody.
  w.points.push_back({tp::Vector3<double>(0, 0, 5), false, tp::Status::ok});   // 52: seen once.
  tp::WindowFrame lonely;
  lonely.T_w_c = w.frames[2].T_w_c;
  w.frames.push_back(lonely);  // 5: sees nothing.
  w.frames.push_back(lonely);  // 6: sees two points: four equations.
  const std::size_t first = w.point_observations.size();
  const auto observe = [&](int frame, int point, double x, double sigma) {
    tp::WindowPointObservation k;
    k.frame = frame;
    k.point = point;
    k.px = {x, 100};
    k.sigma = sigma;
    w.point_observations.push_back(k);
  };
  observe(0, 51, 100, 1);
  observe(1, 51, 100, 1);
  observe(1, 52, 100, 1);
  observe(6, 1, 100, 1);
  observe(6, 2, 100, 1);
  observe(1, 1, kNan, 1);
  observe(1, 1, 100, 0);
  const tp::Window before = w;
  const tp::WindowSummary s = tp::solve_window(w, o);
  EXPECT_EQ(s.status, tp::Status::converged);
  EXPECT_LT(s.final_cost, 2e-20 * s.point_observations);  // The solver stops at 1e-10 sigma each.
  EXPECT_EQ(w.points[4].status, tp::Status::non_finite);
  for (std::size_t p : {50u, 51u, 52u}) {
    EXPECT_EQ(w.points[p].status, tp::Status::too_few);
    EXPECT_EQ(w.points[p].p_w, before.points[p].p_w);
  }
  for (std::size_t f : {5u, 6u}) {
    EXPECT_EQ(w.frames[f].status, tp::Status::too_few);
    EXPECT_EQ(w.frames[f].T_w_c.t, before.frames[f].T_w_c.t);
  }
  const tp::Status expected[] = {tp::Status::behind_camera,   tp::Status::behind_camera, tp::Status::too_few,
                                 tp::Status::too_few,         tp::Status::too_few,       tp::Status::non_finite,
                                 tp::Status::invalid_argument};
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(w.point_observations[first + i].status, expected[i]) << i;
    EXPECT_GT(w.point_observations[first + i].chi2, 5.99) << i;
  }
  w.frames.resize(5);
  w.points.resize(50);
  w.points[4] = truth.points[4];
  EXPECT_LT(distance(truth, w).position, 1e-9);
  EXPECT_LT(distance(truth, w).point, 1e-8);
}

TEST_F(WindowInput, APointWithoutParallaxIsTold) {
  w.frames[0].fixed = w.frames[4].fixed = true;
  // Two more frames at the place of frame 0, which alone see point 50.
  for (int i = 0; i < 2; ++i) {
    tp::WindowFrame f;
    f.T_w_c = w.frames[0].T_w_c * tp::se3_exp<double>((tp::Vector6<double>() << 0, 0, 0, 0, 0.02 * i, 0.01).finished());
    f.fixed = true;
    w.frames.push_back(f);
    tp::WindowPointObservation k;
    k.frame = 5 + i;
    k.point = 50;
    w.points.resize(51);
    w.points[50].p_w = {0.1, 0.2, 5};
    k.px = w.camera.project(f.T_w_c.inverse() * w.points[50].p_w) + tp::Vector2<double>(3, -2);
    w.point_observations.push_back(k);
  }
  const tp::WindowSummary s = tp::solve_window(w, o);
  EXPECT_TRUE(tp::is_ok(s.status));
  EXPECT_EQ(w.points[50].status, tp::Status::rank_deficient);
  EXPECT_EQ(s.undetermined, 1);
}

// Six equations from three points on a line leave the turn about that line open: reported for the frame, which the
// graph cannot see.
TEST_F(WindowInput, AFrameThatSeesALineIsTold) {
  for (std::size_t f = 0; f < 5; ++f) w.frames[f].fixed = true;
  for (std::size_t p : {0u, 1u, 2u}) w.points[p].p_w = tp::Vector3<double>(-0.5 + 0.5 * static_cast<double>(p), 0.1, 4);
  tp::WindowFrame f;
  f.T_w_c = scene.T_w_c[2];
  w.frames.push_back(f);
  for (auto& k : w.point_observations)
    if (k.point < 3)
      k.px = w.camera.project(scene.T_w_c[static_cast<std::size_t>(k.frame)].inverse() *
                              w.points[static_cast<std::size_t>(k.point)].p_w);
  for (int p = 0; p < 3; ++p) {
    w.points[static_cast<std::size_t>(p)].fixed = true;
    tp::WindowPointObservation k;
    k.frame = 5;
    k.point = p;
    k.px = w.camera.project(f.T_w_c.inverse() * w.points[static_cast<std::size_t>(p)].p_w);
    w.point_observations.push_back(k);
  }
  const tp::WindowSummary s = tp::solve_window(w, o);
  EXPECT_TRUE(tp::is_ok(s.status));
  EXPECT_EQ(w.frames[5].status, tp::Status::rank_deficient);
}

TEST(WindowTextInput, BadTextsAreLeftOut) {
  WindowScene scene;
  Noise noise(41);
  scene.add_frames(5);
  scene.add_points(40, noise);
  add_signs(scene);
  tp::Window w = scene.finish();
  w.frames[0].fixed = w.frames[4].fixed = true;
  tp::WindowText broken = w.texts[0];
  broken.patch = nullptr;
  w.texts.push_back(broken);  // 3
  broken = w.texts[0];
  broken.theta[2] = kNan;
  w.texts.push_back(broken);  // 4
  broken = w.texts[0];
  broken.theta *= -1;  // 5: behind its host.
  w.texts.push_back(broken);
  w.texts.push_back(w.texts[1]);  // 6: nobody sees it.
  w.frames[3].image = tp::PyramidView();
  for (int t = 3; t < 6; ++t)
    for (int f = 1; f < 3; ++f) {
      tp::WindowTextObservation k;
      k.text = t;
      k.frame = f;
      w.text_observations.push_back(k);
    }
  tp::WindowTextObservation self;
  self.text = 0;
  self.frame = 0;
  w.text_observations.push_back(self);
  self.frame = 1;
  self.weight = -1;
  w.text_observations.push_back(self);
  const tp::WindowSummary s = tp::solve_window(w);
  EXPECT_TRUE(tp::is_ok(s.status));
  EXPECT_EQ(s.free_texts, 3);
  EXPECT_EQ(s.text_observations, 9);  // Of twelve, frame 3 has no image.
  EXPECT_EQ(w.texts[3].status, tp::Status::invalid_argument);
  EXPECT_EQ(w.texts[4].status, tp::Status::non_finite);
  EXPECT_EQ(w.texts[5].status, tp::Status::too_few);
  EXPECT_EQ(w.texts[6].status, tp::Status::too_few);
  const std::size_t n = w.text_observations.size();
  EXPECT_EQ(w.text_observations[n - 1].status, tp::Status::invalid_argument);
  EXPECT_EQ(w.text_observations[n - 2].status, tp::Status::degenerate);
  EXPECT_EQ(w.text_observations[n - 3].status, tp::Status::behind_camera);
  for (std::size_t k = 0; k < 12; ++k)
    EXPECT_EQ(w.text_observations[k].status,
              w.text_observations[k].frame == 3 ? tp::Status::invalid_argument : tp::Status::ok);
  for (std::size_t t = 0; t < 3; ++t) EXPECT_EQ(w.texts[t].used_observations, 3);
}

// A text that one frame alone looks at from the host's own place says nothing about its plane.
TEST(WindowTextInput, ATextWithoutParallaxIsTold) {
  WindowScene scene;
  scene.add_frames(1);
  scene.T_w_c.push_back(scene.T_w_c[0] *
                        tp::se3_exp<double>((tp::Vector6<double>() << 0, 0, 0, 0.01, 0.02, 0.03).finished()));
  scene.texts.push_back({0, {0.05, -0.03, 0.26}, 90, 60, 200, 140});
  tp::Window w = scene.finish();
  w.frames[0].fixed = w.frames[1].fixed = true;
  const tp::WindowSummary s = tp::solve_window(w);
  EXPECT_TRUE(tp::is_ok(s.status));
  EXPECT_EQ(w.texts[0].status, tp::Status::rank_deficient);
  EXPECT_EQ(w.texts[0].covariance, tp::Matrix3<double>::Zero());
  EXPECT_EQ(w.texts[0].theta, scene.texts[0].theta);
}
}  // namespace window_input_test
}  // namespace textplane_test
