// What fixes the window in space, and what is reported where it is not fixed.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/window_of_points.hpp"

namespace textplane_test {
namespace window_gauge_test {

using WindowGauge = WindowOfPoints;

TEST_F(WindowGauge, NothingFixedIsReported) {
  perturb(w, noise, 0.01, 0.02, 0);
  const tp::Window before = w;
  const tp::WindowSummary s = tp::solve_window(w, o);
  EXPECT_EQ(s.status, tp::Status::rank_deficient);
  EXPECT_EQ(s.gauge_freedom, 7);
  expect_unchanged(before);
}

TEST_F(WindowGauge, OneFixedFrameLacksTheScale) {
  w.frames[1].fixed = true;
  perturb(w, noise, 0.01, 0.02, 0);
  const tp::Window before = w;
  const tp::WindowSummary s = tp::solve_window(w, o);
  EXPECT_EQ(s.status, tp::Status::rank_deficient);
  EXPECT_EQ(s.gauge_freedom, 1);
  expect_unchanged(before);
}

// A fixed point leaves the turns about it and the scale, a second one the turn about their line.
TEST_F(WindowGauge, FixedPointsTakeThreeFreedomsEach) {
  for (const int left : {4, 1}) {
    w.points[left == 4 ? 0 : 1].fixed = true;
    const tp::WindowSummary s = tp::solve_window(w, o);
    EXPECT_EQ(s.status, tp::Status::rank_deficient);
    EXPECT_EQ(s.gauge_freedom, left);
  }
  w.points[2].fixed = true;
  EXPECT_EQ(tp::solve_window(w, o).gauge_freedom, 0);
}

TEST_F(WindowGauge, TwoFixedFramesAtOnePlaceLackTheScale) {
  w.frames[0].fixed = w.frames[1].fixed = true;
  w.frames[1].T_w_c.t = w.frames[0].T_w_c.t;
  EXPECT_EQ(tp::solve_window(w, o).gauge_freedom, 1);
}

TEST_F(WindowGauge, OneFixedFrameAndAHeldDistanceGiveTheTruthAtThatScale) {
  const tp::Window truth = w;
  w.frames[0].fixed = true;
  perturb(w, noise, 0.01, 0.03, 0);
  for (int b : {4, 2}) {
    tp::Window x = w;
    o.scale_frame_a = b == 4 ? 0 : 3;  // With the fixed frame, and between two free ones.
    o.scale_frame_b = b;
    const auto a = static_cast<std::size_t>(o.scale_frame_a), c = static_cast<std::size_t>(b);
    const double held = (x.frames[a].T_w_c.t - x.frames[c].T_w_c.t).norm();
    const tp::WindowSummary s = tp::solve_window(x, o);
    EXPECT_EQ(s.status, tp::Status::converged);
    EXPECT_LT(s.final_cost, 2e-20 * s.point_observations);  // The solver stops at 1e-10 sigma each.
    EXPECT_EQ(s.undetermined, 0);
    EXPECT_NEAR((x.frames[a].T_w_c.t - x.frames[c].T_w_c.t).norm(), held, 1e-14);
    EXPECT_EQ(x.frames[0].T_w_c.R, truth.frames[0].T_w_c.R);
    EXPECT_EQ(x.frames[0].T_w_c.t, truth.frames[0].T_w_c.t);
    // The truth, scaled about the fixed camera.
    const double scale = held / (truth.frames[a].T_w_c.t - truth.frames[c].T_w_c.t).norm();
    const tp::Vector3<double> centre = truth.frames[0].T_w_c.t;
    for (std::size_t p = 0; p < x.points.size(); ++p)
      EXPECT_LT((x.points[p].p_w - (centre + scale * (truth.points[p].p_w - centre))).norm(), 1e-8);
  }
}

TEST_F(WindowGauge, AHeldDistanceOfZeroIsDegenerate) {
  w.frames[0].fixed = true;
  w.frames[2].T_w_c.t = w.frames[0].T_w_c.t;
  o.scale_frame_a = 0;
  o.scale_frame_b = 2;
  EXPECT_EQ(tp::solve_window(w, o).status, tp::Status::degenerate);
}

TEST_F(WindowGauge, EachIslandNeedsItsOwn) {
  // Frames 0, 1 see the even points, 2, 3, 4 the odd ones.
  std::vector<tp::WindowPointObservation> kept;
  for (const auto& k : w.point_observations)
    if ((k.frame < 2) == (k.point % 2 == 0)) kept.push_back(k);
  w.point_observations = kept;
  w.frames[0].fixed = w.frames[1].fixed = true;
  EXPECT_EQ(tp::solve_window(w, o).gauge_freedom, 7);
  w.frames[2].fixed = true;
  EXPECT_EQ(tp::solve_window(w, o).gauge_freedom, 1);
  w.frames[4].fixed = true;
  EXPECT_EQ(tp::solve_window(w, o).status, tp::Status::converged);
}

TEST_F(WindowGauge, FixedFramesStayBitForBit) {
  w.frames[0].fixed = w.frames[3].fixed = true;
  perturb(w, noise, 0.02, 0.05, 0);
  const tp::Window before = w;
  ASSERT_TRUE(tp::is_ok(tp::solve_window(w, o).status));
  for (std::size_t f : {0u, 3u}) {
    EXPECT_EQ(w.frames[f].T_w_c.R, before.frames[f].T_w_c.R);
    EXPECT_EQ(w.frames[f].T_w_c.t, before.frames[f].T_w_c.t);
  }
}
}  // namespace window_gauge_test
}  // namespace textplane_test
