// The rotation between two frames, also where it is far from where the search begins.
#include "textslam/track/rotation_prior.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "textslam/lens_support.hpp"

namespace textslam {
namespace rotation_prior_test {

using lens_support::LensMap;

constexpr int kWidth = 640, kHeight = 480;
constexpr double kWaves = 30;  // radians of phase a radian: some 100 px

Pinhole<double> camera() { return {500, 500, 319.5, 239.5}; }

// What a camera sees of a pattern infinitely far away.
Frame frame_of(const Eigen::Matrix3d& R_c_w, unsigned seed, const CameraView& view = camera()) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vec3> waves;
  std::vector<double> phases;
  for (int i = 0; i < 12; ++i) {
    waves.emplace_back(kWaves * normal(random), kWaves * normal(random), kWaves * normal(random));
    phases.push_back(10 * normal(random));
  }
  Image<std::uint8_t> image(kWidth, kHeight, 0);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (!has_ray(view, Vec2(x, y))) continue;
      const Vec3 ray = (R_c_w.transpose() * ray_of(view, Vec2(x, y))).normalized();
      double grey = 128;
      for (std::size_t i = 0; i < waves.size(); ++i) grey += 12 * std::sin(waves[i].dot(ray) + phases[i]);
      image(x, y) = static_cast<std::uint8_t>(std::min(255.0, std::max(0.0, grey)));
    }
  Frame frame;
  frame.image = std::make_shared<const Pyramid>(image.view(), Parameters().pyramid_levels);
  return frame;
}

// 60 px sideways and 5 degrees of roll: what walking at five frames a second brings.
TEST(FindRotation, FindsWhatTheDescentAloneDoesNot) {
  const Parameters parameters;
  int missed = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const double way = seed % 2 == 0 ? 1 : -1;
    const Eigen::Matrix3d R = textplane::so3_exp<double>(Vec3(0.03, way * 0.12, way * 0.087));
    const Frame a = frame_of(Eigen::Matrix3d::Identity(), seed), b = frame_of(R, seed);
    const RotationPrior near = align_rotation(a, b, camera(), Eigen::Matrix3d::Identity(), parameters);
    missed += near.zncc < parameters.rotation_clear_zncc ? 1 : 0;
    const RotationPrior found = find_rotation(a, b, camera(), Eigen::Matrix3d::Identity(), parameters);
    EXPECT_GT(found.zncc, 0.95);
    EXPECT_LT(degrees(found.R_b_a.transpose() * R), 0.2);
  }
  EXPECT_GT(missed, 0);
}

// A fisheye's image turns as a whole, though none of its lines stays straight, and has no ray in its corners.
TEST(FindRotation, FindsItBehindALens) {
  const Parameters parameters;
  const LensMap* const lenses[] = {&lens_support::wide_lens(), &lens_support::fisheye()};
  for (const LensMap* lens : lenses) {
    const CameraView view({lens == lenses[0] ? 500.0 : 230.0, lens == lenses[0] ? 500.0 : 230.0, 319.5, 239.5}, lens);
    ASSERT_EQ(has_ray(view, {0, 0}), lens == lenses[0]);
    for (unsigned seed = 1; seed <= 2; ++seed) {
      SCOPED_TRACE(seed);
      const Eigen::Matrix3d R = textplane::so3_exp<double>(Vec3(0.03, 0.12, 0.087));
      const Frame a = frame_of(Eigen::Matrix3d::Identity(), seed, view), b = frame_of(R, seed, view);
      const RotationPrior found = find_rotation(a, b, view, Eigen::Matrix3d::Identity(), parameters);
      EXPECT_GT(found.zncc, 0.93);
      EXPECT_LT(degrees(found.R_b_a.transpose() * R), 0.2);
      const RotationPrior straight = find_rotation(a, b, view.pinhole, Eigen::Matrix3d::Identity(), parameters);
      EXPECT_LT(straight.zncc, found.zncc - 0.01);
    }
  }
}

TEST(FindRotation, SaysWhereNothingAgrees) {
  const Frame a = frame_of(Eigen::Matrix3d::Identity(), 1), b = frame_of(Eigen::Matrix3d::Identity(), 9);
  const Parameters parameters;
  EXPECT_LT(find_rotation(a, b, camera(), Eigen::Matrix3d::Identity(), parameters).zncc,
            parameters.rotation_clear_zncc);
}

}  // namespace rotation_prior_test
}  // namespace textslam
