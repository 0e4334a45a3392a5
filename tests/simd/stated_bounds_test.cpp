// The bounds that simd/residual.hpp and simd/batch.hpp state, on what is hardest for them: white noise, whose gradient
// changes by its own size within a pixel, under any pose, with few and many pixels, on every target.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "photometry/scene.hpp"
#include "support/targets.hpp"
#include "textplane/photometry/text_batch.hpp"

namespace stated_bounds_test {
namespace tp = textplane;
using namespace textplane_test;

#if !defined(TEXTPLANE_TEST_SCENES)
#define TEXTPLANE_TEST_SCENES 48
#endif

// Of entries of H and b, in units of sqrt(F_ii F_jj) and sqrt(F_ii), and of costs.
constexpr double kEntries = 5e-4, kCosts = 1e-4, kCostFloor = 1e-5;

// Noise in a target, and host pixels within 128 px whose samples lie 1e-4 px clear of the pixel lines.
struct Noisy : Scene<std::uint8_t> {
  Noisy(unsigned seed, int pixels) : Scene<std::uint8_t>(seed, 1) {
    Random random(seed * 31 + 5);
    for (int j = 0; j < kHeight; ++j)
      for (int i = 0; i < kWidth; ++i) image(i, j) = static_cast<std::uint8_t>(random.integer(0, 255));
    x.clear();
    y.clear();
    intensity.clear();
    const double reach = random.uniform(4, 64), noise = random.uniform(1, 60);
    const double cx = random.uniform(70, 130), cy = random.uniform(60, 100);
    for (int tries = 0; static_cast<int>(x.size()) < pixels && tries < 100 * pixels; ++tries) {
      const double px = std::floor(cx + random.uniform(-reach, reach)),
                   py = std::floor(cy + random.uniform(-reach, reach));
      const tp::Vector2<double> at = project(px, py);
      const double dx = at[0] - std::floor(at[0]), dy = at[1] - std::floor(at[1]);
      if (!image.view().contains(at[0], at[1]) || dx < 1e-4 || dx > 0.9999 || dy < 1e-4 || dy > 0.9999) continue;
      double value = 0;
      tp::sample_bilinear(view(), at[0], at[1], &value);
      x.push_back(static_cast<float>(px));
      y.push_back(static_cast<float>(py));
      intensity.push_back(static_cast<float>(0.8 * value + 15 + random.uniform(-noise, noise)));
    }
    workspace.reserve(n());
  }
};

// Every cost and normalisation; deltas of 0.1 and more.
std::vector<tp::PhotometricOptions> options(unsigned seed) {
  Random random(seed);
  const double delta = 0.1 * std::pow(10, random.uniform(0, 1.3));
  std::vector<tp::PhotometricOptions> all;
  for (const auto normalisation : {tp::Normalisation::exact, tp::Normalisation::frozen})
    for (const auto kind : {tp::RobustKind::l2, tp::RobustKind::huber, tp::RobustKind::cauchy, tp::RobustKind::tukey}) {
      tp::PhotometricOptions o;
      o.normalisation = normalisation;
      o.robust = {kind, delta};
      o.min_visible = 1;
      o.min_contrast = 0;
      all.push_back(o);
    }
  return all;
}

// The largest errors seen, in units of the bounds.
struct Worst {
  double entry = 0, cost = 0;
  void report(const std::string& what) const {
    ::testing::Test::RecordProperty(what, std::to_string(entry) + ' ' + std::to_string(cost));
    EXPECT_LE(entry, 1) << what;
    EXPECT_LE(cost, 1) << what;
    // Nothing of the bounds is given away.
    EXPECT_GT(entry, 0.02) << what;
  }
};

template <int P>
void compare(const tp::NormalEquations<P>& fast, const tp::NormalEquations<P>& exact, const tp::NormalEquations<P>& F,
             double entries, double costs, Worst* worst) {
  ASSERT_EQ(fast.status, exact.status);
  if (!tp::is_ok(exact.status)) return;
  ASSERT_EQ(fast.visible, exact.visible);
  for (int i = 0; i < P; ++i) {
    const double size = std::sqrt(F.H(i, i));
    worst->entry = std::max(worst->entry, std::abs(fast.b[i] - exact.b[i]) / (entries * size));
    for (int j = 0; j < P; ++j)
      worst->entry =
          std::max(worst->entry, std::abs(fast.H(i, j) - exact.H(i, j)) / (entries * size * std::sqrt(F.H(j, j))));
  }
  worst->cost = std::max({worst->cost, std::abs(fast.cost - exact.cost) / (costs * exact.cost + kCostFloor),
                          std::abs(fast.error - exact.error) / (costs * exact.error + kCostFloor)});
}

template <int P>
struct Compared {
  Worst one, batch;

  void add(Noisy& scene, unsigned seed) {
    constexpr tp::Parameters kUnknowns = unknowns<P>();
    tp::TextBatchItem item;
    item.patch = scene.input().patch;
    item.host_camera = scene.host_camera;
    item.theta = scene.theta;
    const tp::TextBatch packed(&item, 1);
    tp::TextBatchResult result(packed);
    for (const tp::PhotometricOptions& o : options(seed)) {
      tp::PhotometricOptions plain = o;
      plain.normalisation = tp::Normalisation::frozen;
      if (tp::weighs_all(o.robust.kind)) plain.robust = {tp::RobustKind::l2, 1};
      const auto F = tp::reference::linearise<kUnknowns>(scene.request(plain), scene.workspace);
      const auto exact = tp::reference::linearise<kUnknowns>(scene.request(o), scene.workspace);
      for (const simd::Target target : testable_targets()) {
        const TargetScope scope(target);
        const auto fast = tp::linearise<kUnknowns>(scene.request(o), scene.workspace);
        if (fast.path == tp::Path::kernel) compare<P>(fast, exact, F, kEntries, kCosts, &one);
        if constexpr (P != 3) {
          if (scene.n() > 256) continue;
          tp::linearise_batch<kUnknowns>(packed, scene.view(), scene.target_camera, &scene.T_t_h, o, result);
          compare<P>(result.normal_equations<kUnknowns>(0), exact, F, kEntries, kCosts, &batch);
        }
      }
    }
  }
};

TEST(StatedBounds, HoldOnWhiteNoise) {
  Compared<3> plane;
  Compared<6> pose;
  Compared<9> both;
  const int sizes[] = {4, 9, 15, 20, 31, 64, 100, 256, 700};
  for (unsigned seed = 1; seed <= TEXTPLANE_TEST_SCENES; ++seed) {
    SCOPED_TRACE(seed);
    Noisy scene(seed, sizes[seed % 9]);
    if (scene.n() < 4) continue;
    plane.add(scene, seed);
    pose.add(scene, seed);
    both.add(scene, seed);
  }
  plane.one.report("plane");
  pose.one.report("pose");
  both.one.report("pose_plane");
  pose.batch.report("batch_pose");
  both.batch.report("batch_pose_plane");
}

}  // namespace stated_bounds_test
