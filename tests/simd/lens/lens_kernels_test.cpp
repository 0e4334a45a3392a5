// The residual kernels behind a lens, on every target, against the double reference.
#include <gtest/gtest.h>

#include <vector>

#include "simd/lens/cases.hpp"
#include "simd/policy_support.hpp"
#include "simd/residual_support.hpp"
#include "textplane/photometry/candidates.hpp"
#include "textplane/photometry/prepared_target.hpp"
#include "textplane/photometry/text_batch.hpp"

namespace lens_kernels_test {
namespace tp = textplane;
using namespace textplane_test;
using Scene8 = Scene<std::uint8_t>;

TEST(LensKernels, EveryNumberOfPixels) {
  for (const LensCase& c : lens_cases())
    for (int n = 1; n <= 65; ++n) {
      SCOPED_TRACE(std::string(c.name) + " " + std::to_string(n));
      const Scene8 scene(static_cast<unsigned>(n), n, &c.lens, c.zoom);
      compare_all(scene.input(), scene.theta, scene.T_t_h, any_options(n % 2 == 0, n % 3 != 0), kLensFactor);
    }
}

TEST(LensKernels, ManyPixels) {
  for (const LensCase& c : lens_cases())
    for (const int n : {100, 256, 257, 2049, 4001}) {
      SCOPED_TRACE(std::string(c.name) + " " + std::to_string(n));
      const Scene8 scene(static_cast<unsigned>(n), n, &c.lens, c.zoom);
      compare_all(scene.input(), scene.theta, scene.T_t_h, any_options(), kLensFactor);
      tp::PhotometricInput in = scene.input();
      const tp::PreparedTarget prepared(in.target);
      in.pairs = prepared.view();
      compare_equations<9>(in, scene.theta, scene.T_t_h, any_options(), kLensFactor);
    }
}

// A fit takes as many terms as it needs, and the kernels take the call.
TEST(LensKernels, FitsAndTakesTheCalls) {
  for (const LensCase& c : lens_cases()) {
    SCOPED_TRACE(c.name);
    const Scene8 scene(4, 600, &c.lens, c.zoom);
    const tp::PhotometricInput in = scene.input();
    tp::detail::RayBox box;
    tp::simd::LensFit fit;
    ASSERT_TRUE(tp::detail::ray_box(tp::simd::point_bounds(in.patch.x, in.patch.y, in.patch.n), in.host_camera,
                                    tp::plane_homography(scene.theta, scene.T_t_h), &box));
    ASSERT_TRUE(tp::detail::fit_lens(c.lens, box, &fit));
    EXPECT_EQ(fit.terms, c.terms);
    tp::PhotometricWorkspace workspace(in.patch.n);
    const auto sums = tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, scene.theta, scene.T_t_h}, workspace);
    EXPECT_EQ(sums.path, tp::Path::kernel);
  }
}

TEST(LensKernels, HostGradients) {
  for (const tp::simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    for (const LensCase& c : lens_cases())
      for (int n = 15; n <= 66; ++n) {
        SCOPED_TRACE(std::string(c.name) + " " + std::to_string(n));
        PolicyScene scene(static_cast<unsigned>(1 + n % 7), n < 66 ? n : 900, &c.lens, c.zoom);
        const tp::PhotometricInput in = scene.policy_input();
        tp::TemplatePatch prepared;
        ASSERT_EQ(prepared.prepare(in.patch), tp::Status::ok);
        for (const auto& o : all_options(15)) {
          tp::PhotometricOptions held = o;
          held.normalisation = tp::Normalisation::frozen;
          const tp::ResidualRequest request{in, scene.theta, scene.T_t_h, o};
          const auto esm = tp::reference::linearise<tp::Parameters::pose_plane>(request.by(tp::LinearisePolicy::esm),
                                                                                scene.workspace);
          const auto scale = tp::reference::linearise<tp::Parameters::pose_plane>(
              tp::ResidualRequest{in, scene.theta, scene.T_t_h, held}.by(tp::LinearisePolicy::esm), scene.workspace);
          textplane_test::expect_close<9>(
              tp::linearise<tp::Parameters::pose_plane>(request.by(tp::LinearisePolicy::esm), scene.workspace), esm,
              3e-5, scale);
          const auto policy = tp::LinearisePolicy::template_jacobian;
          const auto reference =
              tp::reference::linearise<tp::Parameters::pose_plane>(request.by(policy), scene.workspace);
          const auto fast = tp::linearise<tp::Parameters::pose_plane>(request.by(policy, &prepared), scene.workspace);
          EXPECT_EQ(fast.path, tp::Path::kernel);
          textplane_test::expect_close<9>(fast, reference, 0.08 / 30);
          EXPECT_LT((fast.H - reference.H).norm(), 2e-3 * reference.H.norm());
          if (n < 66) continue;
          const auto hybrid = request.by(tp::LinearisePolicy::hybrid, &prepared);
          textplane_test::expect_close<9>(tp::linearise<tp::Parameters::pose_plane>(hybrid, scene.workspace),
                                          tp::reference::linearise<tp::Parameters::pose_plane>(hybrid, scene.workspace),
                                          3e-4);
        }
      }
  }
}

// Behind a lens, too, a patch of which all is visible, by far, has no pixel to be looked at alone.
TEST(LensKernels, TemplatesInTheMiddleOfTheImageAreTaken) {
  for (const LensCase& c : lens_cases()) {
    SCOPED_TRACE(c.name);
    PolicyScene scene(3, 100, &c.lens, c.zoom);
    for (std::size_t i = 0; i < 100; ++i) {
      scene.x[i] = static_cast<float>(88 + i % 20);
      scene.y[i] = static_cast<float>(77 + i / 20);
    }
    const tp::PhotometricInput in = scene.policy_input();
    tp::TemplatePatch prepared;
    ASSERT_EQ(prepared.prepare(in.patch), tp::Status::ok);
    const tp::ResidualRequest request{in, {0, 0, 1}, tp::SE3d(), tp::PhotometricOptions()};
    tp::simd::ResidualArgs args = tp::detail::kernel_args(request, scene.workspace, nullptr, nullptr);
    tp::simd::LensFit fit;
    ASSERT_TRUE(tp::detail::fit_request(request, &args, &fit));
    std::vector<std::int16_t> values(128);
    for (const tp::simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      SCOPED_TRACE(tp::simd::to_string(target));
      EXPECT_EQ(tp::simd::evaluate_template(prepared.model(), args, values.data()).status, tp::Status::ok);
    }
  }
}

TEST(LensKernels, Batches) {
  for (const LensCase& c : lens_cases()) {
    SCOPED_TRACE(c.name);
    std::vector<Scene8> scenes;
    for (unsigned k = 0; k < 19; ++k) scenes.emplace_back(k + 1, 15 + static_cast<int>(k) * 7, &c.lens, c.zoom);
    // All of one image; the others' patches need not fit it.
    std::vector<tp::TextBatchItem> items;
    std::vector<tp::SE3d> poses;
    for (const Scene8& scene : scenes) {
      items.push_back({scene.input().patch, scene.host_camera, scene.theta});
      poses.push_back(scene.T_t_h);
    }
    items[3].patch.x = nullptr;
    poses[4].t[2] -= 100;  // behind
    const tp::TextBatch batch(items.data(), static_cast<int>(items.size()));
    tp::TextBatchResult result(batch);
    const tp::CameraView camera(scenes[0].target_camera, &c.lens);
    for (const tp::simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      SCOPED_TRACE(tp::simd::to_string(target));
      for (const bool derivatives : {true, false}) {
        if (derivatives)
          ASSERT_EQ(tp::linearise_batch<tp::Parameters::pose_plane>(batch, scenes[0].view(), camera, poses.data(),
                                                                    any_options(), result),
                    tp::Status::ok);
        else
          ASSERT_EQ(tp::evaluate_batch(batch, scenes[0].view(), camera, poses.data(), any_options(), result),
                    tp::Status::ok);
        EXPECT_EQ(result.status(3), tp::Status::invalid_argument);
        EXPECT_EQ(result.status(4), tp::Status::behind_camera);
        for (const int i : {0, 1, 2, 7, 16, 18}) {
          SCOPED_TRACE(i);
          tp::PhotometricInput in = scenes[static_cast<std::size_t>(i)].input();
          in.target = scenes[0].view();
          tp::PhotometricWorkspace workspace(in.patch.n);
          const tp::ResidualRequest request{in, items[static_cast<std::size_t>(i)].theta,
                                            poses[static_cast<std::size_t>(i)], any_options()};
          const auto exact = tp::reference::linearise<tp::Parameters::pose_plane>(request, workspace);
          ASSERT_EQ(result.status(i), exact.status);
          if (!is_ok(exact.status)) continue;
          EXPECT_NEAR(result.cost(i), exact.cost, 1e-4 * exact.cost);
          EXPECT_EQ(result.visible(i), exact.visible);
          if (!derivatives) continue;
          const auto sums = result.normal_equations<tp::Parameters::pose_plane>(i);
          for (int k = 0; k < 9; ++k) EXPECT_NEAR(sums.H(k, k), exact.H(k, k), 1e-3 * exact.H(k, k)) << k;
        }
      }
    }
  }
}

TEST(LensKernels, Candidates) {
  for (const tp::simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    for (const LensCase& c : lens_cases()) {
      SCOPED_TRACE(c.name);
      PolicyScene scene(5, 200, &c.lens, c.zoom);
      const tp::PhotometricInput in = scene.policy_input();
      tp::TemplatePatch prepared;
      ASSERT_EQ(prepared.prepare(in.patch), tp::Status::ok);
      Random random(8);
      std::vector<tp::SE3d> poses(12, scene.T_t_h);
      for (std::size_t i = 1; i < 8; ++i) poses[i] = tp::se3_exp<double>(random.twist(0.03, 0.03)) * poses[i];
      for (const bool broken : {false, true}) {
        if (broken) {
          poses[9].t[0] += 0.45;  // partly outside, or wholly
          poses[10].t[2] -= 100;  // behind
          poses[11].R(0, 0) = std::nan("");
        }
        std::vector<float> zncc(12, 7.0F), plain(12, 7.0F);
        ASSERT_EQ(tp::zncc_candidates(in, scene.theta, poses.data(), 12, {}, scene.workspace, zncc.data(), &prepared),
                  tp::Status::ok);
        ASSERT_EQ(tp::zncc_candidates(in, scene.theta, poses.data(), 12, {}, scene.workspace, plain.data()),
                  tp::Status::ok);
        for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(zncc[i], plain[i], 0.05 / 30) << i;
      }
    }
  }
}

}  // namespace lens_kernels_test
