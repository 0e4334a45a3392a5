// The scale that cv::findTransformECC finds, and its form of several scales, beside ours on the same images, each from
// the truth. By its issues 29774 and 29781 ECC's is too small: template and image are blurred with their borders
// mirrored, and what is mirrored counts as measured.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>

#include "opencv/as_mat.hpp"
#include "opencv/ecc_multiscale.hpp"
#include "solver/bias/scale_trials.hpp"
#include "textplane/solver/pose.hpp"

namespace {

using namespace textplane_test;

constexpr int kTrials = 24;
const cv::TermCriteria kCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-8);

struct Found {
  std::vector<double> scale;
  double corners = 0;  // Mean, px.

  void add(const ScaleTrial& trial, const tp::Matrix3<double>& H) {
    scale.push_back(trial.scale_error(H));
    corners += trial.corner_error(H) / kTrials;
  }
};

using Ecc = std::function<void(const cv::Mat&, const cv::Mat&, cv::Mat*)>;

tp::Matrix3<double> by_ecc(const ScaleTrial& trial, const cv::Mat& host, const cv::Mat& target, bool tilted,
                           const Ecc& ecc) {
  const tp::Matrix3<double> truth = trial.homography() / trial.homography()(2, 2);
  cv::Mat warp(tilted ? 3 : 2, 3, CV_32F);
  for (int i = 0; i < warp.rows * 3; ++i) warp.at<float>(i / 3, i % 3) = static_cast<float>(truth(i / 3, i % 3));
  ecc(host, target, &warp);
  tp::Matrix3<double> H = tp::Matrix3<double>::Identity();
  for (int i = 0; i < warp.rows * 3; ++i) H(i / 3, i % 3) = static_cast<double>(warp.at<float>(i / 3, i % 3));
  return H;
}

tp::Matrix3<double> by_ours(const ScaleTrial& trial, const tp::Image<std::uint8_t>& host,
                            const tp::Image<std::uint8_t>& target, int levels) {
  const double right = host.width() - 1, bottom = host.height() - 1;
  tp::Quad<double> quad;
  quad.corner = {tp::Vector2<double>(0, 0), tp::Vector2<double>(right, 0), tp::Vector2<double>(right, bottom),
                 tp::Vector2<double>(0, bottom)};
  const tp::Pyramid host_levels(host.view(), levels), target_levels(target.view(), levels);
  std::vector<std::vector<tp::Vector2<float>>> pixels(static_cast<std::size_t>(levels));
  for (int l = 0; l < levels; ++l)
    for (int y = 0; y < host.height() >> l; ++y)
      for (int x = 0; x < host.width() >> l; ++x)
        pixels[static_cast<std::size_t>(l)].push_back({static_cast<float>(x), static_cast<float>(y)});
  const tp::TextPatch patch = tp::patch_from_pixels(host_levels.view(), trial.host_camera, quad, pixels);
  tp::PoseOptions options;
  options.coarsest_level = levels - 1;
  const auto fit = tp::align_pose(patch, trial.theta, trial.T_t_h, target_levels.view(), trial.target_camera, options);
  EXPECT_TRUE(tp::is_ok(fit.status)) << tp::to_string(fit.status);
  return trial.homography(fit.T_t_h, trial.theta);
}

// Ours is zero within what 24 trials tell, some 2e-5; ECC's is 50 times that. An OpenCV without the fault passes too.
void ours_has_less_bias(const char* what, bool tilted, int levels, const Ecc& ecc) {
  Found peer, ours;
  for (unsigned seed = 1; seed <= kTrials; ++seed) {
    const ScaleTrial trial(seed, tilted);
    const tp::Image<std::uint8_t> host = trial.host<std::uint8_t>(0), target = trial.target<std::uint8_t>();
    peer.add(trial, by_ecc(trial, as_mat(host), as_mat(target), tilted, ecc));
    ours.add(trial, by_ours(trial, host, target, levels));
  }
  const Bias a(ours.scale), b(peer.scale);
  std::printf("%s: scale of ours %+.1e (standard error %.1e), corners %.4f px; of ECC %+.1e (%.1e), %.4f px\n", what,
              a.mean, a.standard_error, ours.corners, b.mean, b.standard_error, peer.corners);
  EXPECT_LT(std::abs(a.mean), std::max(std::abs(b.mean) / 50, 4 * a.standard_error));
  EXPECT_LT(ours.corners, std::max(peer.corners / 5, 0.01));
}

const Ecc kOneScale = [](const cv::Mat& host, const cv::Mat& target, cv::Mat* warp) {
  const int motion = warp->rows == 3 ? cv::MOTION_HOMOGRAPHY : cv::MOTION_AFFINE;
  cv::findTransformECC(host, target, *warp, motion, kCriteria, cv::noArray(), kEccBlur);
};
const Ecc kManyScales = [](const cv::Mat& host, const cv::Mat& target, cv::Mat* warp) {
  ecc_multiscale(host, target, kCriteria, 3, warp);
};

TEST(EccBias, AffineOnOneLevel) { ours_has_less_bias("affine", false, 1, kOneScale); }
TEST(EccBias, HomographyOnOneLevel) { ours_has_less_bias("homography", true, 1, kOneScale); }
TEST(EccBias, AffineCoarseToFine) { ours_has_less_bias(kEccMultiscale, false, 3, kManyScales); }
TEST(EccBias, HomographyCoarseToFine) { ours_has_less_bias(kEccMultiscale, true, 3, kManyScales); }

}  // namespace
