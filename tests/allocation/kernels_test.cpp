// Kernels allocate nothing, on any target.
#include <array>
#include <tuple>
#include <vector>

#include "allocation/count.hpp"
#include "photometry/scene.hpp"
#include "support/targets.hpp"
#include "textplane/features/align.hpp"
#include "textplane/features/fast.hpp"
#include "textplane/features/klt.hpp"
#include "textplane/photometry/candidates.hpp"
#include "textplane/photometry/prepared_target.hpp"
#include "textplane/photometry/residual_policy.hpp"
#include "textplane/photometry/text_batch.hpp"
#include "textplane/photometry/warp_patch.hpp"

namespace {
using namespace textplane_test;
using tp::Status;

TEST(NoAllocation, SeesWhatIsAllocated) {
  const long before = allocations();
  std::vector<int> v(100);
  EXPECT_EQ(allocations(), before + 1);
  EXPECT_EQ(v[5], 0);
  const Eigen::MatrixXd m = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(v.size()), 7, 1.0);
  EXPECT_EQ(allocations(), before + 2);
  EXPECT_EQ(m(3, 3), 1);
}

struct Input {
  Scene<std::uint8_t> scene{1};
  std::vector<float> gradient = std::vector<float>(scene.x.size(), 3.0F);
  tp::PhotometricInput in = scene.input();
  tp::TemplatePatch prepared;
  tp::PhotometricOptions options;

  Input() {
    in.patch.gx = in.patch.gy = gradient.data();
    prepared.prepare(in.patch);
  }
};

TEST(NoAllocation, ReferenceKernels) {
  Input i;
  std::vector<double> r(i.scene.x.size()), J(i.scene.x.size() * 9);
  std::array<Status, 6> status{};
  {
    const NoAllocation guard;
    namespace ref = tp::reference;
    const auto& [in, theta, T] = std::tie(i.in, i.scene.theta, i.scene.T_t_h);
    auto& workspace = i.scene.workspace;
    workspace.reserve(i.scene.n());
    status = {ref::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, theta, T, i.options}, workspace).status,
              ref::linearise<tp::Parameters::plane>(tp::ResidualRequest{in, theta, T, i.options}, workspace).status,
              ref::linearise<tp::Parameters::pose_plane>(
                  tp::ResidualRequest{in, theta, T, i.options}.by(tp::LinearisePolicy::esm), workspace)
                  .status,
              ref::linearise<tp::Parameters::host_target_plane>(
                  tp::world_request(in, theta, i.scene.T_w_h, i.scene.T_w_t, tp::PerturbationSide::left, i.options),
                  workspace)
                  .status,
              ref::evaluate(tp::ResidualRequest{in, theta, T, i.options}, workspace).status,
              ref::residuals<tp::Parameters::pose_plane>(tp::ResidualRequest{in, theta, T, i.options}, workspace,
                                                         r.data(), J.data())
                  .status};
  }
  for (const Status s : status) EXPECT_EQ(s, Status::ok);
}

TEST(NoAllocation, NormalEquationsAndCosts) {
  for (const tp::simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    Input i;
    const std::vector<tp::SE3d> poses(20, i.scene.T_t_h);
    std::vector<float> zncc(20);
    const std::vector<tp::TextBatchItem> items(20, {i.in.patch, i.in.host_camera, i.scene.theta});
    const tp::TextBatch batch(items.data(), 20);
    tp::TextBatchResult result(batch);
    std::array<Status, 10> status{};
    {
      const NoAllocation guard;
      const auto& [in, theta, T] = std::tie(i.in, i.scene.theta, i.scene.T_t_h);
      auto& workspace = i.scene.workspace;
      status = {
          tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, theta, T, i.options}, workspace).status,
          tp::linearise<tp::Parameters::plane>(tp::ResidualRequest{in, theta, T, i.options}, workspace).status,
          tp::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{in, theta, T, i.options}, workspace).status,
          tp::linearise<tp::Parameters::host_target_plane>(
              tp::world_request(in, theta, i.scene.T_w_h, i.scene.T_w_t, tp::PerturbationSide::right, i.options),
              workspace)
              .status,
          tp::evaluate(tp::ResidualRequest{in, theta, T, i.options}, workspace).status,
          tp::linearise<tp::Parameters::pose_plane>(
              tp::ResidualRequest{in, theta, T, i.options}.by(tp::LinearisePolicy::template_jacobian, &i.prepared),
              workspace)
              .status,
          tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, theta, T, i.options}.by(tp::LinearisePolicy::esm),
                                              workspace)
              .status,
          tp::linearise<tp::Parameters::pose>(
              tp::ResidualRequest{in, theta, T, i.options}.by(tp::LinearisePolicy::hybrid, &i.prepared), workspace)
              .status,
          tp::zncc_candidates(in, theta, poses.data(), 20, i.options, workspace, zncc.data(), &i.prepared),
          tp::linearise_batch<tp::Parameters::pose_plane>(batch, in.target, in.target_camera, poses.data(), i.options,
                                                          result)};
    }
    for (const Status s : status) EXPECT_EQ(s, Status::ok);
  }
}

TEST(NoAllocation, ImagesAndFeatures) {
  for (const tp::simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    const auto image = texture<std::uint8_t>(200, 160, 3);
    tp::Pyramid pyramid(image.view(), 3);
    tp::PreparedTarget pairs(image.view());
    tp::Image<std::uint8_t> out(60, 30);
    std::vector<std::uint8_t> scratch(tp::fast_scratch_size(image.width()));
    std::vector<tp::Corner> corners(32000);
    int found = 0;
    const std::vector<tp::Vector2<float>> from{{60.5F, 70.2F}, {100, 80}};
    std::vector<tp::KltResult> tracks(2);
    tp::PointPatch patch;
    tp::KltResult aligned;
    std::array<Status, 5> status{};
    {
      const NoAllocation guard;
      tp::Matrix3<double> H = tp::Matrix3<double>::Identity();
      H(0, 2) = 40.3;
      H(1, 2) = 50.7;
      status = {pyramid.build(image.view(), 3), pairs.prepare(image.view()),
                tp::warp_patch<std::uint8_t, std::uint8_t>(image.view(), H, out.view()).status,
                tp::detect_fast(image.view(), 15, true, scratch.data(), corners.data(), 32000, &found),
                tp::extract_point_patch(image.view(), {80, 70}, Eigen::Matrix2f::Identity(), 10, &patch)};
      aligned = tp::align_point_patch(patch, image.view(), {80.4F, 70.3F});
      tp::track_klt(pyramid.view(), pyramid.view(), from.data(), nullptr, 2, {}, tracks.data());
    }
    for (const Status s : status) EXPECT_EQ(s, Status::ok);
    EXPECT_GT(found, 10);
    EXPECT_TRUE(tp::is_ok(aligned.status));
    for (const tp::KltResult& track : tracks) EXPECT_TRUE(tp::is_ok(track.status));
  }
}

}  // namespace
