// Solvers allocate nothing with memory that was reserved or is used again.
#include <vector>

#include "allocation/count.hpp"
#include "solver/synthetic.hpp"
#include "solver/window_scene.hpp"
#include "support/text_wall.hpp"
#include "textplane/solver/plane.hpp"
#include "textplane/solver/pose.hpp"
#include "textplane/solver/search.hpp"
#include "textplane/solver/window.hpp"

namespace {
using textplane_test::NoAllocation;

TEST(NoAllocation, RefinePoseAndRefinePlane) {
  using namespace textplane_test::planar;
  const textplane_test::planar::Scene scene = three_signs();
  const SE3d truth = target_pose();
  const FloatPyramid image = scene.render(truth);
  std::vector<TextPatch> patches;
  std::vector<textplane::PoseTextTerm> texts;
  for (const Sign& sign : scene.signs) patches.push_back(scene.patch(sign));
  for (std::size_t i = 0; i < 3; ++i) texts.push_back({&patches[i], scene.signs[i].theta, scene.signs[i].T_w_h, 1});
  textplane_test::planar::Random random(1);
  std::vector<textplane::PosePointTerm> points(50);
  for (auto& p : points) {
    p.px.y() = random.uniform(0, 239);
    p.px.x() = random.uniform(0, 319);
    p.p_w = truth.inverse() * Vec3(3 * scene.camera.unproject(p.px));
  }
  std::vector<float> zncc(3), chi2(50);
  textplane::PoseWorkspace pose_workspace;
  pose_workspace.reserve(texts.data(), 3, 50);
  textplane::PlaneWorkspace plane_workspace;
  plane_workspace.reserve(patches[0], 1);
  const SE3d start = textplane::se3_exp<double>(Vec6::Constant(0.004)) * truth;
  const textplane::PlaneTargetF target{image.view(), truth};
  textplane::PoseFit pose;
  textplane::PlaneRefinement plane;
  {
    const NoAllocation guard;
    pose = refine_pose(texts.data(), 3, points.data(), 50, image.view(), scene.camera, start, {}, pose_workspace,
                       zncc.data(), chi2.data());
    plane = refine_plane(patches[0], scene.signs[0].theta * 1.02, &target, 1, scene.camera, {}, plane_workspace);
  }
  EXPECT_TRUE(is_ok(pose.status));
  EXPECT_GT(pose.iterations, 3);
  EXPECT_TRUE(is_ok(plane.status));
  EXPECT_GT(plane.iterations, 3);
}

// By the batch kernel.
TEST(NoAllocation, RefinePoseOfManySmallTexts) {
  namespace tp = textplane;
  const textplane_test::TextWall wall;
  tp::TextMap map(wall.camera);
  wall.fill(map, 9);
  std::vector<tp::TextPatch> patches;
  for (const tp::TextObject& text : map.objects()) {
    patches.push_back(text.patch);
    textplane_test::keep_pixels(patches.back(), 30);
  }
  std::vector<tp::PoseTextTerm> texts;
  for (const tp::TextPatch& patch : patches) texts.push_back({&patch, map.objects()[0].theta, tp::SE3d()});
  tp::PoseWorkspace workspace;
  workspace.reserve(texts.data(), 9, 0);
  tp::PoseFit pose;
  {
    const NoAllocation guard;
    pose = tp::refine_pose(texts.data(), 9, nullptr, 0, wall.frame.view(), wall.camera, wall.start, {}, workspace);
  }
  EXPECT_EQ(pose.texts, 9);
  EXPECT_EQ(pose.path, tp::Path::kernel);
}

TEST(NoAllocation, SolveWindowAgain) {
  namespace tp = textplane;
  textplane_test::WindowScene scene;
  textplane_test::Noise noise(3);
  scene.add_frames(6);
  scene.add_points(60, noise);
  textplane_test::add_signs(scene);
  tp::Window& truth = scene.finish();
  truth.frames[0].fixed = truth.frames[5].fixed = true;
  tp::Window first = truth, second = truth;
  textplane_test::perturb(first, noise, 0.004, 0.02, 0.02);
  textplane_test::perturb(second, noise, 0.004, 0.02, 0.02);
  tp::WindowWorkspace workspace;
  const tp::WindowOptions options;
  EXPECT_TRUE(tp::is_ok(tp::solve_window(first, options, workspace).status));
  tp::WindowSummary summary;
  {
    const NoAllocation guard;
    summary = tp::solve_window(second, options, workspace);
  }
  EXPECT_TRUE(tp::is_ok(summary.status));
  EXPECT_GT(summary.iterations, 2);
}

}  // namespace
