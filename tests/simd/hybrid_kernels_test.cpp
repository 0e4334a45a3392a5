// Hybrid normal equations on every target against the double reference, which residual_policy_test.cpp proves.
#include "simd/policy_support.hpp"
#include "textplane/photometry/template_patch.hpp"

namespace hybrid_kernels_test {
namespace tp = textplane;
using textplane_test::PolicyScene;
using textplane_test::unknowns;

// b, costs: of float rows. H: of the template's columns, rounded to 1/8191 of their largest entry.
constexpr double kTolerance = 3e-5, kTemplateTolerance = 3e-4;

template <int P>
void compare(PolicyScene& scene, const tp::PhotometricInput& in, const tp::PhotometricOptions& o) {
  tp::TemplatePatch prepared;
  tp::PatchView whole = in.patch;
  whole.mask = nullptr;
  ASSERT_EQ(prepared.prepare(whole), tp::Status::ok);
  const auto request = tp::ResidualRequest{in, scene.theta, scene.T_t_h, o}.by(tp::LinearisePolicy::hybrid, &prepared);
  const auto reference = tp::reference::linearise<unknowns<P>()>(request, scene.workspace);
  const auto fast = tp::linearise<unknowns<P>()>(request, scene.workspace);
  tp::PhotometricOptions plain = o;
  plain.normalisation = tp::Normalisation::frozen;
  const auto scale = tp::reference::linearise<unknowns<P>()>(tp::ResidualRequest{in, scene.theta, scene.T_t_h, plain},
                                                             scene.workspace);
  ASSERT_EQ(fast.status, tp::Status::ok);
  EXPECT_EQ(fast.path, tp::Path::kernel);
  textplane_test::expect_close<P>(fast, reference, kTemplateTolerance);
  const auto forward =
      tp::linearise<unknowns<P>()>(tp::ResidualRequest{in, scene.theta, scene.T_t_h, o}, scene.workspace);
  EXPECT_EQ(fast.cost, forward.cost) << "trials are compared with it";
  EXPECT_EQ(fast.visible, forward.visible);
  const auto exact =
      tp::reference::linearise<unknowns<P>()>(tp::ResidualRequest{in, scene.theta, scene.T_t_h, o}, scene.workspace);
  for (int i = 0; i < P; ++i) EXPECT_NEAR(fast.b[i], exact.b[i], kTolerance * std::sqrt(scale.H(i, i))) << i;
}

std::vector<tp::PhotometricOptions> every_cost() {
  std::vector<tp::PhotometricOptions> all = textplane_test::all_options(15);
  for (const auto kind : {tp::RobustKind::cauchy, tp::RobustKind::tukey}) {
    all.push_back(all[0]);
    all.back().robust = {kind, 1.0};
  }
  for (const double delta : {0.1, 2.0}) {  // most pixels are outliers; hardly any
    all.push_back(all[0]);
    all.back().robust = {tp::RobustKind::huber, delta};
  }
  return all;
}

TEST(HybridKernels, EveryTargetCostAndParameters) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    for (const int n : {257, 258, 263, 272, 289, 511, 513, 700, 1300}) {
      SCOPED_TRACE(n);
      PolicyScene scene(static_cast<unsigned>(1 + n % 7), n);
      for (const auto& o : every_cost()) {
        compare<3>(scene, scene.policy_input(), o);
        compare<6>(scene, scene.policy_input(), o);
        compare<9>(scene, scene.policy_input(), o);
      }
    }
  }
}

TEST(HybridKernels, PartOfThePatchVisible) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    PolicyScene scene(5, 1600);
    textplane_test::move_half_out(&scene);
    for (const auto& o : every_cost()) compare<6>(scene, scene.policy_input(), o);
  }
}

// Few visible pixels, a mask, nothing prepared: the bits are forward's.
TEST(HybridKernels, ElseItIsForward) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    PolicyScene few(3, 256), many(4, 300), part(6, 300);
    textplane_test::move_half_out(&part);
    const auto expect_forward = [](PolicyScene& scene, bool masked, bool with_prepared) {
      tp::TemplatePatch prepared;
      ASSERT_EQ(prepared.prepare(scene.policy_input().patch), tp::Status::ok);
      const tp::ResidualRequest request{scene.policy_input(masked), scene.theta, scene.T_t_h};
      const auto forward = tp::linearise<tp::Parameters::pose>(request, scene.workspace);
      ASSERT_EQ(forward.status, tp::Status::ok);
      const auto by = request.by(tp::LinearisePolicy::hybrid, with_prepared ? &prepared : nullptr);
      for (const auto& hybrid : {tp::linearise<tp::Parameters::pose>(by, scene.workspace)}) {
        EXPECT_EQ(hybrid.H, forward.H);
        EXPECT_EQ(hybrid.b, forward.b);
        EXPECT_EQ(hybrid.cost, forward.cost);
      }
      const auto exact = tp::reference::linearise<tp::Parameters::pose>(request, scene.workspace);
      const auto reference = tp::reference::linearise<tp::Parameters::pose>(by, scene.workspace);
      EXPECT_EQ(reference.H, exact.H);
      EXPECT_EQ(reference.b, exact.b);
    };
    expect_forward(few, false, true);
    expect_forward(many, true, true);
    expect_forward(many, false, false);
    expect_forward(part, false, true);
  }
}

TEST(HybridKernels, StatusOfBadInput) {
  PolicyScene scene(2, 400);
  tp::TemplatePatch prepared;
  ASSERT_EQ(prepared.prepare(scene.policy_input().patch), tp::Status::ok);
  const auto run = [&](const tp::SE3d& T) {
    const auto by =
        tp::ResidualRequest{scene.policy_input(), scene.theta, T}.by(tp::LinearisePolicy::hybrid, &prepared);
    const auto fast = tp::linearise<tp::Parameters::pose>(by, scene.workspace);
    EXPECT_EQ(fast.status, tp::reference::linearise<tp::Parameters::pose>(by, scene.workspace).status);
    EXPECT_TRUE(fast.H.isZero(0) && fast.b.isZero(0));
    return fast.status;
  };
  tp::SE3d T = scene.T_t_h;
  T.t[1] = std::nan("");
  EXPECT_EQ(run(T), tp::Status::non_finite);
  T = scene.T_t_h;
  T.t[0] += 100;
  EXPECT_EQ(run(T), tp::Status::out_of_view);
  T = scene.T_t_h;
  T.t[2] -= 100;
  EXPECT_EQ(run(T), tp::Status::behind_camera);
}

}  // namespace hybrid_kernels_test
