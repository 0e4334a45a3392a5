// refine_pose() and align_pose(): recovery, invariance, weights, and cost.
#include "textplane/solver/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "solver/pose_scene.hpp"

namespace pose_test {
using textplane::Evaluation;
using textplane::Robust;
using textplane::RobustKind;
using textplane::Status;
using textplane::Weighting;

TEST(RefinePose, TextAlonePointsAloneAndBothRecoverThePose) {
  Input input;
  Random random(3);
  for (int trial = 0; trial < 10; ++trial) {
    // About 4 px at these distances.
    const SE3d start = textplane::se3_exp<double>(random.twist(0.01, 0.008)) * input.truth;
    for (const bool text : {true, false})
      for (const bool point : {true, false}) {
        if (!text && !point) continue;
        const PoseFit fit = input.solve(start, tight(), text, point);
        // Points are exact in double, patches in float.
        EXPECT_LT(pose_distance(fit.T_t_w, input.truth), text ? 1e-6 : 1e-10) << text << point << trial;
        EXPECT_EQ(fit.status, Status::converged) << to_string(fit.status);
        EXPECT_EQ(fit.texts, text ? 3 : 0);
        EXPECT_EQ(fit.inlier_points, point ? 60 : 0);
        if (text) {
          EXPECT_GT(fit.zncc, 1 - 1e-9);
        }
      }
  }
}

TEST(RefinePose, RecoversThePoseOfAnIndependentRendering) {
  Input input(false);
  Random random(8);
  for (int trial = 0; trial < 5; ++trial) {
    const SE3d start = textplane::se3_exp<double>(random.twist(0.012, 0.01)) * input.truth;
    const PoseFit fit = input.solve(start, {}, true, false);
    EXPECT_TRUE(is_ok(fit.status)) << to_string(fit.status);
    for (const Sign& sign : input.scene.signs) EXPECT_LT(input.scene.corner_error(sign, fit.T_t_w, input.truth), 0.03);
    EXPECT_GT(fit.zncc, 0.995);
  }
}

TEST(RefinePose, DefaultsNeedFewIterations) {
  Input input(false);
  Random random(9);
  for (int trial = 0; trial < 5; ++trial) {
    const PoseFit fit = input.solve(textplane::se3_exp<double>(random.twist(0.01, 0.008)) * input.truth);
    EXPECT_EQ(fit.status, Status::converged);
    EXPECT_LE(fit.iterations, 30);
  }
}

TEST(RefinePose, OnePatchWithTheReadmeSurface) {
  Input input(false);
  const Sign& sign = input.scene.signs[0];
  Image<std::uint8_t> image(Scene::kWidth, Scene::kHeight);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      image(x, y) = static_cast<std::uint8_t>(std::lround(input.target.levels[0](x, y)));
  const textplane::Pyramid target(image.view(), 3);
  Random random(4);
  const SE3d start = textplane::se3_exp<double>(random.twist(0.005, 0.004)) * input.truth;
  const auto fit = align_pose(input.patches[0], sign.theta, start, target, input.scene.camera);
  EXPECT_TRUE(is_ok(fit.status)) << to_string(fit.status);
  EXPECT_LT(input.scene.corner_error(sign, fit.T_t_h, input.truth), 0.1);
  EXPECT_GT(input.scene.corner_error(sign, start, input.truth), 0.5);
  EXPECT_GT(fit.zncc, 0.99);
  EXPECT_EQ(fit.texts, 1);
  EXPECT_GT((fit.information.diagonal().minCoeff()), 0);
}

TEST(RefinePose, GainAndBiasOfEitherSideDoNotMatter) {
  Input input(false, 0);
  Random random(6);
  const SE3d start = textplane::se3_exp<double>(random.twist(0.01, 0.008)) * input.truth;
  const PoseFit fit = input.solve(start, tight());
  ASSERT_EQ(fit.status, Status::converged);
  for (const double gain : {0.5, 1.5, 3.0})
    for (const double bias : {-40.0, 0.0, 77.0}) {
      Input changed(false, 0);
      changed.target = input.target.map([&](double v) { return gain * v + bias; });
      const PoseFit of_target = changed.solve(start, tight());
      EXPECT_LT(pose_distance(of_target.T_t_w, fit.T_t_w), 1e-9);
      EXPECT_NEAR(of_target.cost, fit.cost, 1e-9 * fit.cost);
      changed.target = input.target;
      for (std::size_t i = 0; i < changed.patches.size(); ++i)
        for (auto& level : changed.patches[i].levels)
          for (float& v : level.intensity) v = static_cast<float>(gain * static_cast<double>(v) + bias);
      EXPECT_LT(pose_distance(changed.solve(start, tight()).T_t_w, fit.T_t_w), 1e-9);
    }
}

TEST(RefinePose, OutliersAmongPointsAreWithstood) {
  for (const RobustKind kind : {RobustKind::huber, RobustKind::tukey}) {
    Input input(true, 100, 0.2);
    Random random(2);
    for (std::size_t i = 0; i < 20; ++i) {
      const double dx = random.uniform(10, 60), dy = random.uniform(-40, 40);
      input.points[i].px += Vec2(dx, dy);
    }
    PoseOptions options;
    options.solve.max_iterations = 60;
    // Tukey forgets what is far away, so it starts near.
    options.point_robust = kind == RobustKind::huber ? Robust{kind, 1.0} : Robust{kind, 8.0};
    std::vector<float> chi2(100);
    const PoseFit fit = input.solve(textplane::se3_exp<double>(random.twist(0.004, 0.003)) * input.truth, options,
                                    false, true, nullptr, chi2.data());
    EXPECT_TRUE(is_ok(fit.status));
    EXPECT_LT(pose_distance(fit.T_t_w, input.truth), kind == RobustKind::huber ? 0.01 : 0.002);
    EXPECT_EQ(fit.inlier_points, 80);
    for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(chi2[i] > 5.99F, i < 20);
  }
}

// Points with sigma 1 px and pixels with the noise that sigma_photo says: 6 = E[e^T information e] for each source and
// for both.
TEST(RefinePose, InformationIsThatOfTheNoise) {
  for (const int mode : {0, 1, 2}) {
    double sum = 0;
    const int trials = 120;
    for (int trial = 0; trial < trials; ++trial) {
      Input input(true, 40, 0.7, static_cast<unsigned>(100 + trial));
      Random random(static_cast<unsigned>(900 + trial));
      PoseOptions options = tight();
      options.solve.step_tolerance = 1e-8;
      options.photometric.robust.kind = RobustKind::l2;
      options.point_robust.kind = RobustKind::l2;
      options.sigma_rep = 0.7;
      // White noise on the host values: r sqrt(N) then has its deviation over the contrast of the sign. sigma_photo is
      // for a contrast of 28, the weights say what that of each sign is.
      const double noise = 4, contrast = 28;
      options.sigma_photo = noise / contrast;
      for (std::size_t i = 0; i < input.patches.size(); ++i) {
        auto& values = input.patches[i].levels[0].intensity;
        const auto stats = textplane::intensity_stats(values.data(), nullptr, static_cast<int>(values.size()));
        input.texts[i].weight = stats.s * stats.s / stats.n / (contrast * contrast);
        for (float& v : values) v += static_cast<float>(noise * random.normal());
      }
      options.coarsest_level = 0;
      const PoseFit fit = input.solve(input.truth, options, mode != 1, mode != 0);
      ASSERT_TRUE(is_ok(fit.status));
      const Vec6 e = textplane::se3_log<double>(fit.T_t_w * input.truth.inverse());
      sum += e.dot(fit.information * e) / trials;
    }
    // The mean of 120 draws of chi-square with 6 degrees of freedom deviates by 0.32.
    EXPECT_NEAR(sum, 6, 1) << mode;
  }
}

// The joint cost is better than either source alone, with both weightings, when the sources are as noisy as they say.
TEST(RefinePose, BothSourcesTogetherBeatEach) {
  for (const Weighting weighting : {Weighting::variance, Weighting::paper}) {
    double text = 0, point = 0, both = 0;
    for (int trial = 0; trial < 25; ++trial) {
      Input input(true, 60, 1, static_cast<unsigned>(40 + trial));
      Random random(static_cast<unsigned>(70 + trial));
      for (auto& patch : input.patches)
        for (auto& level : patch.levels)
          for (float& v : level.intensity) v += static_cast<float>(12 * random.normal());
      PoseOptions options;
      options.weighting = weighting;
      options.sigma_photo = weighting == Weighting::variance ? 0.3 : 0.09;
      const auto error = [&](const PoseFit& fit) {
        double sum = 0;
        for (const PosePointTerm& p : input.points)
          sum += (input.scene.camera.project(fit.T_t_w * p.p_w) - input.scene.camera.project(input.truth * p.p_w))
                     .squaredNorm();
        return sum;
      };
      text += error(input.solve(input.truth, options, true, false));
      point += error(input.solve(input.truth, options, false, true));
      both += error(input.solve(input.truth, options, true, true));
    }
    EXPECT_LT(both, text);
    EXPECT_LT(both, point);
  }
}

// Forwards to a PoseProblem and checks each promise of the iteration.
struct Watched {
  using Inner = textplane::detail::PoseProblem<textplane::PyramidViewF>;
  using State = SE3d;
  static constexpr int kParameters = 6;
  Inner& inner;
  double linearised = -1, evaluated = -1, lost = 0;
  SE3d trial;
  int accepted = 0;

  textplane::detail::PoseSystem linearise(const SE3d& T) noexcept {
    if (evaluated >= 0 && (T.t - trial.t).norm() == 0 && (T.R - trial.R).norm() == 0) {
      EXPECT_LT(evaluated, linearised);
      EXPECT_LE(lost, 0.1);
      ++accepted;
    }
    const auto system = inner.linearise(T);
    linearised = system.cost;
    return system;
  }
  Evaluation evaluate(const SE3d& T) noexcept {
    trial = T;
    const Evaluation e = inner.evaluate(T);
    evaluated = e.cost;
    lost = e.lost_fraction;
    return e;
  }
  SE3d retract(const SE3d& T, const Vec6& xi) const noexcept { return inner.retract(T, xi); }
};

TEST(RefinePose, CostNeverRises) {
  Input input(false, 20, 1);
  Random random(12);
  input.workspace.reserve(input.texts.data(), 3, 20);
  const PoseOptions options = tight();
  const textplane::PyramidViewF view = input.target.view();
  int accepted = 0, changed_sets = 0;
  for (int trial = 0; trial < 60; ++trial) {
    // Up to gross errors: signs leave the image, and steps overshoot.
    const double size = 0.01 * (1 + trial);
    SE3d T = textplane::se3_exp<double>(random.twist(size, 0.5 * size)) * input.truth;
    Watched::Inner inner(input.texts.data(), 3, input.points.data(), 20, view, input.scene.camera, options,
                         input.workspace);
    inner.set_level(trial % 3);
    Watched problem{inner, -1, -1, 0, SE3d(), 0};
    const auto summary = minimise(problem, T, options.solve);
    EXPECT_TRUE(all_finite(T));
    EXPECT_GE(summary.reduction, 0);
    EXPECT_EQ(problem.accepted, summary.accepted);
    accepted += problem.accepted;
    const double by_sets = summary.initial_cost - summary.reduction - summary.final_cost;
    changed_sets += std::abs(by_sets) > 1e-6 * summary.initial_cost;
  }
  EXPECT_GT(accepted, 100);
  EXPECT_GT(changed_sets, 5);  // The promise was put to the test.
}

// b is half the gradient of the cost that evaluate() returns, robust kernels and both weightings included.
TEST(RefinePose, GradientIsThatOfTheCost) {
  Input input(false, 30, 3);
  Random random(21);
  input.workspace.reserve(input.texts.data(), 3, 30);
  input.points[3].sigma = 1.7;
  input.texts[1].weight = 0.4;
  for (const Weighting weighting : {Weighting::variance, Weighting::paper})
    for (const bool text : {true, false}) {
      PoseOptions options;
      options.weighting = weighting;
      const textplane::PyramidViewF view = input.target.view();
      Watched::Inner problem(input.texts.data(), text ? 3 : 0, input.points.data(), text ? 0 : 30, view,
                             input.scene.camera, options, input.workspace);
      const SE3d T = textplane::se3_exp<double>(random.twist(0.004, 0.003)) * input.truth;
      const auto system = problem.linearise(T);
      EXPECT_NEAR(problem.evaluate(T).cost, system.cost, 1e-12 * system.cost);
      // A step so small that hardly a sample changes its pixel cell.
      const double h = text ? 1e-7 : 1e-6;
      for (int i = 0; i < 6; ++i) {
        const double numeric = (problem.evaluate(problem.retract(T, h * Vec6::Unit(i))).cost -
                                problem.evaluate(problem.retract(T, -h * Vec6::Unit(i))).cost) /
                               (2 * h);
        EXPECT_NEAR(numeric, 2 * system.b[i], (text ? 1e-5 : 1e-7) * 2 * system.b.norm()) << i << text;
      }
    }
}

TEST(RefinePose, PixelsThatLeaveTheImageAreCharged) {
  Input input(false, 0);
  input.texts.resize(1);
  input.workspace.reserve(input.texts.data(), 1, 0);
  PoseOptions options;
  const textplane::PyramidViewF view = input.target.view();
  Watched::Inner problem(input.texts.data(), 1, nullptr, 0, view, input.scene.camera, options, input.workspace);
  const auto system = problem.linearise(input.truth);
  ASSERT_TRUE(is_ok(system.status));
  double last = 0;
  for (const double shift : {0.2, 0.35, 0.5, 0.65}) {
    // To the left, out of the image.
    const Evaluation e = problem.evaluate(problem.retract(input.truth, Vec6(-shift * Vec6::Unit(4))));
    EXPECT_GE(e.lost_fraction, last);
    EXPECT_GT(e.cost, system.cost);
    last = e.lost_fraction;
  }
  EXPECT_EQ(last, 1);
}

}  // namespace pose_test
