// refine_plane() and align_plane(): recovery of theta, its covariance, and what they say about targets that show no
// parallax.
#include "textplane/solver/plane.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "solver/synthetic.hpp"

namespace plane_test {
using namespace textplane_test::planar;
using textplane::PlaneOptions;
using textplane::PlaneRefinement;
using textplane::PlaneTargetF;
using textplane::PlaneWorkspace;
using textplane::Status;

const double kNan = std::numeric_limits<double>::quiet_NaN();

// The first sign from several poses. With `exact` the host values are those of the first target's interpolant, so that
// the cost with this target alone is zero at the truth.
struct Input {
  Scene scene = three_signs();
  Sign sign;
  std::vector<SE3d> poses;
  std::vector<FloatPyramid> images;
  std::vector<PlaneTargetF> targets;
  TextPatch patch;
  PlaneWorkspace workspace;

  explicit Input(bool exact, int count = 1) {
    scene.signs.resize(1);
    sign = scene.signs[0];
    const double motion[4][6] = {{0.12, -0.06, 0.09, -0.03, 0.05, 0.02},
                                 {-0.1, 0.12, -0.05, 0.06, 0.03, -0.02},
                                 {0.05, 0.15, 0.1, 0.05, -0.01, 0.03},
                                 {0.2, 0.02, -0.1, 0, 0.1, 0}};
    for (int i = 0; i < count; ++i) poses.push_back(textplane::se3_exp<double>(Vec6(motion[i])));
    for (const SE3d& T : poses) images.push_back(scene.render(T));
    bind();
    patch = exact ? scene.exact_patch(sign, images[0], poses[0]) : scene.patch(sign);
  }
  void bind() {
    targets.clear();
    for (std::size_t i = 0; i < poses.size(); ++i) targets.push_back({images[i].view(), poses[i]});
  }
  PlaneRefinement solve(const Vec3& theta, const PlaneOptions& options = {}) {
    const int n = static_cast<int>(targets.size());
    workspace.reserve(patch, n);
    return refine_plane(patch, theta, targets.data(), n, scene.camera, options, workspace);
  }
};

PlaneOptions tight() {
  PlaneOptions options;
  options.solve.max_iterations = 50;
  options.solve.cost_tolerance = 0;
  options.solve.step_tolerance = 1e-11;
  return options;
}

Vec3 perturbed(const Vec3& theta, Random& random, double share) { return theta + random.normal3(share * theta.norm()); }

double angle(const Vec3& a, const Vec3& b) { return std::acos(std::min(1.0, a.normalized().dot(b.normalized()))); }

TEST(RefinePlane, OneTargetGivesThetaBack) {
  Input input(true);
  Random random(1);
  for (int trial = 0; trial < 10; ++trial) {
    const PlaneRefinement fit = input.solve(perturbed(input.sign.theta, random, 0.05), tight());
    EXPECT_EQ(fit.status, Status::converged) << to_string(fit.status);
    EXPECT_LT((fit.theta - input.sign.theta).norm(), 1e-5 * input.sign.theta.norm());
    EXPECT_EQ(fit.targets_used, 1);
    EXPECT_GT(fit.zncc, 1 - 1e-9);
  }
}

TEST(RefinePlane, ManyTargetsOfAnIndependentRendering) {
  Input input(false, 4);
  Random random(2);
  for (int trial = 0; trial < 5; ++trial) {
    const Vec3 start = perturbed(input.sign.theta, random, 0.05);
    const PlaneRefinement fit = input.solve(start);
    EXPECT_TRUE(is_ok(fit.status));
    EXPECT_EQ(fit.targets_used, 4);
    // What bilinear interpolation leaves of a texture with wavelengths from 17 px on.
    EXPECT_LT((fit.theta - input.sign.theta).norm(), 3e-3 * input.sign.theta.norm());
    EXPECT_LT(angle(fit.theta, input.sign.theta), 0.3 * 3.14159 / 180);
    EXPECT_GT(fit.zncc, 0.995);
    EXPECT_LT((fit.covariance * fit.information - Eigen::Matrix3d::Identity()).norm(), 1e-6);
  }
}

// Where it begins shows in the last digits of where it ends.
TEST(RefinePlane, BeginsOnTheLevelOfAQuarterOfTheSize) {
  Input input(true);
  ASSERT_EQ(input.patch.level_count(), 3);
  Random random(6);
  const Vec3 start = perturbed(input.sign.theta, random, 0.05);
  PlaneOptions quarter, half;
  quarter.coarsest_level = 2;
  half.coarsest_level = 1;
  EXPECT_EQ(input.solve(start).theta, input.solve(start, quarter).theta);
  EXPECT_NE(input.solve(start).theta, input.solve(start, half).theta);
}

TEST(RefinePlane, SaysWhatComputedItsTargets) {
  Input input(false, 1);
  PlaneOptions options;
  for (const int iterations : {0, 20}) {
    options.solve.max_iterations = iterations;
    EXPECT_EQ(input.solve(input.sign.theta, options).path, textplane::Path::reference) << iterations;
  }
}

TEST(RefinePlane, MoreTargetsLowerTheCovariance) {
  Input one(false, 1), four(false, 4);
  EXPECT_LT(four.solve(four.sign.theta).covariance.trace(), one.solve(one.sign.theta).covariance.trace());
}

TEST(RefinePlane, AlignPlaneOnAnEightBitImage) {
  Input input(false, 1);
  Image<std::uint8_t> image(Scene::kWidth, Scene::kHeight);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      image(x, y) = static_cast<std::uint8_t>(std::lround(input.images[0].levels[0](x, y)));
  const textplane::Pyramid target(image.view(), 3);
  Random random(3);
  const PlaneRefinement fit =
      align_plane(input.patch, perturbed(input.sign.theta, random, 0.03), input.poses[0], target, input.scene.camera);
  EXPECT_TRUE(is_ok(fit.status)) << to_string(fit.status);
  EXPECT_LT((fit.theta - input.sign.theta).norm(), 0.01 * input.sign.theta.norm());
}

TEST(RefinePlane, GainAndBiasDoNotMatter) {
  Input input(false, 2);
  Random random(4);
  const Vec3 start = perturbed(input.sign.theta, random, 0.05);
  const PlaneRefinement fit = input.solve(start, tight());
  Input changed(false, 2);
  changed.images[0] = input.images[0].map([](double v) { return 0.5 * v + 33; });
  changed.images[1] = input.images[1].map([](double v) { return 3 * v - 17; });
  changed.bind();
  const PlaneRefinement other = changed.solve(start, tight());
  EXPECT_LT((fit.theta - other.theta).norm(), 1e-9);
  EXPECT_NEAR(fit.covariance.trace(), other.covariance.trace(), 1e-9 * fit.covariance.trace());
}

// White noise of a level that the solver is not told: it must find it in the residuals.
TEST(RefinePlane, CovarianceIsThatOfTheNoise) {
  Input clean(true);
  for (const double noise : {3.0, 9.0}) {
    Random random(5);
    double sum = 0;
    const int trials = 250;
    PlaneOptions options = tight();
    options.solve.step_tolerance = 1e-8;
    options.photometric.robust.kind = textplane::RobustKind::l2;
    options.coarsest_level = 0;
    double variance = 0;
    for (int trial = 0; trial < trials; ++trial) {
      Input input = clean;
      input.bind();
      for (float& v : input.patch.levels[0].intensity) v += static_cast<float>(noise * random.normal());
      const PlaneRefinement fit = input.solve(clean.sign.theta, options);
      ASSERT_TRUE(is_ok(fit.status));
      const Vec3 e = fit.theta - clean.sign.theta;
      sum += e.dot(fit.information * e) / trials;
      variance += fit.residual_variance / trials;
    }
    // Mean of 250 draws of chi-square with 3 degrees of freedom: 3 +- 0.155.
    EXPECT_NEAR(sum, 3, 0.6);
    EXPECT_NEAR(std::sqrt(variance), noise / 28, 0.3 * noise / 28);
  }
}

TEST(RefinePlane, TargetsThatDoNotSeeTheSignAreSkipped) {
  Input input(false, 2);
  const PlaneRefinement expected = input.solve(input.sign.theta, tight());
  SE3d away = input.poses[0], broken = input.poses[0];
  away.t[0] += 100;
  broken.t[0] = kNan;
  input.targets.insert(input.targets.begin(), {input.images[0].view(), away});
  input.targets.push_back({input.images[0].view(), broken});
  input.targets.push_back({textplane::PyramidViewF(), input.poses[0]});
  const PlaneRefinement fit = input.solve(input.sign.theta, tight());
  EXPECT_EQ(fit.status, Status::converged);
  EXPECT_EQ(fit.targets_used, 2);
  EXPECT_LT((fit.theta - expected.theta).norm(), 1e-12);
}

TEST(RefinePlane, ATargetMayHaveAPatchOfItsOwn) {
  Input input(true, 3);
  Random random(4);
  const Vec3 start = perturbed(input.sign.theta, random, 0.03);
  // Where all targets have the right patch, the one in the call counts for nothing.
  const PlaneRefinement want = input.solve(start, tight());
  const TextPatch right = input.patch;
  for (PlaneTargetF& target : input.targets) target.patch = &right;
  for (textplane::PatchLevel& level : input.patch.levels)
    std::fill(level.intensity.begin(), level.intensity.end(), 9.0F);
  const PlaneRefinement fit = input.solve(start, tight());
  EXPECT_EQ(fit.status, want.status);
  EXPECT_EQ(fit.theta, want.theta);
  EXPECT_EQ(fit.targets_used, 3);
  // One of another size is not used.
  TextPatch shorter = right;
  shorter.levels[0].x.pop_back();
  shorter.levels[0].y.pop_back();
  shorter.levels[0].intensity.pop_back();
  input.targets[1].patch = &shorter;
  EXPECT_EQ(input.solve(start, tight()).targets_used, 2);
  TextPatch lower = right;
  lower.levels.pop_back();
  input.targets[2].patch = &lower;
  EXPECT_EQ(input.solve(start, tight()).targets_used, 1);
}

TEST(RefinePlane, InputThatNoPlaneComesFromGetsAStatus) {
  Input input(false, 1);
  const Vec3 theta = input.sign.theta;
  const auto run = [&](const Vec3& start, const PlaneOptions& options = {}) {
    const PlaneRefinement fit = input.solve(start, options);
    EXPECT_FALSE(is_ok(fit.status));
    EXPECT_TRUE(fit.covariance.isZero());
    if (textplane::all_finite(start)) {
      EXPECT_EQ(fit.theta, start);
    }
    return fit.status;
  };
  EXPECT_EQ(refine_plane(input.patch, theta, input.targets.data(), 1, input.scene.camera, {}, input.workspace).status,
            Status::invalid_argument);  // Nothing reserved.
  EXPECT_EQ(run(Vec3(0, kNan, 1)), Status::non_finite);
  EXPECT_EQ(run(-theta), Status::behind_camera);
  PlaneOptions options;
  options.photometric.robust.delta = -1;
  EXPECT_EQ(run(theta, options), Status::invalid_argument);
  options = {};
  options.finest_level = -1;
  EXPECT_EQ(run(theta, options), Status::invalid_argument);
  // A rotation shows no parallax, and neither does a target at the host.
  input.targets[0].T_t_h = SE3d();
  EXPECT_EQ(run(theta), Status::rank_deficient);
  input.targets[0].T_t_h.R = textplane::so3_exp<double>(Vec3(0.01, 0.02, 0));
  EXPECT_EQ(run(theta), Status::rank_deficient);
  input.targets[0].T_t_h = input.poses[0];
  input.targets[0].T_t_h.t[0] += 100;
  EXPECT_EQ(run(theta), Status::out_of_view);
  input.targets[0].T_t_h = input.poses[0];
  const FloatPyramid flat = input.images[0].map([](double) { return 9.0; });
  input.targets[0].image = flat.view();
  EXPECT_EQ(run(theta), Status::no_contrast);
  input.targets.clear();
  EXPECT_EQ(run(theta), Status::invalid_argument);
  EXPECT_EQ(refine_plane(input.patch, theta, static_cast<const PlaneTargetF*>(nullptr), 1, input.scene.camera, {},
                         input.workspace)
                .status,
            Status::invalid_argument);
  const TextPatch empty;
  Input other(false, 1);
  EXPECT_FALSE(
      is_ok(refine_plane(empty, theta, other.targets.data(), 1, other.scene.camera, {}, other.workspace).status));
}
}  // namespace plane_test
