// A window of frames and points alone, as a fixture.
#ifndef TEXTPLANE_TESTS_SOLVER_WINDOW_OF_POINTS_HPP
#define TEXTPLANE_TESTS_SOLVER_WINDOW_OF_POINTS_HPP

#include <gtest/gtest.h>

#include "solver/window_scene.hpp"
#include "textplane/solver/window.hpp"

namespace textplane_test {

struct WindowOfPoints : ::testing::Test {
  WindowScene scene;
  Noise noise{31};
  tp::Window w;
  tp::WindowOptions o;

  void SetUp() override {
    scene.add_frames(5);
    scene.add_points(50, noise);
    w = scene.finish();
    o.max_iterations = 50;
    o.cost_tolerance = 1e-14;
    o.step_tolerance = 1e-13;
  }
  void expect_unchanged(const tp::Window& before) const {
    const Distance d = distance(before, w);
    EXPECT_EQ(d.point, 0);
    EXPECT_LT(d.position + d.rotation, 1e-15);
  }
};
}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SOLVER_WINDOW_OF_POINTS_HPP
