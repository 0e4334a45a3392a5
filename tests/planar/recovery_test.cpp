// PlaneTracker where a plane jumps, is covered, and comes back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "planar/plane_tracker.hpp"
#include "textplane/photometry/warp_patch.hpp"

namespace recovery_test {
namespace tp = textplane;
using planar::Confidence;
using planar::PlaneTracker;
using Picture = tp::Image<std::uint8_t>;

constexpr int kWidth = 480, kHeight = 320;
const tp::Quad<double> kQuad{{tp::Vector2<double>(150, 110), {330, 110}, {330, 200}, {150, 200}}};

// Bars of ink at random, 16 x `stroke` px.
Picture print(unsigned seed, int stroke = 5) {
  std::mt19937 random(seed);
  Picture sharp(kWidth, kHeight, 190), out(kWidth, kHeight);
  for (int y = 0; y + 32 < kHeight; y += 24)
    for (int x = 0; x + 32 < kWidth; x += 20)
      for (int k = 0; k < 2; ++k) {
        const int u = x + static_cast<int>(random() % 12), v = y + static_cast<int>(random() % 12);
        const bool across = random() % 2 == 0;
        for (int i = 0; i < 16 * stroke; ++i)
          sharp(u + (across ? i % 16 : i / 16), v + (across ? i / 16 : i % 16)) = 70;
      }
  tp::BlurFilter()(sharp.view(), tp::BlurKernel(0.5 * tp::Matrix2d::Identity()), 0, 0, kWidth, kHeight, out.view());
  return out;
}

// Where a point of the first image is after the plane turned and grew about its centre and moved.
struct Motion {
  double x = 0, y = 0, turn = 0, zoom = 1;

  tp::Matrix3<double> matrix() const {
    const double c = zoom * std::cos(turn), s = zoom * std::sin(turn), u = 240, v = 155;
    tp::Matrix3<double> H;
    H << c, -s, u + x - c * u + s * v, s, c, v + y - s * u - c * v, 0, 0, 1;
    return H;
  }
};

// The plane of `first` alone, moved, on the ground of another print.
Picture seen(const Picture& first, const Picture& ground, const Motion& motion) {
  Picture out(kWidth, kHeight);
  std::copy_n(ground.data(), kWidth * kHeight, out.data());
  const tp::Matrix3<double> back = motion.matrix().inverse();
  Picture moved(kWidth, kHeight);
  tp::warp_patch(tp::ImageView8(first.view()), back, moved.view());
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const tp::Vector3<double> p = back * tp::Vector3<double>(x, y, 1);
      if (tp::contains(kQuad, tp::Vector2<double>(p[0], p[1]))) out(x, y) = moved(x, y);
    }
  return out;
}

double error(const PlaneTracker& tracker, const Motion& motion) {
  tp::Quad<double> truth = kQuad;
  tp::transform(kQuad, motion.matrix(), &truth);
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += (tracker.quad().corner[i] - truth.corner[i]).norm() / 4;
  return sum;
}

TEST(PlaneTracker, AFastFrameIsHeld) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Picture first = print(seed), ground = print(seed + 50);
    for (const Motion& motion : {Motion{36, 0, 0.087, 1}, Motion{-20, -30, -0.087, 1}, Motion{40, 40, 0.2, 1.15}}) {
      PlaneTracker tracker(seen(first, ground, {}).view(), kQuad);
      EXPECT_TRUE(tp::is_ok(tracker.track(seen(first, ground, motion).view()))) << seed;
      EXPECT_EQ(tracker.confidence(), Confidence::good);
      EXPECT_LT(error(tracker, motion), 0.5) << seed;
    }
  }
}

// Where the plane is found after it was covered for two frames.
void expect_found(unsigned seed, int stroke, const Motion& back) {
  const Picture first = print(seed, stroke), ground = print(seed + 50, stroke);
  PlaneTracker tracker(seen(first, ground, {}).view(), kQuad);
  ASSERT_TRUE(tp::is_ok(tracker.track(seen(first, ground, {2, 1, 0.01, 1}).view())));
  for (unsigned k = 0; k < 2; ++k) {
    EXPECT_FALSE(tp::is_ok(tracker.track(print(seed + 100 + k, stroke).view()))) << seed;
    EXPECT_NE(tracker.confidence(), Confidence::good) << seed;
  }
  EXPECT_TRUE(tp::is_ok(tracker.track(seen(first, ground, back).view()))) << seed << " " << back.x;
  EXPECT_EQ(tracker.confidence(), Confidence::good) << seed << " " << back.x;
  EXPECT_LT(error(tracker, back), 0.5) << seed << " " << back.x;
}

// The search once turned the plane by steps of 0.2 rad whatever its size, and missed what lay between two of them.
TEST(PlaneTracker, ACoveredPlaneIsNotFoundAndThenFoundElsewhere) {
  for (unsigned seed = 1; seed <= 4; ++seed)
    for (const Motion& back : {Motion{-60, 45, 0.2, 1}, Motion{-90, 70, 0.35, 1.1}, Motion{60, 60, -0.1, 0.8}})
      expect_found(seed, 5, back);
}

TEST(PlaneTracker, FinePrintIsFoundElsewhere) {
  for (unsigned seed = 1; seed <= 4; ++seed) expect_found(seed, 3, {-90, 70, 0.35, 1.1});
}

// A third of it is: the rest tells where it is.
TEST(PlaneTracker, APlaneCoveredInPartIsHeld) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Picture first = print(seed), ground = print(seed + 50), cover = print(seed + 80);
    PlaneTracker tracker(seen(first, ground, {}).view(), kQuad);
    const Motion motion{3, -2, 0.02, 1};
    Picture image = seen(first, ground, motion);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < 205; ++x) image(x, y) = cover(x, y);
    EXPECT_TRUE(tp::is_ok(tracker.track(image.view()))) << seed;
    EXPECT_LT(error(tracker, motion), 0.5) << seed;
  }
}

TEST(PlaneTracker, WhatIsLostKeepsItsLastPose) {
  const Picture first = print(1), ground = print(51);
  PlaneTracker tracker(seen(first, ground, {}).view(), kQuad);
  const Motion motion{4, 3, 0.02, 1};
  ASSERT_TRUE(tp::is_ok(tracker.track(seen(first, ground, motion).view())));
  const Picture grey(kWidth, kHeight, 128);
  EXPECT_FALSE(tp::is_ok(tracker.track(grey.view())));
  EXPECT_EQ(tracker.confidence(), Confidence::lost);
  EXPECT_LT(error(tracker, motion), 0.5);
}
}  // namespace recovery_test
