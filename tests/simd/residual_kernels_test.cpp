// Normal equations and cost of the float kernels against the double reference: every target, every number of
// parameters, both normalisations, Huber and L2, few pixels and many, and the forms of the target image.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "simd/residual_support.hpp"
#include "textplane/photometry/prepared_target.hpp"

namespace residual_kernels_test {
namespace tp = textplane;
using namespace textplane_test;
using Scene8 = Scene<std::uint8_t>;

TEST(ResidualKernels, EveryNumberOfPixels) {
  for (int n = 1; n <= 65; ++n) {
    SCOPED_TRACE(n);
    const Scene8 scene(static_cast<unsigned>(n), n);
    compare_all(scene.input(), scene.theta, scene.T_t_h, any_options(n % 2 == 0, n % 3 != 0));
  }
}

// 256 is the last number of pixels that takes rows, and a strip; 2048 what the widest sums hold before they go to
// double.
TEST(ResidualKernels, ManyPixels) {
  for (const int n : {100, 160, 161, 255, 256, 257, 1000, 2049, 4001})
    for (int mode = 0; mode < 4; ++mode) {
      SCOPED_TRACE(n * 10 + mode);
      const Scene8 scene(static_cast<unsigned>(n + mode), n);
      compare_all(scene.input(), scene.theta, scene.T_t_h, any_options(mode % 2 == 0, mode < 2));
    }
}

TEST(ResidualKernels, AHundredThousandPixels) {
  const Scene8 scene(3, 100000);
  compare_equations<9>(scene.input(), scene.theta, scene.T_t_h, any_options());
  compare_cost(scene.input(), scene.theta, scene.T_t_h, any_options());
}

// From all pixels outliers to none: the correction for outliers, the sums of these themselves, and nothing to correct.
TEST(ResidualKernels, EveryShareOfOutliers) {
  for (const double delta : {1e-3, 0.02, 0.1, 0.3, 1.0, 3.0, 100.0})
    for (const int n : {40, 300, 3000}) {
      SCOPED_TRACE(delta);
      const Scene8 scene(static_cast<unsigned>(n), n);
      tp::PhotometricOptions o = any_options();
      o.robust.delta = delta;
      compare_all(scene.input(), scene.theta, scene.T_t_h, o);
    }
}

TEST(ResidualKernels, WorldPoses) {
  for (const int n : {20, 500})
    for (const auto side : {tp::PerturbationSide::left, tp::PerturbationSide::right}) {
      const Scene8 scene(static_cast<unsigned>(n), n);
      tp::PhotometricWorkspace workspace(n);
      const auto in = scene.input();
      const auto frozen = tp::reference::linearise<tp::Parameters::host_target_plane>(
          tp::world_request(in, scene.theta, scene.T_w_h, scene.T_w_t, side, any_options(false)), workspace);
      const auto exact = tp::reference::linearise<tp::Parameters::host_target_plane>(
          tp::world_request(in, scene.theta, scene.T_w_h, scene.T_w_t, side, any_options()), workspace);
      for (const simd::Target target : testable_targets()) {
        const TargetScope scope(target);
        SCOPED_TRACE(simd::to_string(target));
        expect_close<15>(
            tp::linearise<tp::Parameters::host_target_plane>(
                tp::world_request(in, scene.theta, scene.T_w_h, scene.T_w_t, side, any_options()), workspace),
            exact, frozen);
      }
    }
}

// The same pixels through rows with gaps and through pairs give the same bits.
TEST(ResidualKernels, StridesAndPreparedTargets) {
  for (const int n : {15, 700}) {
    const Scene8 scene(static_cast<unsigned>(n), n);
    tp::PhotometricInput in = scene.input();
    const tp::PreparedTarget prepared(in.target);
    ASSERT_EQ(prepared.view().width, in.target.width());
    std::vector<std::uint8_t> wide(static_cast<std::size_t>(Scene8::kHeight) * 331, 77);
    for (int y = 0; y < Scene8::kHeight; ++y)
      for (int x = 0; x < Scene8::kWidth; ++x) wide[static_cast<std::size_t>(y * 331 + x)] = in.target(x, y);
    tp::PhotometricWorkspace workspace(n);
    for (const simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      const auto plain = tp::linearise<tp::Parameters::pose_plane>(
          tp::ResidualRequest{in, scene.theta, scene.T_t_h, any_options()}, workspace);
      ASSERT_EQ(plain.status, tp::Status::ok);
      tp::PhotometricInput other = in;
      other.target = tp::ImageView8(wide.data(), Scene8::kWidth, Scene8::kHeight, 331);
      const auto strided = tp::linearise<tp::Parameters::pose_plane>(
          tp::ResidualRequest{other, scene.theta, scene.T_t_h, any_options()}, workspace);
      EXPECT_EQ(plain.H, strided.H);
      other = in;
      other.pairs = prepared.view();
      const auto paired = tp::linearise<tp::Parameters::pose_plane>(
          tp::ResidualRequest{other, scene.theta, scene.T_t_h, any_options()}, workspace);
      EXPECT_EQ(plain.H, paired.H);
      EXPECT_EQ(plain.b, paired.b);
      EXPECT_EQ(tp::evaluate(tp::ResidualRequest{in, scene.theta, scene.T_t_h, any_options()}, workspace).cost,
                tp::evaluate(tp::ResidualRequest{other, scene.theta, scene.T_t_h, any_options()}, workspace).cost);
    }
    // Pairs of another image are not used.
    in.pairs = prepared.view();
    in.pairs.height += 1;
    compare_equations<6>(in, scene.theta, scene.T_t_h, any_options());
  }
}

// Gain and bias of either side change neither residuals nor, but for the gain, the gradient's scale: what float loses
// of a large offset stays within the bound.
TEST(ResidualKernels, GainAndBias) {
  for (const double gain : {0.011, 0.05, 1.0, 40.0})
    for (const double bias : {-1000.0, 0.0, 3000.0}) {
      Scene8 scene(5, gain < 1 ? 257 : 400);
      for (float& v : scene.intensity) v = static_cast<float>(gain * static_cast<double>(v) + bias);
      SCOPED_TRACE(gain);
      compare_all(scene.input(), scene.theta, scene.T_t_h, any_options());
    }
}

// A known summary of the positions saves time and changes nothing.
TEST(ResidualKernels, KnownBounds) {
  const Scene8 scene(8, 333);
  tp::PhotometricWorkspace workspace(333);
  tp::PhotometricInput in = scene.input();
  const auto without =
      tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, scene.theta, scene.T_t_h, any_options()}, workspace);
  in.patch.bounds = tp::simd::point_bounds(in.patch.x, in.patch.y, in.patch.n);
  ASSERT_EQ(in.patch.bounds.n, 333);
  const tp::ResidualRequest request{in, scene.theta, scene.T_t_h, any_options()};
  EXPECT_EQ(tp::evaluate(request, workspace).path, tp::Path::kernel);
  EXPECT_EQ(without.path, tp::Path::kernel);
  const auto with =
      tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, scene.theta, scene.T_t_h, any_options()}, workspace);
  EXPECT_EQ(with.H, without.H);
  // Of another number of pixels they are not used.
  in.patch.bounds.n = 332;
  in.patch.bounds.x_high = in.patch.bounds.x_low;
  EXPECT_EQ(
      tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, scene.theta, scene.T_t_h, any_options()}, workspace)
          .H,
      without.H);
}

// What the kernels do not take is the reference's, to the bit.
TEST(ResidualKernels, TheReferenceTakesTheRest) {
  Scene8 scene(2, 60);
  Scene<float> same(2, 60);
  tp::PhotometricWorkspace workspace(60);
  tp::PhotometricOptions precise = any_options();
  precise.precise = true;
  const auto b = tp::linearise<tp::Parameters::pose>(scene.request(precise), workspace);
  EXPECT_EQ(b.H, tp::reference::linearise<tp::Parameters::pose>(scene.request(precise), workspace).H);
  const auto c = tp::linearise<tp::Parameters::pose>(same.request(any_options()), workspace);
  EXPECT_EQ(c.H, tp::reference::linearise<tp::Parameters::pose>(same.request(any_options()), workspace).H);
  // The results say so.
  EXPECT_EQ(b.path, tp::Path::reference);
  EXPECT_EQ(c.path, tp::Path::reference);
  EXPECT_EQ(tp::evaluate(scene.request(precise), workspace).path, tp::Path::reference);
  EXPECT_EQ(tp::evaluate(scene.request(any_options()), workspace).path, tp::Path::kernel);
}

}  // namespace residual_kernels_test
