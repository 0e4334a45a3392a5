// No scale is systematically too small, or too large: OpenCV's ECC has this fault (its issues 29774 and 29781), which
// blurs template and image over their own borders first. Ours compares pixels as they are, and must not move from the
// truth where it starts there, on one level or through a pyramid, also where the template is all of the host image.
//
// What is left is bilinear interpolation, whose error is e = u (1 - u) I_xx / 2 + v (1 - v) I_yy / 2 at the fractions
// u, v of a pixel. The error of the scale is sum e (x . grad I) / sum (x . grad I)^2 over the template, x from its
// middle. Where the picture is as rough everywhere its mean is zero; with fractions evenly spread, its standard
// deviation is sqrt(0.0213 r 12 / (n (w^2 + h^2))), r = E I_xx^2 / E I_x^2, were pixels independent. For Waves r is
// 0.40, which gives 2e-5.
#include <gtest/gtest.h>

#include <cstdio>
#include <utility>

#include "solver/bias/scale_trials.hpp"
#include "textplane/photometry/residual_policy.hpp"
#include "textplane/solver/pose.hpp"

namespace scale_bias_test {

using namespace textplane_test;
using Pixels = std::vector<std::vector<tp::Vector2<float>>>;

constexpr int kTrials = 24, kLevels = 3;
constexpr double kDeviation = 4e-5;  // twice the above: pixels are not independent
constexpr double kBias = 2e-5;       // four standard errors of kTrials; ECC's bias on these images is 1e-3
constexpr double kCorners = 0.02;    // px; a scale error of 2.7e-4 and no other

// The template's quad in a host with `border` px around it, and its pixels on each level.
tp::Quad<double> quad_of(int border) {
  const double first = border, right = first + ScaleTrial::kColumns - 1, bottom = first + ScaleTrial::kRows - 1;
  tp::Quad<double> quad;
  quad.corner = {tp::Vector2<double>(first, first), tp::Vector2<double>(right, first),
                 tp::Vector2<double>(right, bottom), tp::Vector2<double>(first, bottom)};
  return quad;
}
Pixels pixels_of(int border) {
  Pixels pixels(kLevels);
  for (int l = 0; l < kLevels; ++l)
    for (int y = border >> l; y < (border + ScaleTrial::kRows) >> l; ++y)
      for (int x = border >> l; x < (border + ScaleTrial::kColumns) >> l; ++x)
        pixels[static_cast<std::size_t>(l)].push_back({static_cast<float>(x), static_cast<float>(y)});
  return pixels;
}

// The levels of an image and a patch of all of the template, for both types of pixels.
struct Bytes {
  using Pixel = std::uint8_t;
  tp::Pyramid pyramid;
  explicit Bytes(const tp::Image<std::uint8_t>& image) : pyramid(image.view(), kLevels) {}
  tp::PyramidView view() const { return pyramid.view(); }
  tp::TextPatch patch(const tp::Pinhole<double>& camera, int border) const {
    return tp::patch_from_pixels(view(), camera, quad_of(border), pixels_of(border));
  }
};

struct Floats {
  using Pixel = float;
  std::vector<tp::Image<float>> images;
  explicit Floats(const tp::Image<float>& image) : images{image} {
    for (int l = 1; l < kLevels; ++l) {
      const tp::Image<float>& fine = images.back();
      tp::Image<float> half(fine.width() / 2, fine.height() / 2);
      for (int y = 0; y < half.height(); ++y)
        for (int x = 0; x < half.width(); ++x)
          half(x, y) = 0.25F * (fine(2 * x, 2 * y) + fine(2 * x + 1, 2 * y) + fine(2 * x, 2 * y + 1) +
                                fine(2 * x + 1, 2 * y + 1));
      images.push_back(half);
    }
  }
  tp::PyramidViewF view() const {
    tp::PyramidViewF out;
    for (const tp::Image<float>& image : images) out.level[static_cast<std::size_t>(out.levels++)] = image.view();
    return out;
  }
  tp::TextPatch patch(const tp::Pinhole<double>& camera, int border) const {
    tp::TextPatch out;
    out.quad = quad_of(border);
    out.camera = camera;
    out.area = ScaleTrial::kColumns * ScaleTrial::kRows;
    out.status = tp::Status::ok;
    const Pixels pixels = pixels_of(border);
    for (std::size_t l = 0; l < pixels.size(); ++l) {
      tp::PatchLevel level;
      for (const tp::Vector2<float>& px : pixels[l]) {
        level.x.push_back(px[0]);
        level.y.push_back(px[1]);
        level.intensity.push_back(images[l](static_cast<int>(px[0]), static_cast<int>(px[1])));
      }
      level.find_bounds();
      out.levels.push_back(level);
    }
    return out;
  }
};

tp::Pinhole<double> host_camera(const ScaleTrial& trial, int border) {
  tp::Pinhole<double> camera = trial.host_camera;
  camera.cx += border;
  camera.cy += border;
  return camera;
}

struct Result {
  std::vector<double> scale;
  double worst_corners = 0;

  void add(const ScaleTrial& trial, const tp::Matrix3<double>& H) {
    scale.push_back(trial.scale_error(H));
    worst_corners = std::max(worst_corners, trial.corner_error(H));
  }
  // `allowed`: a bias that has a known cause.
  void expect_no_bias(const char* what, double allowed = 0) const {
    const Bias bias(scale);
    std::printf("%s: scale %+.1e, standard error %.1e, deviation %.1e; corners %.4f px at worst\n", what, bias.mean,
                bias.standard_error, bias.deviation, worst_corners);
    EXPECT_LT(std::abs(bias.mean), 4 * bias.standard_error + allowed) << what;
    EXPECT_LT(std::abs(bias.mean), kBias + allowed) << what;
    EXPECT_LT(bias.deviation, kDeviation) << what;
    EXPECT_LT(worst_corners, kCorners) << what;
  }
};

// align_pose() from the truth and from near: half a pixel on one level, two through the pyramid.
template <class Levels>
void poses_have_no_bias(bool tilted, int border) {
  using T = typename Levels::Pixel;
  Result at_truth, near, coarse_to_fine_at_truth, coarse_to_fine;
  for (unsigned seed = 1; seed <= kTrials; ++seed) {
    ScaleTrial trial(seed, tilted);
    const Levels host(trial.host<T>(border)), target(trial.target<T>());
    const tp::TextPatch patch = host.patch(host_camera(trial, border), border);
    ASSERT_EQ(patch.status, tp::Status::ok);
    const auto run = [&](int levels, const tp::SE3d& start, Result* result) {
      tp::PoseOptions options;
      options.coarsest_level = levels - 1;
      const auto fit = tp::align_pose(patch, trial.theta, start, target.view(), trial.target_camera, options);
      EXPECT_TRUE(tp::is_ok(fit.status)) << tp::to_string(fit.status) << ", seed " << seed;
      result->add(trial, trial.homography(fit.T_t_h, trial.theta));
    };
    run(1, trial.T_t_h, &at_truth);
    run(1, trial.start(0.5), &near);
    run(kLevels, trial.T_t_h, &coarse_to_fine_at_truth);
    run(kLevels, trial.start(2), &coarse_to_fine);
  }
  at_truth.expect_no_bias("one level, from the truth");
  near.expect_no_bias("one level, from 0.5 px");
  coarse_to_fine_at_truth.expect_no_bias("three levels, from the truth");
  coarse_to_fine.expect_no_bias("three levels, from 2 px");
}

TEST(ScaleBias, SimilarityTheTemplateFillsTheHost) { poses_have_no_bias<Bytes>(false, 0); }
TEST(ScaleBias, HomographyTheTemplateFillsTheHost) { poses_have_no_bias<Bytes>(true, 0); }
TEST(ScaleBias, HomographyTheHostShowsMore) { poses_have_no_bias<Bytes>(true, ScaleTrial::kMargin); }
TEST(ScaleBias, SimilarityTheTemplateFillsTheHostFloat) { poses_have_no_bias<Floats>(false, 0); }
TEST(ScaleBias, HomographyTheTemplateFillsTheHostFloat) { poses_have_no_bias<Floats>(true, 0); }

// Gauss-Newton by pose and plane, all eight degrees of a homography. A little damping fixes the scale of t and
// 1 / theta, which no image tells.
tp::Matrix3<double> align_homography(const ScaleTrial& trial, const tp::TextPatch& patch, const tp::PyramidView& target,
                                     tp::LinearisePolicy policy, tp::PhotometricWorkspace& workspace) {
  tp::TemplatePatch prepared;
  prepared.prepare(patch.levels[0].view());
  const tp::PhotometricInput in = tp::photometric_input(patch, 0, target, trial.target_camera);
  tp::SE3d T = trial.T_t_h;
  tp::Vector3<double> theta = trial.theta;
  for (int i = 0; i < 12; ++i) {
    const tp::ResidualRequest request{in, theta, T};
    auto e = tp::linearise<tp::Parameters::pose_plane>(request.by(policy, &prepared), workspace);
    EXPECT_TRUE(tp::is_ok(e.status));
    e.H.diagonal() *= 1 + 1e-4;
    const Eigen::Matrix<double, 9, 1> step = -tp::Ldlt<double, 9>(e.H).solve(e.b);
    T = tp::se3_exp<double>(step.head<6>()) * T;
    theta += step.tail<3>();
  }
  return trial.homography(T, theta);
}

// Host gradients have one side only at the border of the host image: they miss by I_xx / 2 there, and the mean of
// e I_xx / 2 = I_xx^2 / 24 along the border makes the scale r / (w^2 + h^2) too large; half as much with ESM, which
// takes half of its gradients from the host.
double border_bias(tp::LinearisePolicy policy, int border) {
  constexpr double kRough = 0.40, kAll = kRough / (ScaleTrial::kColumns * ScaleTrial::kColumns +
                                                   ScaleTrial::kRows * ScaleTrial::kRows);
  if (border > 0) return 0;
  return policy == tp::LinearisePolicy::template_jacobian ? kAll : policy == tp::LinearisePolicy::esm ? 0.5 * kAll : 0;
}

void homographies_have_no_bias(int border) {
  const std::pair<tp::LinearisePolicy, const char*> policies[] = {
      {tp::LinearisePolicy::forward, "forward"},
      {tp::LinearisePolicy::template_jacobian, "template Jacobian"},
      {tp::LinearisePolicy::esm, "ESM"},
      {tp::LinearisePolicy::hybrid, "hybrid"}};
  tp::PhotometricWorkspace workspace(ScaleTrial::kColumns * ScaleTrial::kRows);
  for (const auto& [policy, name] : policies) {
    Result result;
    for (unsigned seed = 1; seed <= kTrials; ++seed) {
      const ScaleTrial trial(seed, true);
      const Bytes host(trial.host<std::uint8_t>(border)), target(trial.target<std::uint8_t>());
      const tp::TextPatch patch = host.patch(host_camera(trial, border), border);
      result.add(trial, align_homography(trial, patch, target.view(), policy, workspace));
    }
    result.expect_no_bias(name, border_bias(policy, border));
  }
}

TEST(ScaleBias, PoseAndPlaneTheTemplateFillsTheHost) { homographies_have_no_bias(0); }
TEST(ScaleBias, PoseAndPlaneTheHostShowsMore) { homographies_have_no_bias(ScaleTrial::kMargin); }

}  // namespace scale_bias_test
