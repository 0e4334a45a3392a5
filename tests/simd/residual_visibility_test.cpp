// Which pixels the residual kernels see, and what they answer to input that has no residual: on every target as the
// double reference, to the pixel and to the status.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "simd/residual_support.hpp"

namespace residual_visibility_test {
namespace tp = textplane;
using namespace textplane_test;
using Scene8 = Scene<std::uint8_t>;

// The part of the target from (x, y) on, seen by the same camera.
tp::PhotometricInput cropped(const Scene8& scene, int x, int y, int width, int height) {
  tp::PhotometricInput in = scene.input();
  in.target = tp::ImageView8(&in.target(x, y), width, height, in.target.stride());
  in.target_camera.cx -= x;
  in.target_camera.cy -= y;
  return in;
}

TEST(ResidualVisibility, MasksAndBorders) {
  Random random(11);
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const int n = trial % 3 == 0 ? random.integer(1, 40) : random.integer(41, 700);
    const Scene8 scene(static_cast<unsigned>(trial + 1), n);
    const int x = random.integer(0, 150), y = random.integer(0, 110);
    tp::PhotometricInput in = cropped(scene, x, y, random.integer(2, 200 - x), random.integer(2, 160 - y));
    std::vector<std::uint8_t> mask(static_cast<std::size_t>(n));
    for (auto& m : mask) m = static_cast<std::uint8_t>(random.integer(0, 3) * 85);
    if (trial % 4 != 0) in.patch.mask = mask.data();
    tp::PhotometricOptions o = any_options(trial % 2 == 0);
    o.min_visible = random.integer(0, 20);
    compare_all(in, scene.theta, scene.T_t_h, o);
  }
}

TEST(ResidualVisibility, TrialsOnAGivenSet) {
  Random random(12);
  int lost = 0;
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    const int n = random.integer(20, 600);
    const Scene8 scene(static_cast<unsigned>(trial + 100), n);
    const int x = random.integer(0, 60), y = random.integer(0, 40);
    const tp::PhotometricInput in = cropped(scene, x, y, random.integer(60, 200 - x), random.integer(60, 160 - y));
    std::vector<std::uint8_t> set(static_cast<std::size_t>(n), 1);
    if (trial % 3 > 0)
      for (auto& s : set) s = random.integer(0, 4) > 0;
    if (trial == 5) set.assign(set.size(), 0);
    compare_cost(in, scene.theta, scene.T_t_h, any_options(), set.data());
    tp::PhotometricWorkspace workspace(n);
    lost += tp::evaluate(tp::ResidualRequest{in, scene.theta, scene.T_t_h, any_options()}, workspace, set.data()).lost;
  }
  EXPECT_GT(lost, 500);
}

// evaluate() leaves the visible set of the linearisation alone.
TEST(ResidualVisibility, EvaluationKeepsTheVisibleSet) {
  const Scene8 scene(4, 200);
  tp::PhotometricWorkspace workspace(200);
  const auto in = cropped(scene, 40, 30, 100, 80);
  ASSERT_EQ(
      tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, scene.theta, scene.T_t_h, any_options()}, workspace)
          .status,
      tp::Status::ok);
  const std::vector<std::uint8_t> before(workspace.visible(), workspace.visible() + 200);
  const auto other = cropped(scene, 60, 50, 70, 60);
  EXPECT_EQ(
      tp::evaluate(tp::ResidualRequest{other, scene.theta, scene.T_t_h, any_options()}, workspace, workspace.visible())
          .status,
      tp::Status::ok);
  EXPECT_EQ(before, std::vector<std::uint8_t>(workspace.visible(), workspace.visible() + 200));
}

// Every pixel of an image onto itself, exactly: those on the border are visible, and the last column and row take their
// gradient from the cell before.
TEST(ResidualVisibility, ExactlyOnTheBorders) {
  const auto image = texture<std::uint8_t>(37, 23, 5);
  std::vector<float> x, y, v;
  Random random(3);
  for (int r = 0; r < 23; ++r)
    for (int c = 0; c < 37; ++c) {
      x.push_back(static_cast<float>(c));
      y.push_back(static_cast<float>(r));
      v.push_back(static_cast<float>(image(c, r) + random.integer(-9, 9)));
    }
  tp::PhotometricInput in;
  in.patch = {x.data(), y.data(), v.data(), nullptr, static_cast<int>(x.size())};
  in.host_camera = in.target_camera = tp::Pinhole<double>(64, 64, 16, 8);
  in.target = image.view();
  const tp::Vector3<double> theta(0, 0, 0.5);
  compare_all(in, theta, tp::SE3d(), any_options());
  tp::PhotometricWorkspace workspace(in.patch.n);
  for (const simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    EXPECT_EQ(tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, theta, tp::SE3d(), any_options()}, workspace)
                  .visible,
              in.patch.n);
  }
  // One pixel to the right: the last column leaves.
  tp::SE3d right;
  right.t[0] = 2.0 / 64;
  compare_all(in, theta, right, any_options());
  EXPECT_EQ(tp::evaluate(tp::ResidualRequest{in, theta, right, any_options()}, workspace).visible, 23 * 36);
}

// A patch at half its size whose last column or row is a third of a thousandth of a pixel inside the image or outside.
TEST(ResidualVisibility, CloseToTheBorders) {
  const auto image = texture<std::uint8_t>(37, 23, 5);
  std::vector<float> x, y, v;
  Random random(4);
  for (int r = 5; r <= 12; ++r)
    for (int c = 10; c <= 20; ++c) {
      x.push_back(static_cast<float>(c));
      y.push_back(static_cast<float>(r));
      v.push_back(static_cast<float>(random.integer(1, 250)));
    }
  tp::PhotometricInput in;
  in.patch = {x.data(), y.data(), v.data(), nullptr, static_cast<int>(x.size())};
  in.host_camera = tp::Pinhole<double>(64, 64, 16, 8);
  in.target = image.view();
  tp::PhotometricWorkspace workspace(in.patch.n);
  for (const double out : {-3e-4, 3e-4}) {
    const double cx[4] = {3 - out, 34 + out, 18, 18}, cy[4] = {11, 11, 1.5 - out, 20 + out};
    for (int side = 0; side < 4; ++side) {
      SCOPED_TRACE(side);
      in.target_camera = tp::Pinhole<double>(32, 32, cx[side], cy[side]);
      const int seen = out < 0 ? 88 : side < 2 ? 80 : 77;
      for (const simd::Target target : testable_targets()) {
        const TargetScope scope(target);
        const tp::ResidualRequest request{in, tp::Vector3<double>(0, 0, 0.5), tp::SE3d(), any_options()};
        EXPECT_EQ(tp::evaluate(request, workspace).visible, seen) << simd::to_string(target);
        EXPECT_EQ(tp::linearise<tp::Parameters::pose>(request, workspace).visible, seen) << simd::to_string(target);
      }
    }
  }
}

// Planes that cut through the patch's rays and cameras that look away, in general position.
TEST(ResidualVisibility, BehindTheCameras) {
  Random random(21);
  int behind = 0, seen = 0;
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    Scene8 scene(static_cast<unsigned>(trial % 7 + 1), 60);
    const tp::Vector3<double> theta(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-0.5, 0.8));
    const tp::SE3d T = tp::se3_exp<double>(random.twist(1.0, trial % 2 == 0 ? 0.3 : 3.0));
    std::vector<std::uint8_t> mask(60, 1);
    tp::PhotometricInput in = scene.input();
    in.patch.mask = mask.data();
    for (std::size_t i = 0; i < 60; ++i) {
      // Clear of every decision: the planes of both cameras, and the target's pixel lines.
      const tp::Vector3<double> m =
          in.host_camera.unproject({static_cast<double>(scene.x[i]), static_cast<double>(scene.y[i])});
      const double rho = theta.dot(m);
      const tp::Vector3<double> q = T.R * m + T.t * rho;
      const tp::Vector2<double> at = in.target_camera.project(q);
      const auto on_line = [](double c) { return std::abs(c - std::round(c)) < 2e-3; };
      mask[i] = std::abs(rho) > 1e-3 && std::abs(q[2]) > 1e-3 && !on_line(at[0]) && !on_line(at[1]);
    }
    tp::PhotometricWorkspace exact_workspace(60), workspace(60);
    const auto exact = tp::reference::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, theta, T, any_options()},
                                                                      exact_workspace);
    behind += exact.status == tp::Status::behind_camera;
    seen += is_ok(exact.status);
    for (const simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      SCOPED_TRACE(simd::to_string(target));
      const auto fast =
          tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, theta, T, any_options()}, workspace);
      EXPECT_EQ(fast.status, exact.status) << to_string(fast.status) << " " << to_string(exact.status);
      EXPECT_EQ(fast.visible, exact.visible);
      for (int i = 0; i < 60; ++i) ASSERT_EQ(workspace.visible()[i], exact_workspace.visible()[i]) << i;
    }
  }
  EXPECT_GT(behind, 30);
  EXPECT_GT(seen, 30);
}

TEST(ResidualVisibility, BrokenInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf, 1e300, 1e30}) {
    for (int what = 0; what < 24; ++what) {
      SCOPED_TRACE(what);
      Scene8 scene(9, what % 2 == 0 ? 50 : 400);
      tp::PhotometricInput in = scene.input();
      tp::Vector3<double> theta = scene.theta;
      tp::SE3d T = scene.T_t_h;
      if (what < 3)
        theta[what] = bad;
      else if (what < 6)
        T.t[what - 3] = bad;
      else if (what < 15)
        T.R(what / 3 - 2, what % 3) = bad;
      else if (what == 15)
        in.host_camera.fx = bad;
      else if (what == 16)
        in.host_camera.cy = bad;
      else if (what == 17)
        in.target_camera.fy = bad;
      else if (what == 18)
        in.target_camera.cx = bad;
      else if (what == 19)
        scene.intensity[7] = static_cast<float>(bad);
      else if (what == 20)
        scene.x[3] = static_cast<float>(bad);
      else if (what == 21)
        scene.y[0] = static_cast<float>(bad);
      else if (what == 22)
        scene.intensity.assign(scene.intensity.size(), static_cast<float>(bad));
      else
        scene.x.assign(scene.x.size(), static_cast<float>(bad));
      tp::PhotometricWorkspace workspace(in.patch.n);
      const auto exact = tp::reference::linearise<tp::Parameters::pose_plane>(
          tp::ResidualRequest{in, theta, T, any_options()}, workspace);
      const auto cost = tp::reference::evaluate(tp::ResidualRequest{in, theta, T, any_options()}, workspace);
      for (const simd::Target target : testable_targets()) {
        const TargetScope scope(target);
        SCOPED_TRACE(simd::to_string(target));
        const auto fast =
            tp::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{in, theta, T, any_options()}, workspace);
        EXPECT_EQ(fast.status, exact.status) << to_string(fast.status) << " " << to_string(exact.status);
        EXPECT_EQ(fast.visible, exact.visible);
        if (is_ok(fast.status)) {
          EXPECT_TRUE(tp::all_finite(fast.H) && tp::all_finite(fast.b) && tp::is_finite(fast.cost));
          EXPECT_NEAR(fast.cost, exact.cost, 1e-4);
        } else {
          EXPECT_TRUE(all_zero(fast));
        }
        EXPECT_EQ(tp::evaluate(tp::ResidualRequest{in, theta, T, any_options()}, workspace).status, cost.status);
      }
    }
  }
}

TEST(ResidualVisibility, NothingToCompare) {
  Scene8 scene(6, 80);
  std::vector<std::uint8_t> none(80, 0);
  const tp::Image<std::uint8_t> constant(200, 160, 93), black(200, 160, 0);
  for (int what = 0; what < 14; ++what) {
    SCOPED_TRACE(what);
    scene = Scene8(6, 80);
    tp::PhotometricInput in = scene.input();
    tp::PhotometricOptions o = any_options();
    tp::SE3d T = scene.T_t_h;
    if (what == 0) in.patch.n = 0;
    if (what == 1) in.patch.mask = none.data();
    if (what == 2) in.target = constant.view();
    if (what == 3) in.target = black.view();
    if (what == 4) scene.intensity.assign(80, 0.1F);
    if (what == 5) o.min_contrast = 1000;
    if (what == 6) o.min_visible = 81;
    if (what == 7) in.target = tp::ImageView8(in.target.data(), 1, 160, in.target.stride());
    if (what == 8) in.target = tp::ImageView8(in.target.data(), 200, 1, in.target.stride());
    if (what == 9) in.target = {};
    if (what == 10) in.patch.x = nullptr;
    if (what == 11) T.R = tp::so3_exp<double>(tp::Vector3<double>(0, 3.1, 0));
    if (what == 12) T.t = tp::Vector3<double>(50, 0, 0);
    if (what == 13) in.target_camera.fx = -1;
    compare_equations<3>(in, scene.theta, T, o);
    compare_equations<6>(in, scene.theta, T, o);
    compare_equations<9>(in, scene.theta, T, o);
    compare_cost(in, scene.theta, T, o);
  }
  tp::PhotometricWorkspace small(79);
  const auto refused = tp::linearise<tp::Parameters::pose>(scene.request(any_options()), small);
  EXPECT_EQ(refused.status, tp::Status::invalid_argument);
}

}  // namespace residual_visibility_test
