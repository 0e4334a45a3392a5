// The readout by turns against synthetic cameras whose shutter is known.
#include "textslam/calibrate/turn_readout.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace textslam {
namespace turn_readout_test {

// A camera that shakes as a hand does, and walks, before points at 1 to 6 m.
struct Walk {
  double readout = 0;        // s
  double turning = 1;        // amplitude of the turns, times .3 radians
  double walking = 0.4;      // m/s
  double noise = 0.3 / 525;  // radians
  double strays = 0;         // share of the corners that move by themselves
  int frames = 120, corners = 150;
};

SE3d pose_at(const Walk& walk, double t) {
  const Vec3 angles(0.3 * std::sin(4.1 * t), 0.3 * std::sin(3.3 * t + 1), 0.2 * std::sin(5.2 * t + 2));
  SE3d T_c_w;
  T_c_w.R = textplane::so3_exp<double>(Vec3(walk.turning * angles));
  T_c_w.t = -(T_c_w.R * Vec3(walk.walking * t, 0.1 * std::sin(2 * t), 0.5 * walk.walking * t));
  return T_c_w;
}

// The ray at which the point is seen, and the row: that of the time at which it is.
bool see(const Walk& walk, double t, const Vec3& p_w, Vec3* ray, double* row) {
  constexpr double kFocal = 525.0 / 480;  // in heights of the image
  *row = 0;
  Vec3 p;
  for (int i = 0; i < 20; ++i) {
    p = pose_at(walk, t + walk.readout * *row) * p_w;
    if (p.z() < 0.1) return false;
    *row = kFocal * p.y() / p.z();
  }
  *ray = p.normalized();
  return std::abs(*row) <= 0.5 && std::abs(kFocal * p.x() / p.z()) <= 0.67;
}

std::vector<FramePair> pairs_of(const Walk& walk) {
  constexpr double kPeriod = 1.0 / 30;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, walk.noise);
  std::uniform_real_distribution<double> share(0, 1);
  const auto noisy = [&](const Vec3& ray) {
    return Vec3((ray + Vec3(noise(random), noise(random), noise(random))).normalized());
  };
  std::vector<FramePair> pairs;
  for (int k = 0; k + 1 < walk.frames; ++k) {
    const double t = k * kPeriod;
    const SE3d T_w_c = pose_at(walk, t).inverse();
    pairs.push_back({kPeriod, {}});
    while (static_cast<int>(pairs.back().rays.size()) < walk.corners) {
      const Vec3 in_c(1.3 * share(random) - 0.65, share(random) - 0.5, 1);
      const Vec3 p_w = T_w_c * (in_c * (1 + 5 * share(random)));
      RayPair rays;
      if (!see(walk, t, p_w, &rays.ray_a, &rays.row_a) || !see(walk, t + kPeriod, p_w, &rays.ray_b, &rays.row_b))
        continue;
      rays.ray_a = noisy(rays.ray_a);
      rays.ray_b = noisy(rays.ray_b);
      if (share(random) < walk.strays) rays.ray_b = noisy(rays.ray_b + Vec3(0.05 * share(random), 0.02, 0));
      pairs.back().rays.push_back(rays);
    }
  }
  return pairs;
}

// A little short, by the noise of the turns.
TEST(TurnReadoutTest, IsTold) {
  for (const double readout : {0.01, 0.03, -0.02}) {
    SCOPED_TRACE(readout);
    Walk walk;
    walk.readout = readout;
    const TurnReadout told = readout_of_turns(pairs_of(walk));
    EXPECT_TRUE(told.determined);
    EXPECT_NEAR(told.readout, readout, 0.1 * std::abs(readout) + 4 * told.sigma);
    EXPECT_GT(told.sigma, 0);
    EXPECT_LT(told.sigma, 0.1 * std::abs(readout));
  }
}

TEST(TurnReadoutTest, TellsWhatItDoesToTheImages) {
  Walk walk;
  walk.readout = 0.03;
  const TurnReadout told = readout_of_turns(pairs_of(walk));
  double turn = 0;
  for (int k = 0; k + 1 < walk.frames; ++k) {
    const Eigen::Matrix3d R = pose_at(walk, (k + 1) / 30.0).R * pose_at(walk, k / 30.0).R.transpose();
    turn += textplane::so3_log<double>(R).squaredNorm() / (walk.frames - 1);
  }
  turn = std::sqrt(turn);
  EXPECT_NEAR(told.turn, turn, 0.02 * turn);
  double rows = 0;
  constexpr int kRows = 480;
  for (int row = 0; row < kRows; ++row) rows += std::pow((row + 0.5) / kRows - 0.5, 2) / kRows;
  EXPECT_NEAR(told.shear, told.readout * told.turn * 30 * std::sqrt(rows), 1e-6);
  walk.readout = -0.03;
  EXPECT_GT(readout_of_turns(pairs_of(walk)).shear, 0);
}

TEST(TurnReadoutTest, WhatMovesByItselfCountsForNothing) {
  Walk walk;
  walk.readout = 0.03;
  walk.strays = 0.2;
  const TurnReadout told = readout_of_turns(pairs_of(walk));
  EXPECT_TRUE(told.determined);
  EXPECT_NEAR(told.readout, 0.03, 0.005);
}

TEST(TurnReadoutTest, OfAllRowsAtOnceIsNone) {
  for (const double walking : {0.0, 0.4, 2.0}) {
    SCOPED_TRACE(walking);
    Walk walk;
    walk.walking = walking;
    const TurnReadout told = readout_of_turns(pairs_of(walk));
    EXPECT_FALSE(told.determined);
    EXPECT_LT(std::abs(told.readout), std::max(4 * told.sigma, 2e-3));
  }
}

// Without turns nothing tells a shutter, and the error says so.
TEST(TurnReadoutTest, OfACameraThatDoesNotTurnIsNotTold) {
  Walk walk;
  walk.readout = 0.03;
  walk.turning = 0;
  EXPECT_FALSE(readout_of_turns(pairs_of(walk)).determined);
}

TEST(TurnReadoutTest, OfTooLittleIsNotTold) {
  Walk walk;
  walk.readout = 0.03;
  walk.frames = 32;  // of 31 pairs 29 have neighbours
  EXPECT_FALSE(readout_of_turns(pairs_of(walk)).determined);
  walk.frames = 120;
  walk.corners = 29;
  EXPECT_FALSE(readout_of_turns(pairs_of(walk)).determined);
  EXPECT_FALSE(readout_of_turns({}).determined);
  EXPECT_FALSE(readout_of_turns(std::vector<FramePair>(50)).determined);
}

TEST(TurnReadoutTest, NoNumberIsAnError) {
  Walk walk;
  walk.readout = 0.03;
  std::vector<FramePair> pairs = pairs_of(walk);
  pairs[40].rays[7].ray_b.x() = std::nan("");
  pairs[60].seconds = std::nan("");
  const TurnReadout told = readout_of_turns(pairs);
  EXPECT_TRUE(std::isfinite(told.readout));
  EXPECT_NEAR(told.readout, 0.03, 0.005);
}

}  // namespace turn_readout_test
}  // namespace textslam
