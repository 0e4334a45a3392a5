// What the residual kernels hold for visible behind a lens, on every target, against the double reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "simd/lens/cases.hpp"
#include "simd/policy_support.hpp"
#include "simd/residual_support.hpp"

namespace lens_borders_test {
namespace tp = textplane;
using namespace textplane_test;
using Scene8 = Scene<std::uint8_t>;

// Part of the patch outside the image, masks, and trials on a given set.
TEST(LensBorders, MasksAndBorders) {
  Random random(11);
  for (int trial = 0; trial < 80; ++trial) {
    SCOPED_TRACE(trial);
    const int n = trial % 3 == 0 ? random.integer(1, 40) : random.integer(41, 700);
    const std::vector<LensCase> all = lens_cases();
    const LensCase& c = all[static_cast<std::size_t>(trial) % all.size()];
    const Scene8 scene(static_cast<unsigned>(trial + 1), n, &c.lens, c.zoom);
    const int x = random.integer(0, 150), y = random.integer(0, 110);
    const int width = random.integer(2, 200 - x), height = random.integer(2, 160 - y);
    tp::PhotometricInput in = scene.input();
    in.target = tp::ImageView8(&in.target(x, y), width, height, in.target.stride());
    in.target_camera.cx -= x;
    in.target_camera.cy -= y;
    std::vector<std::uint8_t> mask(static_cast<std::size_t>(n));
    for (auto& m : mask) m = static_cast<std::uint8_t>(random.integer(0, 3) * 85);
    if (trial % 4 != 0) in.patch.mask = mask.data();
    tp::PhotometricOptions o = any_options(trial % 2 == 0);
    o.min_visible = random.integer(0, 20);
    compare_all(in, scene.theta, scene.T_t_h, o, kLensFactor);
    compare_cost(in, scene.theta, scene.T_t_h, any_options(), mask.data());
  }
}

// Where the lens folds over, what lies beyond has no pixel, on either path.
TEST(LensBorders, BeyondTheFoldNothingIsVisible) {
  const tp::LensMap folded = lens_of<tp::RadialTangential<double>>({-0.8, 0, 0, 0, 0});
  EXPECT_NEAR(folded.max_r2(), 1 / 2.4, 1e-5);
  int lost = 0;
  for (int trial = 0; trial < 20; ++trial) {
    SCOPED_TRACE(trial);
    Scene8 scene(static_cast<unsigned>(trial + 1), 300);
    tp::PhotometricInput in = scene.input();
    in.lens = &folded;
    in.host_camera.fx = in.host_camera.fy = in.target_camera.fx = in.target_camera.fy = 60;
    std::vector<std::uint8_t> mask(300);
    for (std::size_t i = 0; i < 300; ++i) {
      const tp::Vector3<double> m =
          in.host_camera.unproject({static_cast<double>(scene.x[i]), static_cast<double>(scene.y[i])});
      const tp::Vector3<double> q = scene.T_t_h.R * m + scene.T_t_h.t * scene.theta.dot(m);
      const tp::Vector2<double> ray(q[0] / q[2], q[1] / q[2]), at = in.target_camera.pixel(folded.distort(ray));
      const auto on_line = [](double v) { return std::abs(v - std::round(v)) < 2e-3; };
      mask[i] = !on_line(at[0]) && !on_line(at[1]) && std::abs(ray.squaredNorm() - folded.max_r2()) > 1e-3;
      lost += mask[i] && ray.squaredNorm() > folded.max_r2();
    }
    in.patch.mask = mask.data();
    compare_all(in, scene.theta, scene.T_t_h, any_options(), kLensFactor);
  }
  EXPECT_GT(lost, 100);
}

TEST(LensBorders, EveryBorder) {
  for (const tp::simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    for (const LensCase& c : lens_cases())
      for (const double way : {-0.03, 0.03, -0.04, 0.04}) {
        PolicyScene s(4, 60, &c.lens, c.zoom);
        std::fill(s.x.begin(), s.x.end(), 97.0F);  // narrower than it is high
        for (int i = 0; i < 40; ++i) {
          s.T_t_h.t[std::abs(way) < 0.035 ? 0 : 1] += way;
          ASSERT_EQ(tp::evaluate(s.request(), s.workspace).visible,
                    tp::reference::evaluate(s.request(), s.workspace).visible);
        }
      }
  }
}

// A side of a patch that the lens bends out of the image, farthest between the places where it is looked at.
TEST(LensBorders, BulgingBorders) {
  for (const LensCase& c : lens_cases()) {
    SCOPED_TRACE(c.name);
    Scene8 scene(6, 400, &c.lens, c.zoom);
    for (std::size_t i = 0; i < 400; ++i) {
      scene.x[i] = static_cast<float>(40 + i % 133);
      scene.y[i] = static_cast<float>(20 + i / 133);
    }
    tp::PhotometricInput in = scene.input();
    tp::PhotometricWorkspace workspace(400);
    double top = 1e9;
    for (std::size_t i = 0; i < 400; ++i) {
      const tp::Vector3<double> m =
          in.host_camera.unproject({static_cast<double>(scene.x[i]), static_cast<double>(scene.y[i])});
      top = std::min(top, in.target_camera.pixel(c.lens.distort({m[0], m[1]}))[1]);
    }
    const double cy = in.target_camera.cy - top;
    int in_part = 0;
    for (const tp::simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      SCOPED_TRACE(tp::simd::to_string(target));
      for (int step = 1; step < 60; ++step) {
        in.target_camera.cy = cy - 0.005 * step;
        const tp::ResidualRequest request{in, {0, 0, 1}, tp::SE3d(), tp::PhotometricOptions()};
        const int visible = tp::reference::evaluate(request, workspace).visible;
        ASSERT_EQ(tp::evaluate(request, workspace).visible, visible);
        in_part += visible > 300 && visible < 400;
      }
    }
    EXPECT_GT(in_part, 20);
  }
}

}  // namespace lens_borders_test
