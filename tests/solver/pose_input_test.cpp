// refine_pose() and align_pose(): what they say about terms that cannot be used, and input that no pose can come from.
#include "textplane/solver/pose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "solver/pose_scene.hpp"

namespace pose_test {
using textplane::Status;

const double kNan = std::numeric_limits<double>::quiet_NaN();

// Float images run on the reference, 8-bit ones on the kernels, and points on neither.
TEST(RefinePose, SaysWhatComputedItsTexts) {
  Input input;
  EXPECT_EQ(input.solve(input.truth).path, textplane::Path::reference);
  EXPECT_EQ(input.solve(input.truth, {}, false).path, textplane::Path::kernel);

  const textplane::ImageViewF grey = input.target.view().level[0];
  textplane::Image<std::uint8_t> image(grey.width(), grey.height());
  for (int y = 0; y < grey.height(); ++y)
    for (int x = 0; x < grey.width(); ++x)
      image(x, y) = static_cast<std::uint8_t>(std::min(std::max(grey(x, y), 0.0F), 255.0F));
  const textplane::Pyramid pyramid(image.view());
  PoseOptions options;
  for (const bool precise : {false, true}) {
    options.photometric.precise = precise;
    const PoseFit fit = textplane::refine_pose(input.texts.data(), 1, nullptr, 0, pyramid, input.scene.camera,
                                               input.truth, options, input.workspace);
    EXPECT_EQ(fit.texts, 1);
    EXPECT_EQ(fit.path, precise ? textplane::Path::reference : textplane::Path::kernel);
  }
}

TEST(RefinePose, UnusableTermsAreSkipped) {
  Input input;
  const PoseFit expected = input.solve(textplane::se3_exp<double>(Vec6::Constant(0.003)) * input.truth, tight());
  TextPatch flat = input.patches[0];
  for (auto& level : flat.levels) level.intensity.assign(level.intensity.size(), 100.0F);
  TextPatch few = input.patches[0];
  for (auto& level : few.levels) level.x.resize(9), level.y.resize(9), level.intensity.resize(9);
  const TextPatch empty;
  PoseTextTerm bad = input.texts[0];
  for (const TextPatch* patch : {static_cast<const TextPatch*>(&flat), static_cast<const TextPatch*>(&few), &empty,
                                 static_cast<const TextPatch*>(nullptr)}) {
    bad.patch = patch;
    input.texts.insert(input.texts.begin() + 1, bad);
  }
  bad = input.texts[0];
  bad.theta[1] = kNan;
  input.texts.push_back(bad);
  bad.theta = -input.texts[0].theta;  // Behind the host.
  input.texts.push_back(bad);
  bad = input.texts[0];
  bad.T_w_h.t = Vec3(50, 0, 0);  // Out of view.
  input.texts.push_back(bad);
  bad = input.texts[0];
  bad.weight = kNan;
  input.texts.push_back(bad);

  PosePointTerm point = input.points[0];
  point.p_w[2] = kNan;
  input.points.push_back(point);
  point = input.points[0];
  point.px[0] = kNan;
  input.points.push_back(point);
  point = input.points[0];
  point.p_w = input.truth.inverse() * Vec3(0, 0, -3);
  input.points.push_back(point);
  for (const double z : {1e-9, 0.7e-3}) {  // 89.96 degrees off the optical axis
    point.p_w = input.truth.inverse() * Vec3(1, 0, z);
    input.points.push_back(point);
  }
  point = input.points[0];
  point.sigma = 0;
  input.points.push_back(point);

  std::vector<float> zncc(input.texts.size()), chi2(input.points.size());
  const PoseFit fit = input.solve(textplane::se3_exp<double>(Vec6::Constant(0.003)) * input.truth, tight(), true, true,
                                  zncc.data(), chi2.data());
  EXPECT_EQ(fit.status, Status::converged);
  EXPECT_LT(pose_distance(fit.T_t_w, expected.T_t_w), 1e-9);
  EXPECT_EQ(fit.texts, 3);
  EXPECT_EQ(fit.visible_pixels, expected.visible_pixels);
  for (std::size_t i = 0; i < zncc.size(); ++i) EXPECT_EQ(zncc[i] < 0, i != 0 && i != 5 && i != 6) << i;
  for (std::size_t i = 0; i < chi2.size(); ++i) EXPECT_EQ(chi2[i] < 0, i >= 60) << i;
}

TEST(RefinePose, InputThatNoPoseComesFromGetsAStatus) {
  Input input;
  const PoseOptions options;
  const auto run = [&](const PoseOptions& o, const SE3d& T, const Pinhole<double>& camera, int texts, int points) {
    const PoseFit fit = refine_pose(input.texts.data(), texts, input.points.data(), points, input.target.view(), camera,
                                    T, o, input.workspace);
    EXPECT_FALSE(is_ok(fit.status));
    EXPECT_TRUE(fit.information.isZero());
    if (all_finite(T)) {
      EXPECT_EQ(fit.T_t_w.R, T.R);
      EXPECT_EQ(fit.T_t_w.t, T.t);
    }
    return fit.status;
  };
  const Pinhole<double>& camera = input.scene.camera;
  const SE3d& T = input.truth;
  EXPECT_EQ(run(options, T, camera, 3, 60), Status::invalid_argument);  // Nothing reserved.
  input.workspace.reserve(input.texts.data(), 3, 60);
  EXPECT_EQ(run(options, T, camera, 0, 0), Status::too_few);
  EXPECT_EQ(run(options, T, camera, 0, 1), Status::rank_deficient);
  EXPECT_EQ(run(options, T, camera, 0, 2), Status::rank_deficient);
  EXPECT_EQ(run(options, T, camera, -1, 2), Status::invalid_argument);
  SE3d bad = T;
  bad.t[1] = kNan;
  EXPECT_EQ(run(options, bad, camera, 3, 60), Status::non_finite);
  EXPECT_EQ(run(options, T, Pinhole<double>(kNan, 1, 0, 0), 3, 60), Status::non_finite);
  EXPECT_EQ(run(options, T, Pinhole<double>(-1, 1, 0, 0), 3, 60), Status::invalid_argument);
  PoseOptions wrong;
  wrong.sigma_photo = 0;
  EXPECT_EQ(run(wrong, T, camera, 3, 60), Status::invalid_argument);
  wrong = {};
  wrong.photometric.robust.delta = kNan;
  EXPECT_EQ(run(wrong, T, camera, 3, 60), Status::invalid_argument);
  wrong = {};
  wrong.finest_level = 2;
  wrong.coarsest_level = 1;
  EXPECT_EQ(run(wrong, T, camera, 3, 60), Status::invalid_argument);
  wrong = {};
  wrong.finest_level = wrong.coarsest_level = 5;
  EXPECT_EQ(run(wrong, T, camera, 3, 0), Status::invalid_argument);
  SE3d away = T;
  away.t[0] += 100;
  EXPECT_EQ(run(options, away, camera, 3, 0), Status::out_of_view);
  SE3d behind = T;
  behind.t[2] -= 100;
  EXPECT_EQ(run(options, behind, camera, 3, 0), Status::behind_camera);
  input.target = input.target.map([](double) { return 50.0; });
  EXPECT_EQ(run(options, T, camera, 3, 0), Status::no_contrast);
  EXPECT_EQ(refine_pose(nullptr, 1, nullptr, 0, input.target.view(), camera, T, options, input.workspace).status,
            Status::invalid_argument);
  EXPECT_EQ(refine_pose(nullptr, 0, nullptr, 1, input.target.view(), camera, T, options, input.workspace).status,
            Status::invalid_argument);
  // Points need no image.
  EXPECT_TRUE(is_ok(
      refine_pose(nullptr, 0, input.points.data(), 60, textplane::PyramidView(), camera, T, options, input.workspace)
          .status));
}

TEST(RefinePose, TermsAreSkippedWhereTheOptionsAreWrong) {
  Input input;
  PoseOptions wrong;
  wrong.sigma_photo = 0;
  input.workspace.reserve(input.texts.data(), 3, 60);
  std::vector<float> zncc(3, 7.0F), chi2(60, 7.0F);
  EXPECT_EQ(refine_pose(input.texts.data(), 3, input.points.data(), 60, input.target.view(), input.scene.camera,
                        input.truth, wrong, input.workspace, zncc.data(), chi2.data())
                .status,
            Status::invalid_argument);
  EXPECT_EQ(zncc, std::vector<float>(3, -1.0F));
  EXPECT_EQ(chi2, std::vector<float>(60, -1.0F));
}

TEST(RefinePose, GarbageNeverGivesANonFinitePose) {
  Input input(false, 30, 2);
  Random random(77);
  for (int trial = 0; trial < 150; ++trial) {
    Input garbage = input;
    for (std::size_t i = 0; i < garbage.texts.size(); ++i) garbage.texts[i].patch = &garbage.patches[i];
    for (auto& text : garbage.texts) {
      text.theta = random.normal3(std::pow(10, random.uniform(-8, 8)));
      text.weight = std::pow(10, random.uniform(-150, 150));
    }
    for (auto& point : garbage.points) {
      point.p_w = random.normal3(std::pow(10, random.uniform(-100, 100)));
      point.sigma = std::pow(10, random.uniform(-100, 100));
    }
    const PoseFit fit =
        garbage.solve(textplane::se3_exp<double>(random.twist(1, 1)) * input.truth, {}, trial % 3 != 0, trial % 3 != 1);
    EXPECT_TRUE(all_finite(fit.T_t_w));
    if (is_ok(fit.status)) {
      EXPECT_TRUE(textplane::all_finite(fit.information));
      EXPECT_TRUE(textplane::is_finite(fit.cost));
    }
  }
}

}  // namespace pose_test
