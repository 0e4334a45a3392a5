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

// The arguments of the kernels for a scene, and their memory.
struct Call {
  std::vector<float> scratch, more;
  std::vector<std::uint8_t> flags;
  std::vector<std::int16_t> values;
  simd::ResidualArgs args;

  Call(const PolicyScene& s, const tp::PhotometricOptions& o)
      : scratch(simd::residual_scratch(s.n())),
        more(simd::esm_scratch(s.n())),
        flags(static_cast<std::size_t>(s.n())),
        values(static_cast<std::size_t>(s.n() + simd::kTemplateBlock)) {
    args.x = s.x.data();
    args.y = s.y.data();
    args.intensity = s.intensity.data();
    args.n = s.n();
    args.target.data = s.image.data();
    args.target.stride = args.target.width = PolicyScene::kWidth;
    args.target.height = PolicyScene::kHeight;
    for (int k = 0; k < 9; ++k) args.R[k] = s.T_t_h.R(k / 3, k % 3);
    for (int k = 0; k < 3; ++k) args.t[k] = s.T_t_h.t[k], args.theta[k] = s.theta[k];
    const tp::Pinhole<double>* cameras[] = {&s.host_camera, &s.target_camera};
    for (int k = 0; k < 2; ++k) {
      double* out = k == 0 ? args.host_camera : args.target_camera;
      out[0] = cameras[k]->fx, out[1] = cameras[k]->fy, out[2] = cameras[k]->cx, out[3] = cameras[k]->cy;
    }
    args.exact = o.normalisation == tp::Normalisation::exact;
    args.robust = static_cast<simd::RobustKind>(o.robust.kind);
    args.delta = o.robust.delta;
    args.min_contrast = o.min_contrast;
    args.min_visible = o.min_visible;
    args.flags = flags.data();
    args.scratch = scratch.data();
  }
};

template <int P>
tp::NormalEquations<P> take(const simd::ResidualInfo& info, const double* H, const double* b) {
  tp::NormalEquations<P> out;
  out.status = info.status;
  if (!is_ok(info.status)) return out;
  for (int i = 0; i < P * P; ++i) out.H.data()[i] = H[i];
  for (int i = 0; i < P; ++i) out.b[i] = b[i];
  out.cost = info.cost;
  out.error = info.error;
  out.zncc = 1 - 0.5 * info.error;
  out.mean = info.mean;
  out.s = info.s;
  out.visible = info.visible;
  return out;
}

tp::PhotometricOptions options_of(tp::RobustKind kind, double delta, bool exact) {
  tp::PhotometricOptions o = any_options(exact);
  o.robust = {kind, delta};
  return o;
}

template <int P>
tp::NormalEquations<P> kernel(PolicyScene& s, const tp::PhotometricOptions& o) {
  Call call(s, o);
  double H[81], b[9];
  simd::ResidualInfo info;
  if (P == 3) info = simd::linearise_plane(call.args, H, b);
  if (P == 6) info = simd::linearise_pose(call.args, H, b);
  if (P == 9) info = simd::linearise_pose_plane(call.args, H, b);
  return take<P>(info, H, b);
}

template <int P>
void compare(PolicyScene& s, const tp::PhotometricOptions& o) {
  tp::PhotometricOptions plain = o;
  plain.normalisation = tp::Normalisation::frozen;
  plain.robust = {tp::RobustKind::l2, 1};
  const auto scale = equations<P, true>(s.input(), s.theta, s.T_t_h, plain, s.workspace);
  const auto exact = equations<P, true>(s.input(), s.theta, s.T_t_h, o, s.workspace);
  const auto cost = tp::reference::evaluate(s.input(), s.theta, s.T_t_h, o, s.workspace);
  for (const simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    SCOPED_TRACE(simd::to_string(target));
    textplane_test::expect_close<P>(kernel<P>(s, o), exact, scale, kEntryBound);
    Call call(s, o);
    const simd::ResidualInfo info = simd::evaluate(call.args);
    ASSERT_EQ(info.status, cost.status);
    EXPECT_NEAR(info.cost, cost.cost, kCostBound * cost.cost + kCostFloor);
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
        const auto scale = tp::reference::linearise_by<9>(policy, in, s.theta, s.T_t_h, plain, s.workspace);
        const auto exact = tp::reference::linearise_by<9>(policy, in, s.theta, s.T_t_h, o, s.workspace);
        tp::TemplatePatch prepared;
        ASSERT_EQ(prepared.prepare(in.patch), tp::Status::ok);
        for (const simd::Target target : testable_targets()) {
          const TargetScope scope(target);
          SCOPED_TRACE(simd::to_string(target));
          Call call(s, o);
          double H[81], b[9];
          simd::EsmArgs esm{call.args, s.gx.data(), s.gy.data(), policy == tp::LinearisePolicy::esm, call.more.data()};
          textplane_test::expect_close<9>(take<9>(simd::linearise_esm(esm, H, b), H, b), exact, kEntryBound, scale);
          if (policy == tp::LinearisePolicy::esm) continue;
          // Of the fixed point: 0.08 / sigma (template_patch.hpp), sigma being above 30 here.
          const auto info = simd::linearise_template(prepared.model(), call.args, call.values.data(), H, b);
          textplane_test::expect_close<9>(take<9>(info, H, b), exact, 0.08 / 30, scale);
          EXPECT_NEAR(simd::evaluate_template(prepared.model(), call.args, call.values.data()).cost, exact.cost,
                      0.08 / 30);
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
        simd::BatchArgs args;
        batch.fill(&args);
        result.fill(9, &args);
        args.target.data = scenes[0].image.data();
        args.target.stride = args.target.width = PolicyScene::kWidth;
        args.target.height = PolicyScene::kHeight;
        args.pose = poses[0].R.data();
        const tp::Pinhole<double>& c = scenes[0].target_camera;
        const double camera[] = {c.fx, c.fy, c.cx, c.cy};
        for (int k = 0; k < 4; ++k) args.camera[k] = camera[k];
        args.robust = static_cast<simd::RobustKind>(kind);
        args.delta = o.robust.delta;
        simd::batch_linearise_pose_plane(args);
        for (int i = 0; i < 19; ++i) {
          SCOPED_TRACE(i);
          PolicyScene& s = scenes[static_cast<std::size_t>(i)];
          tp::PhotometricOptions plain = o;
          plain.normalisation = tp::Normalisation::frozen;
          plain.robust = {tp::RobustKind::l2, 1};
          const auto in = s.policy_input(masked);
          const auto scale = equations<9, true>(in, s.theta, s.T_t_h, plain, s.workspace);
          const auto exact = equations<9, true>(in, s.theta, s.T_t_h, o, s.workspace);
          textplane_test::expect_close<9>(result.normal_equations<9>(i), exact, kEntryBound, scale);
        }
      }
    }
}

}  // namespace robust_kernels_test
