// The photometric kernels allocate nothing: every global operator new of this executable is counted.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

#include "photometry/scene.hpp"
#include "textplane/photometry/residual.hpp"

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
namespace tp = textplane;

TEST(Allocation, IsCounted) {
  const long before = allocations;
  std::vector<int> v(100);
  EXPECT_GT(allocations, before);
  EXPECT_EQ(v[5], 0);
}

TEST(Allocation, KernelsMakeNone) {
  textplane_test::Scene<std::uint8_t> scene(1);
  const auto input = scene.input();
  const tp::PhotometricOptions options;
  std::vector<double> r(scene.x.size()), J(scene.x.size() * 9);
  const long before = allocations;
  const auto pose = tp::reference::linearise_pose(input, scene.theta, scene.T_t_h, options, scene.workspace);
  const auto plane = tp::reference::linearise_plane(input, scene.theta, scene.T_t_h, options, scene.workspace);
  const auto both = tp::reference::linearise_pose_plane(input, scene.theta, scene.T_t_h, options, scene.workspace);
  const auto all = tp::reference::linearise_host_target_plane(input, scene.theta, scene.T_w_h, scene.T_w_t,
                                                              tp::PerturbationSide::left, options, scene.workspace);
  const auto cost = tp::reference::evaluate(input, scene.theta, scene.T_t_h, options, scene.workspace);
  const auto rows =
      tp::reference::residuals<9>(input, scene.theta, scene.T_t_h, options, scene.workspace, r.data(), J.data());
  const auto fast = tp::linearise_pose_plane(input, scene.theta, scene.T_t_h, options, scene.workspace);
  const auto fast_cost = tp::evaluate(input, scene.theta, scene.T_t_h, options, scene.workspace);
  scene.workspace.reserve(scene.n());
  EXPECT_EQ(allocations, before);
  for (const tp::Status status : {pose.status, plane.status, both.status, all.status, cost.status, rows.status,
                                  fast.status, fast_cost.status})
    EXPECT_EQ(status, tp::Status::ok);
}

TEST(Allocation, RebuildingAPyramidMakesNone) {
  const auto image = textplane_test::texture<std::uint8_t>(80, 60, 1);
  tp::Pyramid pyramid(image.view(), 4);
  const long before = allocations;
  EXPECT_EQ(pyramid.build(image.view(), 4), tp::Status::ok);
  EXPECT_EQ(pyramid.build(image.view(), 2), tp::Status::ok);
  EXPECT_EQ(allocations, before);
}

}  // namespace
