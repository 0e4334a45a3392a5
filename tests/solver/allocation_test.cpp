// The solvers allocate nothing: every global operator new of this executable is counted.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

#include "solver/synthetic.hpp"
#include "textplane/solver/plane.hpp"
#include "textplane/solver/pose.hpp"

namespace {
std::atomic<long> allocations{0};

void* counted(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size > 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }

namespace {
using namespace textplane_test::planar;

TEST(Allocation, IsCounted) {
  const long before = allocations;
  std::vector<int> v(100);
  EXPECT_GT(allocations, before);
  EXPECT_EQ(v[5], 0);
}

TEST(Allocation, RefinePoseAndRefinePlaneMakeNone) {
  const Scene scene = three_signs();
  const SE3d truth = target_pose();
  const FloatPyramid image = scene.render(truth);
  std::vector<TextPatch> patches;
  std::vector<textplane::PoseTextTerm> texts;
  for (const Sign& sign : scene.signs) patches.push_back(scene.patch(sign));
  for (std::size_t i = 0; i < 3; ++i) texts.push_back({&patches[i], scene.signs[i].theta, scene.signs[i].T_w_h, 1});
  Random random(1);
  std::vector<textplane::PosePointTerm> points(50);
  for (auto& p : points) {
    p.px = Vec2(random.uniform(0, 319), random.uniform(0, 239));
    p.p_w = truth.inverse() * Vec3(3 * scene.camera.unproject(p.px));
  }
  std::vector<float> zncc(3), chi2(50);
  textplane::PoseWorkspace pose_workspace;
  pose_workspace.reserve(texts.data(), 3, 50);
  textplane::PlaneWorkspace plane_workspace;
  plane_workspace.reserve(patches[0], 1);
  const SE3d start = textplane::se3_exp<double>(Vec6::Constant(0.004)) * truth;
  const textplane::PlaneTargetF target{image.view(), truth};

  const long before = allocations;
  const auto pose = refine_pose(texts.data(), 3, points.data(), 50, image.view(), scene.camera, start, {},
                                pose_workspace, zncc.data(), chi2.data());
  const auto plane =
      refine_plane(patches[0], scene.signs[0].theta * 1.02, &target, 1, scene.camera, {}, plane_workspace);
  const long after = allocations;
  EXPECT_EQ(after, before);
  EXPECT_TRUE(is_ok(pose.status));
  EXPECT_GT(pose.iterations, 3);
  EXPECT_TRUE(is_ok(plane.status));
  EXPECT_GT(plane.iterations, 3);
}
}  // namespace
