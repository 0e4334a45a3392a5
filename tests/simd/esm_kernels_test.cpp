// ESM and host-gradient normal equations on every target against the double reference.
#include "simd/policy_support.hpp"

namespace esm_kernels_test {
namespace tp = textplane;
using textplane_test::PolicyScene;
using textplane_test::unknowns;

// Of float rows (simd/residual.hpp), with gradients of up to 40 grey levels a px at a contrast of about 40.
constexpr double kTolerance = 3e-5;

template <int P>
void compare(PolicyScene& scene, const tp::PhotometricInput& in, tp::LinearisePolicy policy,
             const tp::PhotometricOptions& o) {
  const auto reference = tp::reference::linearise<unknowns<P>()>(
      tp::ResidualRequest{in, scene.theta, scene.T_t_h, o}.by(policy), scene.workspace);
  const auto fast =
      tp::linearise<unknowns<P>()>(tp::ResidualRequest{in, scene.theta, scene.T_t_h, o}.by(policy), scene.workspace);
  tp::PhotometricOptions plain = o;
  plain.normalisation = tp::Normalisation::frozen;
  const auto scale = tp::reference::linearise<unknowns<P>()>(
      tp::ResidualRequest{in, scene.theta, scene.T_t_h, plain}.by(policy), scene.workspace);
  textplane_test::expect_close<P>(fast, reference, kTolerance, scale);
}

TEST(EsmKernels, EveryTargetAndCount) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    for (int n = 1; n <= 65; ++n) {
      SCOPED_TRACE(n);
      PolicyScene scene(static_cast<unsigned>(1 + n % 7), n);
      for (const auto policy : {tp::LinearisePolicy::esm, tp::LinearisePolicy::template_jacobian})
        for (const auto& o : textplane_test::all_options(2))
          compare<9>(scene, scene.policy_input(n % 2 == 0), policy, o);
    }
  }
}

// A host of little contrast on a bright ground. Float holds its variance where the mean of its pixels is taken off, of
// these alone.
TEST(EsmKernels, AFaintHostOnABrightGround) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    for (int n = 5; n <= 65; ++n) {
      SCOPED_TRACE(n);
      PolicyScene scene(static_cast<unsigned>(1 + n % 7), n);
      for (std::size_t i = 0; i < scene.gx.size(); ++i) {
        scene.intensity[i] = 250 + 0.02F * (scene.intensity[i] - 128);
        scene.gx[i] *= 0.02F;
        scene.gy[i] *= 0.02F;
      }
      for (auto& o : textplane_test::all_options(2)) {
        o.min_contrast = 0;
        compare<9>(scene, scene.policy_input(), tp::LinearisePolicy::esm, o);
      }
    }
  }
}

TEST(EsmKernels, ManyPixelsAndAllParameters) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    PolicyScene scene(3, 700);
    for (auto o : textplane_test::all_options(15)) {
      o.robust.delta = 0.1;  // most pixels are outliers
      compare<3>(scene, scene.policy_input(), tp::LinearisePolicy::esm, o);
      compare<6>(scene, scene.policy_input(true), tp::LinearisePolicy::esm, o);
      compare<9>(scene, scene.policy_input(), tp::LinearisePolicy::esm, o);
    }
  }
}

TEST(EsmKernels, PartOfThePatchVisible) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    PolicyScene scene(5, 300);
    textplane_test::move_half_out(&scene);
    for (const auto& o : textplane_test::all_options(15))
      compare<6>(scene, scene.policy_input(), tp::LinearisePolicy::esm, o);
  }
}

TEST(EsmKernels, StatusOfBadInput) {
  PolicyScene scene(2, 60);
  const auto run = [&](const tp::PhotometricInput& in, const tp::SE3d& T, tp::LinearisePolicy policy) {
    const auto fast =
        tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, scene.theta, T}.by(policy), scene.workspace);
    EXPECT_EQ(fast.status, tp::reference::linearise<tp::Parameters::pose>(
                               tp::ResidualRequest{in, scene.theta, T}.by(policy), scene.workspace)
                               .status);
    return fast.status;
  };
  auto in = scene.policy_input();
  EXPECT_EQ(run(in, scene.T_t_h, tp::LinearisePolicy::automatic), tp::Status::invalid_argument);
  tp::SE3d T = scene.T_t_h;
  T.t[1] = std::nan("");
  EXPECT_EQ(run(in, T, tp::LinearisePolicy::esm), tp::Status::non_finite);
  T = scene.T_t_h;
  T.t[0] += 100;
  EXPECT_EQ(run(in, T, tp::LinearisePolicy::esm), tp::Status::out_of_view);
  scene.gx[7] = std::nanf("");
  EXPECT_EQ(run(in, scene.T_t_h, tp::LinearisePolicy::esm), tp::Status::non_finite);
  in.patch.gx = nullptr;
  EXPECT_EQ(run(in, scene.T_t_h, tp::LinearisePolicy::esm), tp::Status::invalid_argument);
}

}  // namespace esm_kernels_test
