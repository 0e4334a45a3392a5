// The camera as an unknown of a window: derivatives, recovery of every model, priors, covariance, and what is refused.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <string>

#include "solver/window_scene.hpp"

namespace textplane_test {
namespace window_calibration_test {

using Camera = tp::AnyCamera<double>;
using Parameters = Camera::Parameters;

const std::vector<Camera> kCameras = {
    tp::Pinhole<double>{260, 262, 161.3, 118.6},
    tp::RadialTangential<double>{{260, 262, 161.3, 118.6}, -0.28, 0.07, 1e-3, -5e-4, 0},
    tp::Rational<double>{{260, 262, 161.3, 118.6}, -0.2, 0.05, 1e-3, -5e-4, 0.01, 0.05, 0.01, 0.002},
    tp::KannalaBrandt<double>{{190, 191, 161.3, 118.6}, 0.01, -0.003, 0.002, -0.001},
    tp::DoubleSphere<double>{{150, 151, 161.3, 118.6}, -0.2, 0.6},
    tp::ExtendedUnified<double>{{190, 191, 161.3, 118.6}, 0.6, 1.1},
    tp::Fov<double>{{200, 201, 161.3, 118.6}, 0.9},
};

// Eight frames about 80 points, which a camera of `model` sees without noise. The first frame is fixed, and the
// distance to the last one.
struct Problem {
  tp::Window w;
  tp::WindowCalibration calibration;
  tp::WindowOptions o;
  Parameters truth;

  explicit Problem(const Camera& model, int frames = 8, double spacing = 0.12) : truth(model.parameters()) {
    Noise noise(7);
    WindowScene scene;
    scene.add_frames(frames, spacing);
    scene.add_points(80, noise);
    w = scene.finish();
    calibration.camera = model;
    calibration.hold();
    w.frames[0].fixed = true;
    o.scale_frame_a = 0;
    o.scale_frame_b = frames - 1;
    o.max_iterations = 100;
    o.cost_tolerance = 1e-16;
    o.step_tolerance = 1e-14;
    observe(model);
  }
  void observe(const Camera& model) {
    w.point_observations.clear();
    for (int f = 0; f < static_cast<int>(w.frames.size()); ++f)
      for (int p = 0; p < static_cast<int>(w.points.size()); ++p) {
        const tp::Vector3<double> c =
            w.frames[static_cast<std::size_t>(f)].T_w_c.inverse() * w.points[static_cast<std::size_t>(p)].p_w;
        if (c[2] > 0.1 && model.in_domain(c)) w.point_observations.push_back({f, p, model.project(c)});
      }
  }
  void free_all(double sigma = std::numeric_limits<double>::infinity()) { calibration.sigma.setConstant(sigma); }
  tp::WindowSummary solve() {
    w.calibration = &calibration;
    return tp::solve_window(w, o);
  }
};

// The cost at the parameters of the blocks and landmarks, through the parts of the solver.
struct Linear {
  Problem& p;
  tp::detail::WindowState x;
  tp::detail::WindowStructure s;
  tp::detail::WindowTerms terms;
  tp::detail::WindowSchur system;
  double cost = 0;

  explicit Linear(Problem& problem) : p(problem) {
    p.w.calibration = &p.calibration;
    x.read(p.w);
    terms.prepare(p.w, p.o, x);
    EXPECT_EQ(s.build(p.w, p.o), tp::Status::ok);
    cost = terms.accumulate(p.w, p.o, x, s, system);
  }
  double cost_at(int unknown, double step) {
    tp::detail::WindowState y = x;
    Parameters parameters = y.camera.parameters();
    s.calibration.move(unknown, step, &parameters);
    EXPECT_EQ(Camera::make(y.camera.name(), parameters, &y.camera), tp::Status::ok);
    const tp::detail::WindowTrial trial = terms.evaluate(p.w, p.o, x, s, y);
    EXPECT_TRUE(trial.possible);
    return trial.cost;
  }
};

TEST(WindowCalibration, GradientIsThatOfTheCost) {
  for (const Camera& camera : kCameras)
    for (const bool one_focal_length : {true, false}) {
      SCOPED_TRACE(camera.name());
      Problem p(camera);
      Noise noise(3);
      for (auto& k : p.w.point_observations) k.px += 3 * noise.vector<2>();
      p.free_all(0.5);
      p.calibration.one_focal_length = one_focal_length;
      Linear linear(p);
      ASSERT_EQ(linear.s.calibration.count(), static_cast<int>(p.truth.size()) - (one_focal_length ? 1 : 0));
      // Off the priors' means.
      Parameters moved = linear.x.camera.parameters();
      for (int i = 0; i < moved.size(); ++i) moved[i] *= 1 + 0.01 * noise();
      ASSERT_EQ(Camera::make(camera.name(), moved, &linear.x.camera), tp::Status::ok);
      linear.cost = linear.terms.accumulate(p.w, p.o, linear.x, linear.s, linear.system);
      EXPECT_NEAR(linear.cost_at(0, 0), linear.cost, 1e-9 * linear.cost);
      for (int i = 0; i < linear.s.calibration.count(); ++i) {
        const double g = linear.system.camera_gradient(linear.s.cameras() + i / 6)[i % 6];
        const double h = 1e-6;
        EXPECT_NEAR(g, (linear.cost_at(i, h) - linear.cost_at(i, -h)) / (4 * h), 1e-5 * (1 + std::abs(g))) << i;
      }
    }
}

TEST(WindowCalibration, EveryModelIsFound) {
  for (const Camera& camera : kCameras) {
    SCOPED_TRACE(camera.name());
    Problem p(camera);
    Parameters start = p.truth;
    start[0] *= 1.05;
    start[1] *= 1.05;
    start[2] += 2;
    start[3] -= 3;
    for (int i = 4; i < start.size(); ++i) start[i] *= 0.9;
    ASSERT_EQ(Camera::make(camera.name(), start, &p.calibration.camera), tp::Status::ok);
    p.free_all();
    Noise noise(5);
    for (std::size_t f = 1; f + 1 < p.w.frames.size(); ++f)
      p.w.frames[f].T_w_c = p.w.frames[f].T_w_c * tp::se3_exp<double>(0.005 * noise.vector<6>());
    for (auto& point : p.w.points) point.p_w += 0.02 * noise.vector<3>();
    const tp::WindowSummary sum = p.solve();
    EXPECT_TRUE(tp::is_ok(sum.status)) << tp::to_string(sum.status);
    EXPECT_LT(sum.final_cost, 1e-10);
    EXPECT_EQ(sum.free_parameters, static_cast<int>(p.truth.size()) - 1);
    // The rational lens has combinations of its coefficients that hardly differ over the image: it counts as a map.
    for (int x = 0; x < kWidth; x += 40)
      for (int y = 0; y < kHeight; y += 40) {
        tp::Vector3<double> ray;
        ASSERT_EQ(camera.unproject({x, y}, &ray), tp::Status::ok);
        const double off = (p.calibration.camera.project(ray) - tp::Vector2<double>(x, y)).norm();
        EXPECT_LT(off, std::string(camera.name()) == "rational" ? 0.05 : 1e-3) << x << " " << y;
      }
  }
}

TEST(WindowCalibration, ACameraThatIsHeldIsThatOfTheWindow) {
  for (const bool two : {false, true}) {
    Problem p(kCameras[0]);
    Noise noise(9);
    for (auto& k : p.w.point_observations) k.px += noise.vector<2>();
    if (two) p.w.calibration = &p.calibration;
    p.w.camera = tp::Pinhole<double>{260, 262, 161.3, 118.6};
    tp::Window known = p.w;
    known.calibration = nullptr;
    tp::solve_window(known, p.o);
    tp::solve_window(p.w, p.o);
    for (std::size_t f = 0; f < known.frames.size(); ++f) EXPECT_EQ(known.frames[f].T_w_c.t, p.w.frames[f].T_w_c.t);
    EXPECT_EQ(p.calibration.camera.parameters(), p.truth);
  }
}

TEST(WindowCalibration, PriorsPullByTheirInformation) {
  double last = 0;
  for (const double sigma : {1e-3, 1.0, 10.0, 1e3}) {
    Problem p(kCameras[0]);
    Noise noise(5);
    for (auto& k : p.w.point_observations) k.px += 0.2 * noise.vector<2>();
    Parameters start = p.truth;
    start[0] *= 1.1;
    start[1] *= 1.1;
    // The mean of the prior is not where the solver starts.
    p.calibration.mean = start;
    p.calibration.sigma[0] = sigma;
    ASSERT_TRUE(tp::is_ok(p.solve().status));
    const Parameters found = p.calibration.camera.parameters();
    EXPECT_DOUBLE_EQ(found[1] / found[0], start[1] / start[0]);
    EXPECT_EQ(found[2], p.truth[2]);
    const double moved = start[0] - found[0];
    EXPECT_GT(moved, last);
    last = moved;
    EXPECT_LT(std::sqrt(p.calibration.covariance(0, 0)), sigma);
    EXPECT_EQ(p.calibration.covariance(2, 2), 0);
  }
  EXPECT_NEAR(last, 26, 3);
}

// Over draws of the noise the estimates scatter as the covariance says.
TEST(WindowCalibration, CovarianceIsThatOfTheEstimates) {
  const Camera camera = kCameras[1];
  constexpr int kDraws = 200;
  Noise noise(13);
  Eigen::MatrixXd off(5, kDraws);
  Eigen::VectorXd sigma(5);
  const int tested[5] = {0, 2, 3, 4, 5};
  for (int d = 0; d < kDraws; ++d) {
    Problem p(camera);
    // Uniform, and so small that the cost is quadratic.
    for (auto& k : p.w.point_observations) {
      k.sigma = 0.02;
      k.px += k.sigma * std::sqrt(3.0) * noise.vector<2>();
    }
    p.o.point_robust.kind = tp::RobustKind::l2;
    p.o.cost_tolerance = 1e-12;
    for (const int i : tested) p.calibration.sigma[i] = std::numeric_limits<double>::infinity();
    ASSERT_TRUE(tp::is_ok(p.solve().status));
    ASSERT_EQ(p.calibration.status, tp::Status::ok);
    for (int i = 0; i < 5; ++i) {
      off(i, d) = p.calibration.camera.parameters()[tested[i]] - p.truth[tested[i]];
      sigma[i] = std::sqrt(p.calibration.covariance(tested[i], tested[i]));
    }
  }
  // 200 draws leave 5 % of uncertainty: four times that.
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(std::sqrt(off.row(i).squaredNorm() / kDraws) / sigma[i], 1, 0.2) << i;
}

// Without rotation a longer focal length is a deeper scene.
TEST(WindowCalibration, PureTranslationLeavesTheFocalLengthOpen) {
  Problem p(kCameras[0]);
  for (std::size_t f = 0; f < p.w.frames.size(); ++f) {
    p.w.frames[f].T_w_c.R.setIdentity();
    p.w.frames[f].T_w_c.t = {0.1 * static_cast<double>(f), 0.03 * std::sin(static_cast<double>(f)), 0};
  }
  p.observe(kCameras[0]);
  p.calibration.sigma[0] = std::numeric_limits<double>::infinity();
  p.solve();
  EXPECT_EQ(p.calibration.status, tp::Status::rank_deficient);
  EXPECT_EQ(p.calibration.covariance(0, 0), 0);
}

TEST(WindowCalibration, RefusesWhatIsNoCameraOrPrior) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int fault = 0; fault < 7; ++fault) {
    Problem p(kCameras[1]);
    if (fault == 0) p.calibration.sigma[0] = nan;
    if (fault == 1) p.calibration.sigma[4] = -1;
    if (fault == 2) p.calibration.sigma.resize(4);
    if (fault == 3) p.calibration.camera = tp::Pinhole<double>{0, 260, 160, 120};
    if (fault == 4) p.calibration.mean.setZero(3);
    if (fault == 5) p.calibration.mean.setConstant(p.truth.size(), nan);
    if (fault == 6) p.calibration.sigma[0] = 1e-200;  // its information would be infinite
    const tp::SE3d before = p.w.frames[3].T_w_c;
    EXPECT_EQ(p.solve().status, tp::Status::invalid_argument) << fault;
    EXPECT_EQ(p.w.frames[3].T_w_c.t, before.t);
  }
}

TEST(WindowCalibration, TextsAreLeftOut) {
  Noise noise(11);
  WindowScene scene;
  scene.add_frames(5);
  scene.add_points(40, noise);
  scene.texts.push_back({0, {0, 0, -0.25}, 100, 80, 180, 120});
  tp::Window w = scene.finish();
  w.frames[0].fixed = w.frames[4].fixed = true;
  tp::WindowCalibration calibration;
  calibration.camera = scene.camera;
  calibration.hold();
  calibration.sigma[0] = 10;
  w.calibration = &calibration;
  EXPECT_TRUE(tp::is_ok(tp::solve_window(w).status));
  for (const auto& k : w.text_observations) EXPECT_EQ(k.status, tp::Status::invalid_argument);
  EXPECT_EQ(w.texts[0].status, tp::Status::too_few);
}

}  // namespace window_calibration_test
}  // namespace textplane_test
