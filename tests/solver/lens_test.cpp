// The solvers on images behind a lens: they find what they find on undistorted images.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "solver/pose_scene.hpp"
#include "solver/window_scene.hpp"
#include "textplane/features/select.hpp"
#include "textplane/solver/plane.hpp"
#include "textplane/solver/search.hpp"

namespace lens_test {
using namespace textplane_test::planar;
using textplane::CameraView;
using textplane::LensMap;
using textplane::Status;
namespace tp = textplane;

const LensMap& radial_tangential() {
  static const LensMap map(tp::RadialTangential<double>{{}, -0.28, 0.07, 1e-3, -5e-4, 0});
  return map;
}
const LensMap& fisheye() {
  static const LensMap map(tp::KannalaBrandt<double>{{}, 0.01, -0.003, 0.002, -0.001});
  return map;
}
const std::vector<const LensMap*> kLenses = {&radial_tangential(), &fisheye()};

tp::Image<std::uint8_t> bytes(const Image<float>& from) {
  Image<std::uint8_t> to(from.width(), from.height());
  for (int y = 0; y < to.height(); ++y)
    for (int x = 0; x < to.width(); ++x) to(x, y) = static_cast<std::uint8_t>(std::lround(from(x, y)));
  return to;
}

// Three signs rendered behind a lens, with points; patches are made of what the host sees, behind the lens too.
struct Input {
  Scene scene = three_signs();
  SE3d truth = target_pose();
  tp::Pyramid target;
  std::vector<TextPatch> patches;
  std::vector<tp::PoseTextTerm> texts;
  std::vector<tp::PosePointTerm> points;

  explicit Input(const LensMap* lens) {
    scene.lens = lens;
    target = tp::Pyramid(bytes(scene.render(truth).levels[0]).view(), 3);
    for (const Sign& sign : scene.signs) {
      const tp::Pyramid host(bytes(scene.render(sign.T_w_h.inverse()).levels[0]).view(), 3);
      tp::Quad<double> quad;
      std::size_t i = 0;
      for (const Vec2& corner :
           {Vec2(sign.x0, sign.y0), Vec2(sign.x1, sign.y0), Vec2(sign.x1, sign.y1), Vec2(sign.x0, sign.y1)})
        quad.corner[i++] = scene.view().pixel(scene.camera.unproject(corner).head<2>());
      patches.push_back(tp::make_patch(host.view(), scene.view(), quad));
    }
    for (std::size_t i = 0; i < patches.size(); ++i)
      texts.push_back({&patches[i], scene.signs[i].theta, scene.signs[i].T_w_h, 1});
    Random random(5);
    while (points.size() < 60) {
      const double x = random.uniform(-0.6, 0.6), y = random.uniform(-0.45, 0.45), z = random.uniform(1.5, 6);
      const Vec3 p(z * x, z * y, z);
      if (!scene.view().in_domain(p)) continue;
      points.push_back({truth.inverse() * p, scene.view().project(p)});
    }
  }
  tp::PoseFit solve(const SE3d& start, int text_count, int point_count) {
    tp::PoseWorkspace workspace;
    workspace.reserve(texts.data(), text_count, point_count);
    return refine_pose(texts.data(), text_count, points.data(), point_count, target.view(), scene.view(), start,
                       tp::PoseOptions{}, workspace);
  }
};

TEST(Lens, PatchesKeepStraightPositions) {
  for (const LensMap* lens : kLenses) {
    Input input(lens);
    for (std::size_t k = 0; k < 3; ++k) {
      const TextPatch& patch = input.patches[k];
      const Sign& sign = input.scene.signs[k];
      ASSERT_EQ(patch.status, Status::ok);
      EXPECT_NEAR(patch.quad.corner[0][0], sign.x0, 1e-9);
      EXPECT_NEAR(patch.quad.corner[2][1], sign.y1, 1e-9);
      const Texture texture(sign.seed);
      const tp::PatchLevel& level = patch.levels[0];
      double worst = 0, along = 0, size = 0;
      for (std::size_t i = 0; i < level.x.size(); ++i) {
        const auto value = [&](double x, double y) {
          const Vec3 m = input.scene.camera.unproject({x, y});
          return texture(m[0], m[1]);
        };
        const double x = level.x[i], y = level.y[i];
        worst = std::max(worst, std::abs(value(x, y) - static_cast<double>(level.intensity[i])));
        const double gx = (value(x + 0.5, y) - value(x - 0.5, y)), gy = value(x, y + 0.5) - value(x, y - 0.5);
        along += gx * static_cast<double>(level.gx[i]) + gy * static_cast<double>(level.gy[i]);
        size += gx * gx + gy * gy;
      }
      EXPECT_LT(worst, 0.51) << "grey levels: rounding to bytes";
      EXPECT_NEAR(along / size, 1, 0.05) << "gradients of the undistorted image";
    }
  }
}

TEST(Lens, PosesByTextsPointsAndBoth) {
  Random random(3);
  for (const LensMap* lens : kLenses) {
    Input input(lens);
    for (int trial = 0; trial < 5; ++trial) {
      const SE3d start = tp::se3_exp<double>(random.twist(0.01, 0.008)) * input.truth;
      const tp::PoseFit points = input.solve(start, 0, 60);
      EXPECT_LT(pose_distance(points.T_t_w, input.truth), 1e-7);
      EXPECT_EQ(points.inlier_points, 60);
      for (const int n : {0, 60}) {
        const tp::PoseFit fit = input.solve(start, 3, n);
        EXPECT_TRUE(is_ok(fit.status)) << to_string(fit.status);
        EXPECT_EQ(fit.path, tp::Path::kernel);
        for (const Sign& sign : input.scene.signs)
          EXPECT_LT(input.scene.corner_error(sign, fit.T_t_w, input.truth), 0.05) << "px";
        EXPECT_GT(fit.zncc, 0.99);
      }
    }
  }
}

// Given without its lens, the same images give another pose: the test above can fail.
TEST(Lens, MattersForThePose) {
  Input input(&radial_tangential());
  input.scene.lens = nullptr;
  const tp::PoseFit fit = input.solve(input.truth, 3, 0);
  double worst = 0;
  for (const Sign& sign : input.scene.signs)
    worst = std::max(worst, input.scene.corner_error(sign, fit.T_t_w, input.truth));
  EXPECT_GT(worst, 1);
}

TEST(Lens, PlanesAndSearches) {
  for (const LensMap* lens : kLenses) {
    Input input(lens);
    const Sign& sign = input.scene.signs[0];
    const auto plane =
        align_plane(input.patches[0], Vec3(1.03 * sign.theta), input.truth, input.target.view(), input.scene.view());
    EXPECT_TRUE(is_ok(plane.status)) << to_string(plane.status);
    EXPECT_LT((plane.theta - sign.theta).norm(), 0.01 * sign.theta.norm());

    Vec6 xi;
    xi << 0, 0, 0, 0.05, -0.06, 0.02;
    tp::PhotometricWorkspace workspace(input.patches[0].max_pixels());
    float zncc = 0;
    const SE3d found =
        search_pose(input.patches[0], sign.theta, tp::se3_exp<double>(xi) * input.truth, input.target.view(),
                    input.scene.view(), tp::SearchOptions{}, workspace, nullptr, &zncc);
    EXPECT_GT(zncc, 0.6);
    EXPECT_LT(input.scene.corner_error(sign, found, input.truth), 4) << "px";
    const tp::PoseAlignment pose =
        align_pose(input.patches[0], sign.theta, found, input.target.view(), input.scene.view());
    EXPECT_TRUE(is_ok(pose.status)) << to_string(pose.status);
    EXPECT_LT(input.scene.corner_error(sign, pose.T_t_h, input.truth), 0.1) << "px";
  }
}

TEST(Lens, WindowsOfPointsAndTexts) {
  for (const LensMap* lens : kLenses) {
    textplane_test::WindowScene scene;
    scene.lens = lens;
    textplane_test::Noise noise(4);
    scene.add_frames(4);
    scene.add_points(40, noise);
    textplane_test::add_signs(scene);
    tp::Window truth = scene.finish();
    ASSERT_GT(truth.point_observations.size(), 100U);
    truth.frames[0].fixed = truth.frames[1].fixed = true;
    tp::Window w = truth;
    textplane_test::perturb(w, noise, 0.005, 0.02, 0.02);
    const tp::WindowSummary summary = tp::solve_window(w, {});
    EXPECT_TRUE(is_ok(summary.status)) << to_string(summary.status);
    EXPECT_EQ(summary.path, tp::Path::kernel);
    const auto left = textplane_test::distance(w, truth);
    EXPECT_LT(left.position, 2e-3);
    EXPECT_LT(left.rotation, 5e-4);
    EXPECT_LT(left.theta, 0.02);
    for (const tp::WindowText& text : w.texts) EXPECT_GT(text.zncc, 0.99);
  }
}

}  // namespace lens_test
