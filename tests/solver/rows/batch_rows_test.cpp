// Batches of texts and of candidate poses between images whose rows are taken one after the other.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "solver/rows/rows_scene.hpp"
#include "support/targets.hpp"
#include "textplane/photometry/candidates.hpp"
#include "textplane/photometry/text_batch.hpp"

namespace batch_rows_test {

using namespace textplane_test;
using namespace textplane_test::rows;

// Who of host and target takes its rows one after the other.
struct Rolling {
  bool host, target;
};
constexpr Rolling kRolling[] = {{true, true}, {true, false}, {false, true}};

// Texts of one host before one target, on a level of both.
struct Texts {
  Views views;
  tp::CameraView host, target;
  tp::Pyramid image;
  std::vector<tp::TextPatch> patches;

  Texts(unsigned seed, const Rolling& rolling)
      : views(seed),
        host(kCamera.pinhole, nullptr, rolling.host ? &views.host : nullptr),
        target(kCamera.pinhole, nullptr, rolling.target ? &views.target : nullptr),
        image(picture(views.T_t_w, rolling.target ? views.target : tp::RowMotion()).view(), 3) {
    const tp::Image<std::uint8_t> picture_of_host = picture(views.T_h_w, rolling.host ? views.host : tp::RowMotion());
    for (int i = 0; i < 5; ++i) {
      tp::Quad<double> quad = kQuad;
      for (auto& corner : quad.corner) corner += tp::Vector2<double>(12 * i - 20, 24 * i - 30);
      patches.push_back(tp::make_patch(picture_of_host.view(), host, quad));
      EXPECT_TRUE(tp::is_ok(patches.back().status));
    }
  }
  tp::PhotometricInput input(std::size_t text, int level) const {
    return tp::photometric_input(patches[text], level, image.view(), target);
  }
};

TEST(BatchRows, TextsAreJudgedAsOneByOne) {
  for (const Rolling& rolling : kRolling) {
    const Texts texts(2, rolling);
    for (int level = 0; level < 2; ++level) {
      std::vector<tp::TextBatchItem> items;
      for (const tp::TextPatch& patch : texts.patches)
        items.push_back({patch.levels[static_cast<std::size_t>(level)].view(), patch.camera.at_level(level),
                         texts.views.theta, patch.rows});
      const auto count = static_cast<int>(items.size());
      const std::vector<tp::SE3d> poses(items.size(), texts.views.T_t_h());
      const tp::TextBatch batch(items.data(), count);
      tp::TextBatchResult result(batch);
      const tp::ImageView8 image = texts.image.view().level[static_cast<std::size_t>(level)];
      const tp::CameraView camera = texts.target.at_level(level);
      for (const tp::simd::Target target : testable_targets()) {
        const TargetScope scope(target);
        ASSERT_EQ(
            tp::linearise_batch<tp::Parameters::pose_plane>(batch, image, camera, poses.data(), {}, result, level),
            tp::Status::ok);
        for (int i = 0; i < count; ++i) {
          const tp::PhotometricInput in = texts.input(static_cast<std::size_t>(i), level);
          tp::PhotometricWorkspace workspace(in.patch.n);
          const tp::ResidualRequest<std::uint8_t> request{in, texts.views.theta, texts.views.T_t_h()};
          const auto exact = tp::reference::linearise<tp::Parameters::pose_plane>(request, workspace);
          ASSERT_EQ(result.status(i), tp::Status::ok);
          EXPECT_GT(result.zncc(i), 0.98) << i;
          EXPECT_EQ(result.visible(i), exact.visible);
          const auto sums = result.normal_equations<tp::Parameters::pose_plane>(i);
          EXPECT_LT((sums.H - exact.H).norm(), 1e-4 * exact.H.norm());
          for (int k = 0; k < 9; ++k) EXPECT_NEAR(sums.b[k], exact.b[k], 1e-5 * std::sqrt(exact.H(k, k))) << k;
        }
        tp::TextBatchResult costs(batch);
        ASSERT_EQ(tp::evaluate_batch(batch, image, camera, poses.data(), {}, costs, level), tp::Status::ok);
        for (int i = 0; i < count; ++i) EXPECT_NEAR(costs.zncc(i), result.zncc(i), 1e-4);
      }
    }
  }
}

// Where host and target roll, the poses of the time stamps alone are several tenths of a pixel off.
TEST(BatchRows, WithoutRowsTextsLookLessAlike) {
  const Texts texts(2, {true, true});
  double with = 0, without = 0;
  for (std::size_t i = 0; i < texts.patches.size(); ++i) {
    const tp::PhotometricInput moving = texts.input(i, 0);
    const tp::TextBatchItem item{moving.patch, moving.host_camera, texts.views.theta, texts.patches[i].rows},
        still{moving.patch, moving.host_camera, texts.views.theta, {}};
    const tp::SE3d T_t_h = texts.views.T_t_h();
    const tp::TextBatch of_moving(&item, 1), of_still(&still, 1);
    tp::TextBatchResult result(of_moving), other(of_still);
    ASSERT_EQ(tp::evaluate_batch(of_moving, moving.target, texts.target, &T_t_h, {}, result), tp::Status::ok);
    ASSERT_EQ(tp::evaluate_batch(of_still, moving.target, kCamera, &T_t_h, {}, other), tp::Status::ok);
    with += 1 - result.zncc(0);
    without += 1 - other.zncc(0);
  }
  EXPECT_GT(without, 5 * with);
}

// More candidates than are made still at a time, some of them far off or broken.
TEST(BatchRows, CandidatesAreJudgedAsOneByOne) {
  for (const Rolling& rolling : kRolling) {
    const Texts texts(5, rolling);
    for (int level = 0; level < 2; ++level) {
      const tp::PhotometricInput in = texts.input(2, level);
      tp::TemplatePatch prepared;
      ASSERT_EQ(prepared.prepare(in.patch), tp::Status::ok);
      Random random(8);
      std::vector<tp::SE3d> poses(37, texts.views.T_t_h());
      for (std::size_t i = 1; i < poses.size(); ++i)
        poses[i] = tp::se3_exp<double>(random.twist(0.02, 0.02)) * poses[i];
      poses[20].t[2] -= 100;  // behind
      poses[21].R(0, 0) = std::nan("");
      tp::PhotometricWorkspace workspace(in.patch.n);
      std::vector<float> alone(poses.size());
      for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto cost =
            tp::reference::evaluate(tp::ResidualRequest<std::uint8_t>{in, texts.views.theta, poses[i]}, workspace);
        alone[i] = tp::is_ok(cost.status) ? static_cast<float>(cost.zncc) : -1.0F;
      }
      EXPECT_GT(alone[0], 0.98F);
      EXPECT_EQ(alone[20], -1.0F);
      EXPECT_EQ(alone[21], -1.0F);
      for (const tp::simd::Target target : testable_targets()) {
        const TargetScope scope(target);
        for (const bool with_template : {false, true}) {
          std::vector<float> zncc(poses.size(), 7.0F);
          ASSERT_EQ(tp::zncc_candidates(in, texts.views.theta, poses.data(), static_cast<int>(poses.size()), {},
                                        workspace, zncc.data(), with_template ? &prepared : nullptr),
                    tp::Status::ok);
          for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_NEAR(zncc[i], alone[i], 0.05 / 30) << i;
        }
      }
    }
  }
}

}  // namespace batch_rows_test
