// Policies of refine_pose() and search_pose(), on 8-bit images with prepared patches.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "solver/synthetic.hpp"
#include "textplane/solver/pose.hpp"
#include "textplane/solver/search.hpp"

namespace policy_test {
using namespace textplane_test::planar;
namespace tp = textplane;
using tp::LinearisePolicy;

tp::Pyramid bytes(const FloatPyramid& image) {
  const Image<float>& from = image.levels[0];
  Image<std::uint8_t> out(from.width(), from.height());
  for (int y = 0; y < from.height(); ++y)
    for (int x = 0; x < from.width(); ++x)
      out(x, y) = static_cast<std::uint8_t>(std::min(std::max(std::floor(from(x, y) + 0.5F), 0.0F), 255.0F));
  return tp::Pyramid(out.view(), Scene::kLevels);
}

// The signs as a system has them: pixels of 8-bit host images, with gradients, prepared.
struct Input {
  Scene scene = three_signs();
  SE3d truth = target_pose();
  tp::Pyramid target = bytes(scene.render(truth));
  std::vector<TextPatch> patches;
  std::vector<std::vector<tp::TemplatePatch>> prepared;
  std::vector<tp::PoseTextTerm> texts;
  tp::PoseWorkspace workspace;

  Input() {
    for (const Sign& sign : scene.signs) {
      const tp::Pyramid host = bytes(scene.render(sign.T_w_h.inverse()));
      const TextPatch shape = scene.patch(sign);
      std::vector<std::vector<tp::Vector2<float>>> pixels(shape.levels.size());
      for (std::size_t l = 0; l < pixels.size(); ++l)
        for (std::size_t i = 0; i < shape.levels[l].x.size(); ++i)
          pixels[l].push_back({shape.levels[l].x[i], shape.levels[l].y[i]});
      patches.push_back(tp::patch_from_pixels(host.view(), scene.camera, shape.quad, pixels));
    }
    for (const TextPatch& patch : patches) {
      prepared.emplace_back(patch.levels.size());
      for (std::size_t l = 0; l < patch.levels.size(); ++l) prepared.back()[l].prepare(patch.levels[l].view());
    }
    for (std::size_t i = 0; i < patches.size(); ++i) {
      tp::PoseTextTerm term;
      term.patch = &patches[i];
      term.theta = scene.signs[i].theta;
      term.T_w_h = scene.signs[i].T_w_h;
      texts.push_back(term);
    }
    workspace.reserve(texts.data(), 3, 0);
  }

  tp::PoseFit solve(const SE3d& start, LinearisePolicy policy, bool with_prepared) {
    for (std::size_t i = 0; i < texts.size(); ++i) texts[i].prepared = with_prepared ? prepared[i].data() : nullptr;
    tp::PoseOptions options;
    options.policy = policy;
    return tp::refine_pose(texts.data(), 3, nullptr, 0, target.view(), scene.camera, start, options, workspace);
  }
  double error(const SE3d& pose) const {
    double worst = 0;
    for (const Sign& sign : scene.signs) worst = std::max(worst, scene.corner_error(sign, pose, truth));
    return worst;
  }
  // One sign, and the pose of the target from its host.
  SE3d T_t_h(std::size_t i) const { return truth * scene.signs[i].T_w_h; }
  double error(std::size_t i, const SE3d& pose_t_h) const {
    return scene.corner_error(scene.signs[i], pose_t_h * scene.signs[i].T_w_h.inverse(), truth);
  }
};

TEST(Policy, EveryPolicyFindsTheSamePose) {
  Input input;
  Random random(3);
  for (int trial = 0; trial < 5; ++trial) {
    const SE3d start = tp::se3_exp<double>(random.twist(0.01, 0.008)) * input.truth;
    EXPECT_GT(input.error(start), 0.5);
    const tp::PoseFit forward = input.solve(start, LinearisePolicy::forward, false);
    ASSERT_EQ(forward.status, tp::Status::converged);
    EXPECT_LT(input.error(forward.T_t_w), 0.05);
    for (const auto policy : {LinearisePolicy::template_jacobian, LinearisePolicy::esm, LinearisePolicy::hybrid,
                              LinearisePolicy::automatic})
      for (const bool prepared : {true, false}) {
        SCOPED_TRACE(static_cast<int>(policy));
        const tp::PoseFit fit = input.solve(start, policy, prepared);
        EXPECT_TRUE(tp::is_ok(fit.status)) << tp::to_string(fit.status);
        EXPECT_LT(input.error(fit.T_t_w), 0.06);
        EXPECT_LT(fit.cost, forward.cost * 1.02);
        EXPECT_EQ(fit.texts, 3);
      }
  }
}

// The gradient of the cost is the same, so is its minimum.
TEST(Policy, HybridEndsWhereForwardEnds) {
  Input input;
  for (const TextPatch& patch : input.patches) ASSERT_GT(patch.levels[0].view().n, tp::kHybridPixels);
  Random random(7);
  for (int trial = 0; trial < 10; ++trial) {
    const SE3d start = tp::se3_exp<double>(random.twist(0.01, 0.008)) * input.truth;
    const tp::PoseFit forward = input.solve(start, LinearisePolicy::forward, true);
    const tp::PoseFit hybrid = input.solve(start, LinearisePolicy::hybrid, true);
    ASSERT_EQ(forward.status, tp::Status::converged);
    ASSERT_EQ(hybrid.status, tp::Status::converged);
    EXPECT_FALSE(hybrid.information.isApprox(forward.information, 1e-9)) << "forward's matrix was taken";
    for (const Sign& sign : input.scene.signs)
      EXPECT_LT(input.scene.corner_error(sign, hybrid.T_t_w, forward.T_t_w), 0.01) << "px";
    EXPECT_LE(hybrid.iterations, forward.iterations * 3 / 2 + 2);
  }
}

TEST(Policy, WithoutGradientsItIsForward) {
  Input input;
  const SE3d start = tp::se3_exp<double>(Vec6::Constant(0.004)) * input.truth;
  for (TextPatch& patch : input.patches)
    for (tp::PatchLevel& level : patch.levels) level.gx.clear();
  const tp::PoseFit forward = input.solve(start, LinearisePolicy::forward, false);
  const tp::PoseFit esm = input.solve(start, LinearisePolicy::esm, false);
  EXPECT_EQ(forward.T_t_w.t, esm.T_t_w.t);
  EXPECT_EQ(forward.iterations, esm.iterations);
}

TEST(Policy, OneThatDoesNotExistIsInvalid) {
  Input input;
  EXPECT_EQ(input.solve(input.truth, static_cast<LinearisePolicy>(9), false).status, tp::Status::invalid_argument);
}

TEST(SearchPose, BringsADistantGuessNear) {
  Input input;
  tp::PhotometricWorkspace workspace(input.patches[0].max_pixels());
  for (std::size_t i = 0; i < 3; ++i) {
    workspace.reserve(input.patches[i].max_pixels());
    for (int direction = 0; direction < 8; ++direction) {
      const double angle = direction * 0.785398163397448;
      Vec6 xi = Vec6::Zero();
      xi[3] = 0.045 * std::sin(angle);  // about 12 px
      xi[4] = 0.045 * std::cos(angle);
      const SE3d guess = tp::se3_exp<double>(xi) * input.T_t_h(i);
      ASSERT_GT(input.error(i, guess), 8);
      for (const bool prepared : {true, false}) {
        float zncc = 0;
        const SE3d found =
            tp::search_pose(input.patches[i], input.scene.signs[i].theta, guess, input.target.view(),
                            input.scene.camera, {}, workspace, prepared ? input.prepared[i].data() : nullptr, &zncc);
        // Half a step of one px of level 2 along each axis, and what turning the camera distorts.
        EXPECT_LT(input.error(i, found), 3.6) << i << ' ' << direction;
        EXPECT_GT(zncc, 0.5F);
      }
    }
  }
}

// The rotation by `angle` about an axis.
SE3d rotation(const Vec3& axis, double angle) {
  SE3d T;
  T.R = tp::so3_exp<double>(Vec3(angle * axis.normalized()));
  return T;
}

// A shift turns the sign's ray to another without a roll about either; a roll turns about the ray. Guesses that are off
// by just that are brought back to the pose itself, not to one that is also turned otherwise.
TEST(SearchPose, ShiftsWithoutRollAndRollsAboutTheRay) {
  Input input;
  tp::PhotometricWorkspace workspace;
  const double step = 4 / input.scene.camera.fx;  // rad: a px of level 2
  for (std::size_t i = 0; i < 3; ++i) {
    SCOPED_TRACE(i);
    const SE3d truth = input.T_t_h(i);
    workspace.reserve(input.patches[i].max_pixels());
    const auto search = [&](const SE3d& guess, const tp::SearchOptions& options) {
      return tp::search_pose(input.patches[i], input.scene.signs[i].theta, guess, input.target.view(),
                             input.scene.camera, options, workspace);
    };
    const Vec3 m = input.scene.camera.unproject(tp::centroid(input.patches[i].quad));
    const Vec3 ray = truth * Vec3(m / input.scene.signs[i].theta.dot(m));
    for (const auto& [x, y] : {std::pair<int, int>{3, 0}, {0, 3}, {-3, 2}, {2, 3}, {-2, -3}}) {
      const Vec3 shifted = ray / ray[2] + Vec3(x * step, y * step, 0);
      const SE3d guess =
          rotation(shifted.cross(ray), std::acos(shifted.normalized().dot(ray.normalized()))).inverse() * truth;
      tp::SearchOptions options;
      options.roll = 0;
      // Half a step along one axis would be 8e-3.
      EXPECT_LT(tp::so3_log<double>((search(guess, options) * truth.inverse()).R).norm(), 5e-3) << x << ' ' << y;
    }
    for (const double roll : {-0.1, -0.05, 0.05, 0.1}) {
      tp::SearchOptions options;
      options.radius = 0;
      const SE3d found = search(rotation(ray, -roll) * truth, options);
      EXPECT_LT(tp::so3_log<double>((found * truth.inverse()).R).norm(), 2e-3) << roll;
    }
  }
}

// Twice the largest int is none: too few pixels on every level, so the finest.
TEST(SearchPose, TheLevelForAnyMinimum) {
  const Input input;
  tp::SearchOptions options;
  options.level = std::numeric_limits<int>::max();
  EXPECT_EQ(tp::search_level(input.patches[0], 3, options), 2);
  for (const int least : {std::numeric_limits<int>::max(), std::numeric_limits<int>::max() / 2 + 1}) {
    options.photometric.min_visible = least;
    EXPECT_EQ(tp::search_level(input.patches[0], 3, options), 0);
  }
  const int pixels = static_cast<int>(input.patches[0].levels[2].x.size());
  options.photometric.min_visible = pixels / 2;
  EXPECT_EQ(tp::search_level(input.patches[0], 3, options), 2);
  options.photometric.min_visible = pixels / 2 + 1;
  EXPECT_LT(tp::search_level(input.patches[0], 3, options), 2);
}

TEST(SearchPose, KeepsTheGuessWhereNothingIsBetter) {
  Input input;
  tp::PhotometricWorkspace workspace(input.patches[0].max_pixels());
  const auto search = [&](const Vec3& theta, const SE3d& T, const tp::SearchOptions& options, float* zncc) {
    return tp::search_pose(input.patches[0], theta, T, input.target.view(), input.scene.camera, options, workspace,
                           nullptr, zncc);
  };
  const Vec3 theta = input.scene.signs[0].theta;
  const SE3d truth = input.T_t_h(0);
  float zncc = 0;
  SE3d found = search(theta, truth, {}, &zncc);
  EXPECT_EQ(found.R, truth.R);
  EXPECT_EQ(found.t, truth.t);
  EXPECT_GT(zncc, 0.9F);

  SE3d away = truth;
  away.t[0] += 100;
  found = search(theta, away, {}, &zncc);
  EXPECT_EQ(found.t, away.t);
  EXPECT_EQ(zncc, -1.0F);

  const double nan = std::numeric_limits<double>::quiet_NaN();
  found = search(Vec3(nan, 0, 0), truth, {}, &zncc);
  EXPECT_EQ(found.R, truth.R);
  EXPECT_EQ(zncc, -1.0F);
  tp::SearchOptions options;
  options.step = nan;
  found = search(theta, truth, options, &zncc);
  EXPECT_EQ(found.R, truth.R);
  options = {};
  options.level = -1;
  found = search(theta, truth, options, &zncc);
  EXPECT_EQ(found.R, truth.R);
  TextPatch empty;
  found = tp::search_pose(empty, theta, truth, input.target.view(), input.scene.camera, {}, workspace);
  EXPECT_EQ(found.R, truth.R);
}

}  // namespace policy_test
