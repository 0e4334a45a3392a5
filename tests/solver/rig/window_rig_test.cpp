// Windows of rigs: frames that are fixed to others, with cameras of their own.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "solver/window_scene.hpp"

namespace window_rig_test {
using namespace textplane_test;
using tp::CameraView;
using tp::SE3d;
using tp::Status;
using tp::Window;

SE3d pose(double x, double y, double z, double rx, double ry, double rz) {
  tp::Vector6<double> xi;
  xi << x, y, z, rx, ry, rz;
  return tp::se3_exp<double>(xi);
}

tp::WindowOptions exact() {
  tp::WindowOptions options;
  options.max_iterations = 30;
  options.cost_tolerance = 0;
  options.step_tolerance = 1e-13;
  return options;
}

// Ties frames `bases` on to the first ones, each as the other camera of the rig.
void tie(Window& w, int bases, const SE3d& T_b_c, const CameraView* camera) {
  for (std::size_t f = static_cast<std::size_t>(bases); f < w.frames.size(); ++f) {
    w.frames[f].base = static_cast<int>(f) - bases;
    w.frames[f].T_b_c = T_b_c;
    w.frames[f].camera = camera;
  }
}

// A stereo pair at n times: frames n to 2 n - 1 are the right images of 0 to n - 1.
struct Stereo {
  WindowScene scene;
  SE3d T_b_c = pose(0.25, 0.02, -0.01, 0.02, -0.06, 0.03);
  Window truth;

  Stereo(int n, int points, bool texts, const tp::LensMap* lens = nullptr) {
    scene.lens = lens;
    scene.add_frames(n);
    for (int f = 0; f < n; ++f) scene.T_w_c.push_back(scene.T_w_c[static_cast<std::size_t>(f)] * T_b_c);
    Noise noise(4);
    scene.add_points(points, noise);
    if (texts) add_signs(scene);
    truth = scene.finish();
    tie(truth, n, T_b_c, nullptr);
    truth.frames[0].fixed = true;
  }
};

TEST(WindowRig, StereoKnowsTheScale) {
  for (const int n : {1, 2, 4}) {
    const Stereo stereo(n, 40, false);
    Window w = stereo.truth;
    Noise noise(7);
    perturb(w, noise, 0.02, 0.05, 0);
    const tp::WindowSummary summary = tp::solve_window(w, exact());
    EXPECT_TRUE(is_ok(summary.status)) << to_string(summary.status);
    EXPECT_EQ(summary.gauge_freedom, 0);
    EXPECT_EQ(summary.free_frames, n - 1);
    EXPECT_LE(summary.iterations, 12) << "steps of a wrong Jacobian are many";
    const Distance left = distance(w, stereo.truth);
    EXPECT_LT(left.position, 1e-9);
    EXPECT_LT(left.rotation, 1e-9);
    EXPECT_LT(left.point, 1e-8);
  }
}

TEST(WindowRig, WithoutItsRigTheScaleIsMissing) {
  const Stereo stereo(3, 40, false);
  Window w = stereo.truth;
  for (tp::WindowFrame& f : w.frames) f.base = -1;
  EXPECT_EQ(tp::solve_window(w, exact()).gauge_freedom, 1);
  w = stereo.truth;
  w.frames[0].fixed = false;
  EXPECT_EQ(tp::solve_window(w, exact()).gauge_freedom, 6);
}

TEST(WindowRig, TextsHostedAndSeenByEitherCamera) {
  static const tp::LensMap fisheye(tp::KannalaBrandt<double>{{}, 0.01, -0.003, 0.002, -0.001});
  for (const tp::LensMap* lens : {static_cast<const tp::LensMap*>(nullptr), &fisheye})
    for (const int points : {0, 30}) {
      Stereo stereo(3, points, true, lens);
      Window w = stereo.truth;
      Noise noise(3);
      perturb(w, noise, 0.005, 0.02, 0.02);
      tp::WindowOptions options;
      options.max_iterations = 30;
      const tp::WindowSummary summary = tp::solve_window(w, options);
      EXPECT_TRUE(is_ok(summary.status)) << to_string(summary.status);
      EXPECT_EQ(summary.text_observations, 15);
      const Distance left = distance(w, stereo.truth);
      EXPECT_LT(left.position, 5e-3);
      EXPECT_LT(left.rotation, 1e-3);
      EXPECT_LT(left.theta, 0.02);
      for (const tp::WindowText& text : w.texts) EXPECT_GT(text.zncc, 0.99);
    }
}

// A text that the right camera hosts: its term is the same from both sides of the rig.
TEST(WindowRig, AHostMayBeTheOtherCamera) {
  Stereo stereo(3, 30, false);
  WindowScene& scene = stereo.scene;
  scene.truth = Window();
  scene.texts.push_back({4, {0.05, -0.03, 0.26}, 30, 30, 110, 80});
  scene.texts.push_back({3, {-0.06, 0.04, 0.30}, 190, 40, 270, 95});
  Window truth = scene.finish();
  tie(truth, 3, stereo.T_b_c, nullptr);
  truth.frames[0].fixed = true;
  Window w = truth;
  Noise noise(3);
  perturb(w, noise, 0.004, 0, 0.01);
  tp::WindowOptions options;
  options.max_iterations = 30;
  EXPECT_TRUE(is_ok(tp::solve_window(w, options).status));
  const Distance left = distance(w, truth);
  EXPECT_LT(left.position, 5e-3);
  EXPECT_LT(left.rotation, 1e-3);
  EXPECT_LT(left.theta, 0.02);
}

// Back to back, with other intrinsics: each camera sees points of its own.
TEST(WindowRig, TwoFisheyesBackToBack) {
  static const tp::LensMap lens(tp::KannalaBrandt<double>{{}, 0.01, -0.003, 0.002, -0.001});
  const CameraView front({150, 151, 200, 201}, &lens), back({140, 141, 190, 205}, &lens);
  const SE3d T_b_c = pose(0.02, -0.01, -0.08, 0.05, 3.1, -0.04);
  constexpr int kTimes = 4;
  Window truth;
  truth.camera = front;
  for (int f = 0; f < 2 * kTimes; ++f) {
    tp::WindowFrame frame;
    frame.T_w_c = pose(0.1 * (f % kTimes), 0.03 * (f % kTimes), 0, 0.02, 0.05 * (f % kTimes), 0);
    if (f >= kTimes) frame.T_w_c = frame.T_w_c * T_b_c;
    truth.frames.push_back(frame);
  }
  tie(truth, kTimes, T_b_c, &back);
  truth.frames[0].fixed = truth.frames[1].fixed = true;
  Noise noise(8);
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < 20; ++k) {
      const double z = 2 + noise();
      const tp::Vector3<double> p(1.3 * z * noise(), 1.3 * z * noise(), z);
      const auto host = static_cast<std::size_t>(side * kTimes);
      truth.points.push_back({truth.frames[host].T_w_c * p});
      for (int t = 0; t < kTimes; ++t) {
        const tp::WindowFrame& frame = truth.frames[host + static_cast<std::size_t>(t)];
        const tp::Vector3<double> p_c = frame.T_w_c.inverse() * truth.points.back().p_w;
        const CameraView& camera = side == 0 ? front : back;
        if (!camera.in_domain(p_c)) continue;
        truth.point_observations.push_back({side * kTimes + t, 20 * side + k, camera.project(p_c)});
      }
    }
  Window w = truth;
  perturb(w, noise, 0.01, 0.03, 0);
  const tp::WindowSummary summary = tp::solve_window(w, exact());
  EXPECT_TRUE(is_ok(summary.status)) << to_string(summary.status);
  EXPECT_EQ(summary.free_frames, kTimes - 2);
  EXPECT_LE(summary.iterations, 12);
  const Distance left = distance(w, truth);
  EXPECT_LT(left.position, 1e-9);
  EXPECT_LT(left.rotation, 1e-9);
}

TEST(WindowRig, CamerasFollowTheirBaseExactly) {
  const Stereo stereo(3, 40, false);
  Window w = stereo.truth;
  Noise noise(2);
  for (tp::WindowPointObservation& o : w.point_observations) o.px += noise.vector<2>();
  perturb(w, noise, 0.02, 0.05, 0);
  ASSERT_TRUE(is_ok(tp::solve_window(w).status));
  for (std::size_t f = 3; f < 6; ++f) {
    const SE3d expected = w.frames[f - 3].T_w_c * stereo.T_b_c;
    EXPECT_TRUE(expected.R == w.frames[f].T_w_c.R && expected.t == w.frames[f].T_w_c.t) << f;
    EXPECT_EQ(w.frames[f].status, w.frames[f - 3].status);
  }
}

// One camera that sits elsewhere on each base: the window of the plain frames, in other coordinates.
TEST(WindowRig, ARigOfOneCameraIsThatCamera) {
  WindowScene scene;
  scene.add_frames(4);
  Noise noise(4);
  scene.add_points(40, noise);
  add_signs(scene);
  Window plain = scene.finish();
  plain.frames[0].fixed = plain.frames[1].fixed = true;
  perturb(plain, noise, 0.005, 0.02, 0.02);
  Window rig = plain;
  const SE3d T_b_c = pose(0.3, -0.2, 0.1, 0.4, -1, 0.3);
  const int n = static_cast<int>(rig.frames.size());
  for (int f = 0; f < n; ++f) {
    tp::WindowFrame& frame = rig.frames[static_cast<std::size_t>(f)];
    tp::WindowFrame base;
    base.T_w_c = frame.T_w_c * T_b_c.inverse();
    base.fixed = frame.fixed;
    frame.base = n + f;
    frame.T_b_c = T_b_c;
    rig.frames.push_back(base);
  }
  tp::WindowOptions options;
  options.max_iterations = 30;
  ASSERT_TRUE(is_ok(tp::solve_window(plain, options).status));
  ASSERT_TRUE(is_ok(tp::solve_window(rig, options).status));
  rig.frames.resize(static_cast<std::size_t>(n));
  const Distance between = distance(plain, rig);
  EXPECT_LT(between.position, 1e-4);
  EXPECT_LT(between.rotation, 5e-5);
  EXPECT_LT(between.theta, 1e-3);
  for (std::size_t t = 0; t < plain.texts.size(); ++t) {
    EXPECT_LT((plain.texts[t].covariance - rig.texts[t].covariance).norm(), 0.01 * plain.texts[t].covariance.norm());
  }
}

TEST(WindowRig, SaysWhatIsWrong) {
  const Stereo stereo(2, 20, false);
  const auto status = [&](auto change) {
    Window w = stereo.truth;
    tp::WindowOptions options;
    change(w, options);
    return tp::solve_window(w, options).status;
  };
  const CameraView broken(-1, 1, 0, 0), good(260, 262, 161.3, 118.6);
  EXPECT_TRUE(is_ok(status([](Window&, tp::WindowOptions&) {})));
  EXPECT_EQ(status([](Window& w, tp::WindowOptions&) { w.frames[2].base = 4; }), Status::invalid_argument);
  EXPECT_EQ(status([](Window& w, tp::WindowOptions&) { w.frames[2].base = -2; }), Status::invalid_argument);
  EXPECT_EQ(status([](Window& w, tp::WindowOptions&) { w.frames[2].base = 3; }), Status::invalid_argument);
  EXPECT_EQ(status([](Window& w, tp::WindowOptions&) { w.frames[2].base = 2; }), Status::invalid_argument);
  EXPECT_EQ(status([&](Window& w, tp::WindowOptions&) { w.frames[1].camera = &broken; }), Status::invalid_argument);
  EXPECT_EQ(
      status([](Window& w, tp::WindowOptions&) { w.frames[2].T_b_c.t[0] = std::numeric_limits<double>::quiet_NaN(); }),
      Status::non_finite);
  EXPECT_EQ(status([](Window&, tp::WindowOptions& o) {
              o.scale_frame_a = 1;
              o.scale_frame_b = 3;
            }),
            Status::invalid_argument);
  tp::WindowCalibration calibration;
  calibration.camera = tp::Pinhole<double>(260, 262, 161.3, 118.6);
  calibration.sigma = tp::AnyCamera<double>::Parameters::Constant(4, 1.0);
  EXPECT_EQ(status([&](Window& w, tp::WindowOptions&) { w.calibration = &calibration; }), Status::invalid_argument);
}

}  // namespace window_rig_test
