// No photometric kernel reads beyond its image or its arrays of pixels: both end, and begin, at pages that may not be
// touched, and the pixels fall on every border of the image and beyond it. A read too far ends the program.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

#include "photometry/scene.hpp"
#include "support/guarded.hpp"
#include "support/targets.hpp"
#include "textplane/photometry/candidates.hpp"
#include "textplane/photometry/residual_policy.hpp"
#include "textplane/photometry/text_batch.hpp"

namespace guard_pages_test {
namespace tp = textplane;
using namespace textplane_test;

// Host pixels strewn over an image and half a pixel beyond its borders, many of them on the border itself.
struct Pixels {
  Guarded<float> x, y, intensity, gx, gy;
  Guarded<std::uint8_t> mask;
  int n;

  Pixels(int count, int width, int height, unsigned seed)
      : x(size(count)),
        y(size(count)),
        intensity(size(count)),
        gx(size(count)),
        gy(size(count)),
        mask(size(count)),
        n(count) {
    Random random(seed);
    const auto place = [&](int side) {
      const double inside = random.uniform(0, side - 1);
      const double values[] = {0.0, side - 1.0, -0.5, side - 0.5, inside, inside, inside, inside};
      return static_cast<float>(values[random.integer(0, 7)]);
    };
    for (int i = 0; i < n; ++i) {
      x.data()[i] = place(width);
      y.data()[i] = place(height);
      intensity.data()[i] = static_cast<float>(random.uniform(0, 255));
      gx.data()[i] = static_cast<float>(random.uniform(-20, 20));
      gy.data()[i] = static_cast<float>(random.uniform(-20, 20));
      mask.data()[i] = random.integer(0, 3) > 0 ? 1 : 0;
    }
  }
  static std::size_t size(int count) { return static_cast<std::size_t>(count); }

  tp::PatchView view(bool masked) const {
    return {x.data(), y.data(), intensity.data(), masked ? mask.data() : nullptr, n, gx.data(), gy.data()};
  }
};

void run_every_kernel(const tp::PhotometricInput& in, const tp::SE3d& T, tp::PhotometricWorkspace& workspace) {
  const tp::Vector3<double> theta(0, 0, 0.5);
  tp::PhotometricOptions options;
  options.min_visible = 1;
  options.min_contrast = 0;
  tp::TemplatePatch prepared;
  const bool ready = !in.patch.mask && tp::is_ok(prepared.prepare(in.patch));
  for (const auto kind : {tp::RobustKind::huber, tp::RobustKind::l2}) {
    options.robust = {kind, 0.5};
    tp::evaluate(tp::ResidualRequest{in, theta, T, options}, workspace);
    tp::linearise<tp::Parameters::plane>(tp::ResidualRequest{in, theta, T, options}, workspace);
    tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, theta, T, options}, workspace);
    tp::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{in, theta, T, options}, workspace);
    for (const auto policy :
         {tp::LinearisePolicy::template_jacobian, tp::LinearisePolicy::esm, tp::LinearisePolicy::hybrid}) {
      tp::linearise<tp::Parameters::pose>(
          tp::ResidualRequest{in, theta, T, options}.by(policy, ready ? &prepared : nullptr), workspace);
      tp::linearise<tp::Parameters::pose_plane>(
          tp::ResidualRequest{in, theta, T, options}.by(policy, ready ? &prepared : nullptr), workspace);
    }
  }
  float zncc[3];
  const tp::SE3d candidates[3] = {T, tp::SE3d{}, T * T};
  tp::zncc_candidates(in, theta, candidates, 3, options, workspace, zncc, ready ? &prepared : nullptr);

  tp::TextBatchItem item;
  item.patch = in.patch;
  item.host_camera = in.host_camera;
  item.theta = theta;
  const tp::TextBatchItem items[2] = {item, item};
  const tp::TextBatch batch(items, 2);
  tp::TextBatchResult result(batch);
  tp::evaluate_batch(batch, in.target, in.target_camera, candidates, options, result);
  tp::linearise_batch<tp::Parameters::pose_plane>(batch, in.target, in.target_camera, candidates, options, result);
}

TEST(GuardPages, EveryKernelEveryBorder) {
  const tp::Pinhole<double> camera(40, 40, 10, 8);
  Random random(1);
  int seen = 0;
  for (const auto& [width, height] : {std::pair<int, int>{2, 2}, {3, 9}, {17, 2}, {21, 16}, {40, 33}}) {
    for (const int gap : {0, 5}) {
      const int stride = width + gap;
      const Guarded<std::uint8_t> memory(static_cast<std::size_t>((height - 1) * stride + width));
      for (std::size_t i = 0; i < memory.size(); ++i)
        memory.data()[i] = memory.front()[i] = static_cast<std::uint8_t>(random.integer(0, 255));
      for (const int n : {1, 2, 3, 7, 8, 9, 15, 16, 17, 31, 33, 64, 65, 200, 300, 301}) {
        const Pixels pixels(n, width, height, static_cast<unsigned>(n));
        tp::PhotometricWorkspace workspace(n);
        for (const std::uint8_t* pixel : {memory.data(), memory.front()}) {
          tp::PhotometricInput in;
          in.host_camera = in.target_camera = camera;
          in.target = tp::ImageView8(pixel, width, height, stride);
          in.patch = pixels.view(n % 2 == 0);
          const tp::SE3d nearly = tp::se3_exp<double>(random.twist(0.01, 0.01));
          for (const simd::Target target : testable_targets()) {
            const TargetScope scope(target);
            run_every_kernel(in, tp::SE3d{}, workspace);  // pixels of the border exactly
            run_every_kernel(in, nearly, workspace);
            run_every_kernel(in, tp::se3_exp<double>(random.twist(0.5, 0.6)), workspace);
            const auto cost = tp::evaluate(tp::ResidualRequest{in, tp::Vector3<double>(0, 0, 0.5), nearly}, workspace);
            seen += cost.visible;
          }
        }
      }
    }
  }
  EXPECT_GT(seen, 3000 * static_cast<int>(testable_targets().size())) << "the pixels miss the image";
}

// That the pages are where they should be: of an image that claims a row more, the kernels do read that row.
TEST(GuardPagesDeathTest, AnImageThatIsTooTallIsNoticed) {
  const Guarded<std::uint8_t> memory(21 * 16);
  const Pixels pixels(200, 21, 17, 1);
  tp::PhotometricInput in;
  in.host_camera = in.target_camera = tp::Pinhole<double>(40, 40, 10, 8);
  in.target = tp::ImageView8(memory.data(), 21, 17, 21);
  in.patch = pixels.view(false);
  for (const simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    tp::PhotometricWorkspace workspace(pixels.n);
    EXPECT_DEATH(tp::evaluate(tp::ResidualRequest{in, tp::Vector3<double>(0, 0, 0.5), tp::SE3d{}}, workspace), "");
  }
}

}  // namespace guard_pages_test
