#include "planar/plane_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace plane_tracker_test {
namespace tp = textplane;
using planar::PlaneState;
using planar::PlaneTracker;
using planar::PlaneTrackerOptions;
using Picture = tp::Image<std::uint8_t>;

constexpr int kWidth = 320, kHeight = 200;
const tp::Quad<double> kQuad{{tp::Vector2<double>(100, 80), {220, 80}, {220, 120}, {100, 120}}};

Picture filtered(const Picture& from, double variance) {
  Picture out(kWidth, kHeight);
  tp::BlurFilter()(from.view(), tp::BlurKernel(variance * tp::Matrix2d::Identity()), 0, 0, kWidth, kHeight, out.view());
  return out;
}

// Bars and dots of dark ink at random on light ground.
Picture print(unsigned seed) {
  std::mt19937 random(seed);
  Picture out(kWidth, kHeight, 190);
  for (int y = 0; y + 8 < kHeight; y += 10)
    for (int x = 0; x + 8 < kWidth; x += 8)
      for (int k = 0; k < 3; ++k) {
        const int u = x + static_cast<int>(random() % 6), v = y + static_cast<int>(random() % 6);
        const bool across = random() % 2 == 0;
        for (int i = 0; i < 5; ++i) out(std::min(u + (across ? i : 0), kWidth - 1), v + (across ? 0 : i)) = 70;
      }
  return filtered(out, 0.5);
}

// Mean distance of the corners from where they are, after an alignment from (dx, dy) px away.
double error_from(const Picture& first, const Picture& image, double dx, double dy,
                  const PlaneTrackerOptions& options) {
  PlaneTracker tracker(first.view(), kQuad, options);
  const tp::Pyramid pyramid(image.view(), options.select.levels);
  PlaneState state;
  state.T_t_h.t = {dx / tracker.camera().fx, dy / tracker.camera().fy, 0};
  if (!tp::is_ok(tracker.align(pyramid.view(), state))) return 1e3;
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += (tracker.quad(state).corner[i] - kQuad.corner[i]).norm() / 4;
  return sum;
}

// A shadow over a part, darker to one side, and a bright spot.
Picture relit(const Picture& from) {
  Picture out(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double light = (x + y < 250 ? 0.25 : 1.0) * (0.4 + 0.002 * x);
      const double spot = 120 * std::exp(-((x - 190.0) * (x - 190.0) + (y - 95.0) * (y - 95.0)) / 200);
      out(x, y) = static_cast<std::uint8_t>(std::min(light * from(x, y) + spot, 255.0));
    }
  return out;
}

TEST(PlaneTracker, ShadowsAndHighlightsDoNotMoveIt) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Picture first = print(seed), image = relit(first);
    EXPECT_LT(error_from(first, image, 3, 2, {}), 0.3) << seed;
    EXPECT_LT(error_from(first, image, -2, 3, {}), 0.3) << seed;
  }
}

TEST(PlaneTracker, ABlurredImageIsComparedWithABlurredObject) {
  PlaneTrackerOptions sharp;
  sharp.appearance.blur = {0};
  double with = 0, without = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Picture first = print(seed), image = filtered(filtered(first, 9), 5);
    const double error = error_from(first, image, 3, 2, {});
    EXPECT_LT(error, 0.5) << seed;
    with += error;
    without += error_from(first, image, 3, 2, sharp);
  }
  EXPECT_LT(with, 0.5 * without);
}

// Stripes 8 px apart under the print: on the coarsest levels they are grey, or their neighbours.
TEST(PlaneTracker, WhatRepeatsIsTriedAgainOnAFinerLevel) {
  PlaneTrackerOptions once;
  once.sure = -1;
  int good = 0, good_once = 0, all = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Picture first = print(seed);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        first(x, y) = static_cast<std::uint8_t>(0.6 * first(x, y) + (y / 4 % 2 == 0 ? 80 : 20));
    for (const double dy : {-3.0, -2.0, 2.0, 3.0}) {
      good += error_from(first, relit(first), 1, dy, {}) < 0.5;
      good_once += error_from(first, relit(first), 1, dy, once) < 0.5;
      ++all;
    }
  }
  EXPECT_EQ(good, all);
  EXPECT_LT(good_once, all);
}
}  // namespace plane_tracker_test
