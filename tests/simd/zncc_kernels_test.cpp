// ZNCC of many candidate poses on every target against the double reference.
#include "simd/policy_support.hpp"
#include "textplane/photometry/candidates.hpp"

namespace zncc_kernels_test {
namespace tp = textplane;
using textplane_test::PolicyScene;
using textplane_test::Random;

TEST(ZnccKernels, EveryTargetAndCount) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    for (int n = 15; n <= 65; ++n) {
      SCOPED_TRACE(n);
      PolicyScene scene(static_cast<unsigned>(n % 5), n);
      const tp::PhotometricInput in = scene.policy_input();
      tp::TemplatePatch prepared;
      ASSERT_EQ(prepared.prepare(in.patch), tp::Status::ok);
      Random random(static_cast<unsigned>(n));
      std::vector<tp::SE3d> poses(9, scene.T_t_h);
      for (std::size_t i = 1; i < 6; ++i) poses[i] = tp::se3_exp<double>(random.twist(0.02, 0.02)) * poses[i];
      poses[6].t[0] += 0.45;  // partly outside, or wholly
      poses[7].t[2] -= 100;   // behind
      poses[8].R(0, 0) = std::nan("");
      std::vector<float> zncc(9, 7.0F), plain(9, 7.0F);
      const tp::PhotometricOptions o;
      ASSERT_EQ(tp::zncc_candidates(in, scene.theta, poses.data(), 9, o, scene.workspace, zncc.data(), &prepared),
                tp::Status::ok);
      ASSERT_EQ(tp::zncc_candidates(in, scene.theta, poses.data(), 9, o, scene.workspace, plain.data()),
                tp::Status::ok);
      tp::PhotometricOptions l2;
      l2.robust.kind = tp::RobustKind::l2;
      for (std::size_t i = 0; i < 9; ++i) {
        const auto reference =
            tp::reference::evaluate(tp::ResidualRequest{in, scene.theta, poses[i], l2}, scene.workspace);
        const double expected = tp::is_ok(reference.status) ? reference.zncc : -1.0;
        // 0.05 / sigma, sigma above 25 in these textures; without preparation the float kernels' bound.
        EXPECT_NEAR(static_cast<double>(zncc[i]), expected, 0.05 / 25) << i;
        EXPECT_NEAR(static_cast<double>(plain[i]), expected, 1e-5) << i;
      }
      EXPECT_EQ(zncc[7], -1.0F);
      EXPECT_EQ(zncc[8], -1.0F);
    }
  }
}

TEST(ZnccKernels, BadArguments) {
  PolicyScene scene(1, 20);
  tp::PhotometricInput in = scene.policy_input();
  float zncc[2] = {5, 5};
  EXPECT_EQ(tp::zncc_candidates(in, scene.theta, nullptr, 2, {}, scene.workspace, zncc), tp::Status::invalid_argument);
  EXPECT_EQ(tp::zncc_candidates(in, scene.theta, nullptr, 0, {}, scene.workspace, nullptr), tp::Status::ok);
  in.target = tp::ImageView8();
  EXPECT_EQ(tp::zncc_candidates(in, scene.theta, &scene.T_t_h, 1, {}, scene.workspace, zncc),
            tp::Status::invalid_argument);
  EXPECT_EQ(zncc[0], -1.0F);
}

}  // namespace zncc_kernels_test
