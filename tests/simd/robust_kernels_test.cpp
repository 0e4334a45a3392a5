// Every robust weight on every target and in every form of the residual kernels, against the double reference.
#include <gtest/gtest.h>

#include <vector>

#include "simd/policy_support.hpp"
#include "simd/residual_support.hpp"
#include "textplane/photometry/text_batch.hpp"

namespace robust_kernels_test {
namespace tp = textplane;
using namespace textplane_test;

constexpr tp::RobustKind kKinds[] = {tp::RobustKind::l2, tp::RobustKind::huber, tp::RobustKind::cauchy,
                                     tp::RobustKind::tukey};

tp::PhotometricOptions options_of(tp::RobustKind kind, double delta, bool exact) {
  tp::PhotometricOptions o = any_options(exact);
  o.robust = {kind, delta};
  return o;
}

template <int P>
void compare(PolicyScene& s, const tp::PhotometricOptions& o) {
  tp::PhotometricOptions plain = o;
  plain.normalisation = tp::Normalisation::frozen;
  plain.robust = {tp::RobustKind::l2, 1};
  const auto scale = equations<P, true>(s.input(), s.theta, s.T_t_h, plain, s.workspace);
  const auto exact = equations<P, true>(s.input(), s.theta, s.T_t_h, o, s.workspace);
  const auto cost = tp::reference::evaluate(s.request(o), s.workspace);
  for (const simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    SCOPED_TRACE(simd::to_string(target));
    const auto fast = equations<P>(s.input(), s.theta, s.T_t_h, o, s.workspace);
    EXPECT_EQ(fast.path, tp::Path::kernel);
    textplane_test::expect_close<P>(fast, exact, scale, kEntryBound);
    const auto fast_cost = tp::evaluate(s.request(o), s.workspace);
    ASSERT_EQ(fast_cost.status, cost.status);
    EXPECT_EQ(fast_cost.path, tp::Path::kernel);
    EXPECT_NEAR(fast_cost.cost, cost.cost, kCostBound * cost.cost + kCostFloor);
  }
}

TEST(RobustKernels, FewPixelsAndMany) {
  for (const tp::RobustKind kind : kKinds)
    for (const int n : {1, 2, 3, 7, 8, 15, 16, 17, 33, 40, 255, 256, 257, 300, 3000})
      for (const double delta : {0.3, 0.9, 4.0}) {
        SCOPED_TRACE(n * 10 + static_cast<int>(kind));
        PolicyScene scene(static_cast<unsigned>(n), n);
        const tp::PhotometricOptions o = options_of(kind, delta, n % 2 == 0);
        compare<3>(scene, o);
        compare<6>(scene, o);
        compare<9>(scene, o);
      }
}

TEST(RobustKernels, EsmAndHostGradients) {
  for (const tp::RobustKind kind : kKinds)
    for (const int n : {20, 65, 700})
      for (const auto policy : {tp::LinearisePolicy::esm, tp::LinearisePolicy::template_jacobian}) {
        SCOPED_TRACE(n * 10 + static_cast<int>(kind));
        PolicyScene s(static_cast<unsigned>(n), n);
        const tp::PhotometricOptions o = options_of(kind, 0.6, n != 65);
        tp::PhotometricOptions plain = o;
        plain.normalisation = tp::Normalisation::frozen;
        plain.robust = {tp::RobustKind::l2, 1};
        const auto in = s.policy_input();
        constexpr tp::Parameters kBoth = tp::Parameters::pose_plane;
        const tp::ResidualRequest unweighted{in, s.theta, s.T_t_h, plain}, request{in, s.theta, s.T_t_h, o};
        const auto scale = tp::reference::linearise<kBoth>(unweighted.by(policy), s.workspace);
        const auto exact = tp::reference::linearise<kBoth>(request.by(policy), s.workspace);
        tp::TemplatePatch prepared;
        ASSERT_EQ(prepared.prepare(in.patch), tp::Status::ok);
        std::vector<std::int16_t> values(static_cast<std::size_t>(n + simd::kTemplateBlock));
        for (const simd::Target target : testable_targets()) {
          const TargetScope scope(target);
          SCOPED_TRACE(simd::to_string(target));
          const auto fast = tp::linearise<kBoth>(request.by(policy), s.workspace);
          EXPECT_EQ(fast.path, tp::Path::kernel);
          textplane_test::expect_close<9>(fast, exact, kEntryBound, scale);
          if (policy == tp::LinearisePolicy::esm) continue;
          // Of the fixed point: 0.08 / sigma (template_patch.hpp), sigma being above 30 here.
          const auto fixed = tp::linearise<kBoth>(request.by(policy, &prepared), s.workspace);
          EXPECT_EQ(fixed.path, tp::Path::kernel);
          textplane_test::expect_close<9>(fixed, exact, 0.08 / 30, scale);
          const auto args = tp::detail::kernel_args(request, s.workspace, s.workspace.visible_flags(), nullptr);
          EXPECT_NEAR(simd::evaluate_template(prepared.model(), args, values.data()).cost, exact.cost, 0.08 / 30);
        }
      }
}

TEST(RobustKernels, Batches) {
  for (const tp::RobustKind kind : kKinds)
    for (const bool masked : {false, true}) {
      SCOPED_TRACE(static_cast<int>(kind));
      const tp::PhotometricOptions o = options_of(kind, 0.6, true);
      std::vector<PolicyScene> scenes;
      std::vector<tp::TextBatchItem> items;
      std::vector<tp::SE3d> poses;
      for (int i = 0; i < 19; ++i) scenes.emplace_back(4U, 10 + i * 7 % 40);
      for (PolicyScene& s : scenes) {
        items.push_back({s.policy_input(masked).patch, s.host_camera, s.theta});
        poses.push_back(s.T_t_h);
      }
      const tp::TextBatch batch(items.data(), 19);
      tp::TextBatchResult result(batch);
      for (const simd::Target target : testable_targets()) {
        const TargetScope scope(target);
        SCOPED_TRACE(simd::to_string(target));
        ASSERT_EQ(tp::linearise_batch<tp::Parameters::pose_plane>(batch, scenes[0].view(), scenes[0].target_camera,
                                                                  poses.data(), o, result),
                  tp::Status::ok);
        for (int i = 0; i < 19; ++i) {
          SCOPED_TRACE(i);
          PolicyScene& s = scenes[static_cast<std::size_t>(i)];
          tp::PhotometricOptions plain = o;
          plain.normalisation = tp::Normalisation::frozen;
          plain.robust = {tp::RobustKind::l2, 1};
          const auto in = s.policy_input(masked);
          const auto scale = equations<9, true>(in, s.theta, s.T_t_h, plain, s.workspace);
          const auto exact = equations<9, true>(in, s.theta, s.T_t_h, o, s.workspace);
          textplane_test::expect_close<9>(result.normal_equations<tp::Parameters::pose_plane>(i), exact, kEntryBound,
                                          scale);
        }
      }
    }
}

}  // namespace robust_kernels_test
