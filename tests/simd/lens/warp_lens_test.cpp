// Warps out of images behind a lens, on every target, against the double reference.
#include <gtest/gtest.h>

#include <cmath>

#include "photometry/scene.hpp"
#include "support/targets.hpp"
#include "textplane/photometry/lens/warp_lens.hpp"

namespace warp_lens_test {
namespace tp = textplane;
using namespace textplane_test;

const tp::LensMap kLenses[] = {tp::LensMap(tp::RadialTangential<double>{{}, -0.28, 0.07, 2e-3, -1e-3, 0.01}),
                               tp::LensMap(tp::KannalaBrandt<double>{{}, 0.01, -0.003, 0.002, -0.001}),
                               tp::LensMap(tp::DoubleSphere<double>{{}, -0.2, 0.6})};
const tp::Pinhole<double> kCamera(150, 148, 159.2, 118.7);

// From output pixels to rays: a view turned by up to half a radian.
tp::Matrix3<double> rays(Random& random, double zoom) {
  const tp::Matrix3<double> R = tp::so3_exp<double>(
      tp::Vector3<double>(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-3, 3)));
  tp::Matrix3<double> K;
  K << zoom, 0, -70 * zoom, 0, zoom, -30 * zoom, 0, 0, 1;
  return R * K;
}

TEST(WarpLens, AsTheReference) {
  const auto image = texture<std::uint8_t>(320, 240, 3);
  Random random(7);
  int whole = 0, partly = 0;
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const tp::CameraView camera(kCamera, &kLenses[trial % 3]);
    const int width = random.integer(1, 300), height = random.integer(1, 70);
    const tp::Matrix3<double> H = rays(random, trial % 2 == 0 ? 0.004 : 0.012);
    tp::Image<double> exact(width, height);
    tp::Image<std::uint8_t> exact_mask(width, height);
    const tp::WarpSummary want =
        tp::reference::warp_patch<double>(image.view(), camera, H, exact.view(), 77, exact_mask.view());
    whole += want.inside == width * height;
    partly += want.inside > 0 && want.inside < width * height;
    for (const simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      SCOPED_TRACE(simd::to_string(target));
      tp::Image<float> floats(width, height);
      tp::Image<std::uint8_t> bytes(width, height), mask(width, height);
      const auto got = tp::warp_patch<float>(image.view(), camera, H, floats.view(), 77, mask.view());
      EXPECT_EQ(got.status, want.status);
      EXPECT_NEAR(got.inside, want.inside, 1) << "a pixel on the border";
      EXPECT_EQ(tp::warp_patch<std::uint8_t>(image.view(), camera, H, bytes.view(), 77).inside, got.inside);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          if (mask(x, y) != exact_mask(x, y)) continue;
          // 1e-4 px at gradients of up to 255 grey levels a px.
          ASSERT_NEAR(static_cast<double>(floats(x, y)), exact(x, y), 0.03) << x << ' ' << y;
          ASSERT_NEAR(bytes(x, y), exact(x, y), 0.53) << x << ' ' << y;
        }
    }
  }
  EXPECT_GT(whole, 5);
  EXPECT_GT(partly, 10);
}

TEST(WarpLens, WithoutALensItIsTheWarpOfAPinhole) {
  const auto image = texture<std::uint8_t>(320, 240, 3);
  Random random(9);
  const tp::Matrix3<double> H = rays(random, 0.004);
  tp::Image<float> a(90, 40), b(90, 40);
  tp::Matrix3<double> K;
  K << kCamera.fx, 0, kCamera.cx, 0, kCamera.fy, kCamera.cy, 0, 0, 1;
  EXPECT_EQ(tp::warp_patch<float>(image.view(), tp::CameraView(kCamera), H, a.view()).inside,
            (tp::warp_patch<std::uint8_t, float>(image.view(), K * H, b.view()).inside));
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 90; ++x) EXPECT_NEAR(a(x, y), b(x, y), 0.02);
}

TEST(WarpLens, SaysWhatIsWrong) {
  const auto image = texture<std::uint8_t>(64, 48, 3);
  tp::Image<float> out(8, 8);
  const tp::CameraView camera(kCamera, &kLenses[0]);
  const tp::Matrix3<double> H = tp::Matrix3<double>::Identity();
  tp::Matrix3<double> broken = H, behind = H;
  broken(1, 1) = std::nan("");
  behind(2, 2) = -1;
  EXPECT_EQ(tp::warp_patch<float>(image.view(), camera, broken, out.view()).status, tp::Status::non_finite);
  EXPECT_EQ(tp::warp_patch<float>(image.view(), camera, behind, out.view()).status, tp::Status::out_of_view);
  EXPECT_EQ(tp::warp_patch<float>(image.view(), tp::CameraView(tp::Pinhole<double>(-1, 1, 0, 0)), H, out.view()).status,
            tp::Status::invalid_argument);
  const tp::LensMap blind(tp::RadialTangential<double>{{}, std::nan(""), 0, 0, 0, 0});
  EXPECT_EQ(tp::warp_patch<float>(image.view(), tp::CameraView(kCamera, &blind), H, out.view()).status,
            tp::Status::invalid_argument);
}

}  // namespace warp_lens_test
