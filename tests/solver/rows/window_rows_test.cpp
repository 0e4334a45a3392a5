// Windows behind a rolling shutter.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "solver/rows/rows_scene.hpp"
#include "textplane/solver/window.hpp"

namespace window_rows_test {

using namespace textplane_test;
using namespace textplane_test::rows;

// Five frames of a cloud, two of them fixed, started off the truth.
struct PointWindow {
  std::vector<tp::RowMotion> rows, known;
  std::vector<tp::SE3d> truth;
  tp::Window window;

  // Motions that the window knows are off by up to `off`.
  explicit PointWindow(double off) {
    Random random(21), noise(22);
    const std::vector<tp::Vector3<double>> points = cloud(random, 60);
    window.camera = kCamera;
    for (int f = 0; f < 5; ++f) {
      rows.push_back({random.twist(1, 1), kShutter});
      known.push_back(rows.back());
      if (f >= 2) known.back().velocity += random.twist(off, off);
      truth.push_back(tp::se3_exp<double>(random.twist(0.3, 0.1)));
      tp::WindowFrame frame;
      frame.fixed = f < 2;
      frame.T_w_c = truth.back();
      if (!frame.fixed) frame.T_w_c = frame.T_w_c * tp::se3_exp<double>(noise.twist(0.02, 0.02));
      window.frames.push_back(frame);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      tp::WindowPoint point;
      point.p_w =
          points[i] + 0.02 * tp::Vector3<double>(noise.uniform(-1, 1), noise.uniform(-1, 1), noise.uniform(-1, 1));
      window.points.push_back(point);
      for (int f = 0; f < 5; ++f) {
        const auto slot = static_cast<std::size_t>(f);
        const tp::RowProjection seen = tp::project_rows(rows[slot], kCamera, truth[slot].inverse() * points[i]);
        EXPECT_TRUE(tp::is_ok(seen.status));
        window.point_observations.push_back({f, static_cast<int>(i), seen.px});
      }
    }
  }
  tp::WindowSummary solve() {
    tp::WindowOptions options;
    options.max_iterations = 50;
    options.cost_tolerance = 1e-12;
    return tp::solve_window(window, options);
  }
  double error() const {
    double largest = 0;
    for (std::size_t f = 2; f < 5; ++f) largest = std::max(largest, distance(window.frames[f].T_w_c, truth[f]));
    return largest;
  }
};

TEST(Rows, WindowOfPointsIsExact) {
  PointWindow with(0), without(0);
  for (std::size_t f = 0; f < 5; ++f) with.window.frames[f].rows = &with.known[f];
  EXPECT_EQ(with.solve().status, tp::Status::converged);
  EXPECT_LT(with.error(), 1e-6);
  EXPECT_TRUE(with.window.frames[3].velocity == with.known[3].velocity);
  without.solve();
  EXPECT_GT(without.error(), 1e-3);
}

TEST(Rows, WindowFindsVelocities) {
  PointWindow free(0.2), held(0.2);
  for (std::size_t f = 0; f < 5; ++f) {
    for (PointWindow* w : {&free, &held}) w->window.frames[f].rows = &w->known[f];
    free.window.frames[f].velocity_sigma.setConstant(1e3);
  }
  held.solve();
  EXPECT_GT(held.error(), 1e-4);
  const tp::WindowSummary summary = free.solve();
  EXPECT_EQ(summary.status, tp::Status::converged);
  EXPECT_LT(summary.iterations, 20);
  EXPECT_LT(free.error(), 1e-6);
  for (std::size_t f = 0; f < 5; ++f)
    EXPECT_LT((free.window.frames[f].velocity - free.rows[f].velocity).norm(), 1e-4) << f;
}

// A prior that is certain holds the velocity as one that is known does.
TEST(Rows, CertainPriorsHoldVelocities) {
  PointWindow certain(0.2), held(0.2);
  for (std::size_t f = 0; f < 5; ++f) {
    for (PointWindow* w : {&certain, &held}) w->window.frames[f].rows = &w->known[f];
    certain.window.frames[f].velocity_sigma.setConstant(1e-7);
  }
  held.solve();
  certain.solve();
  for (std::size_t f = 2; f < 5; ++f) {
    EXPECT_LT(distance(certain.window.frames[f].T_w_c, held.window.frames[f].T_w_c), 1e-6);
    EXPECT_LT((certain.window.frames[f].velocity - certain.known[f].velocity).norm(), 1e-8);
  }
}

// The information of so small a deviation would be infinite.
TEST(Rows, WindowRefusesDeviationsOutOfTheirDomain) {
  const tp::RowMotion rows{tp::Vector6<double>::Constant(0.1), kShutter};
  tp::Window window;
  window.camera = kCamera;
  window.frames.resize(2);
  window.frames[1].rows = &rows;
  window.frames[1].velocity_sigma.setConstant(1e-200);
  EXPECT_EQ(tp::solve_window(window).status, tp::Status::invalid_argument);
  window.frames[1].velocity_sigma.setConstant(std::numeric_limits<double>::infinity());
  EXPECT_EQ(tp::solve_window(window).status, tp::Status::too_few);
}

// Texts alone, on one plane, between rolling images. The rotation starts at none; the translation is known, as on one
// plane the two are hard to tell apart.
TEST(Rows, WindowFindsVelocitiesByTexts) {
  const Views v(5);
  const tp::RowMotion host_rows = v.host;
  tp::RowMotion start = v.target;
  start.velocity.tail<3>().setZero();
  const tp::CameraView host(kCamera.pinhole, nullptr, &host_rows);
  const tp::Image<std::uint8_t> host_image = picture(v.T_h_w, v.host), target_image = picture(v.T_t_w, v.target);
  const tp::Pyramid host_pyramid(host_image.view(), 1), target_pyramid(target_image.view(), 1);
  std::vector<tp::TextPatch> patches;
  for (const double y : {15.0, 60.0, 105.0, 150.0, 190.0})
    for (const double x : {60.0, 150.0}) {
      const tp::Quad<double> quad{{tp::Vector2<double>(x, y), tp::Vector2<double>(x + 70, y),
                                   tp::Vector2<double>(x + 70, y + 25), tp::Vector2<double>(x, y + 25)}};
      patches.push_back(tp::make_patch(host_pyramid.view(), host, quad));
      ASSERT_TRUE(tp::is_ok(patches.back().status));
    }
  tp::Window window;
  window.camera = kCamera;
  window.frames.resize(2);
  window.frames[0] = {v.T_h_w.inverse(), true, host_pyramid.view(), &host_rows};
  window.frames[1] = {v.T_t_w.inverse(), false, target_pyramid.view(), &start};
  window.frames[1].velocity_sigma << 1e-3, 1e-3, 1e-3, 10, 10, 10;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    window.texts.push_back({0, v.theta, &patches[i], true});
    window.text_observations.push_back({static_cast<int>(i), 1});
  }
  tp::WindowOptions options;
  options.max_iterations = 100;
  options.cost_tolerance = 1e-10;
  EXPECT_TRUE(tp::is_ok(tp::solve_window(window, options).status));
  const tp::Vector3<double> omega = v.target.velocity.tail<3>(), found = window.frames[1].velocity.tail<3>();
  EXPECT_LT((found - omega).norm(), 0.1 * omega.norm());
}

// The velocity moves a low text as a whole, at the time of the row in which the target sees its centre.
TEST(Rows, GradientByTheVelocityOfATextsTargetIsThatOfTheCost) {
  const Views v(5);
  const tp::RowMotion host_rows = v.host;
  tp::RowMotion off = v.target;
  off.velocity += tp::Vector6<double>::Constant(0.1);
  const tp::CameraView host(kCamera.pinhole, nullptr, &host_rows);
  const tp::Image<std::uint8_t> host_image = picture(v.T_h_w, v.host), target_image = picture(v.T_t_w, v.target);
  const tp::Pyramid host_pyramid(host_image.view(), 1), target_pyramid(target_image.view(), 1);
  for (const double y : {15.0, 30.0, 150.0, 165.0}) {
    const tp::Quad<double> quad{{tp::Vector2<double>(90, y), tp::Vector2<double>(210, y),
                                 tp::Vector2<double>(210, y + 8), tp::Vector2<double>(90, y + 8)}};
    const tp::TextPatch patch = tp::make_patch(host_pyramid.view(), host, quad);
    tp::Window w;
    w.camera = kCamera;
    w.frames.resize(2);
    w.frames[0] = {v.T_h_w.inverse(), true, host_pyramid.view(), &host_rows};
    w.frames[1] = {v.T_t_w.inverse(), false, target_pyramid.view(), &off};
    w.frames[1].velocity_sigma.setConstant(1e3);
    w.texts.push_back({0, v.theta, &patch, true});
    w.text_observations.push_back({0, 1});
    const tp::WindowOptions options;
    tp::detail::WindowState x;
    tp::detail::WindowStructure structure;
    tp::detail::WindowTerms terms;
    tp::detail::WindowSchur system;
    x.read(w);
    terms.prepare(w, options, x);
    ASSERT_EQ(structure.build(w, options), tp::Status::ok);
    terms.accumulate(w, options, x, structure, system);
    const tp::Vector6<double> g = system.camera_gradient(structure.velocity_of_frame[1]);
    tp::Vector6<double> expected;
    for (int i = 0; i < 6; ++i) {
      const double h = 1e-4;
      tp::detail::WindowState up = x, down = x;
      up.rows[1].velocity[i] += h;
      down.rows[1].velocity[i] -= h;
      expected[i] =
          (terms.evaluate(w, options, x, structure, up).cost - terms.evaluate(w, options, x, structure, down).cost) /
          (4 * h);
    }
    // What is left to the cost: rows up to four from the centre, which is some eighty from the shutter's middle.
    EXPECT_LT((g - expected).norm(), 0.05 * expected.norm()) << y;
  }
}

}  // namespace window_rows_test
