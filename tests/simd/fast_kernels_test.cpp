// FAST on every target: the strengths of the definition, the maxima of the definition, and not a byte beyond.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "support/guarded.hpp"
#include "support/targets.hpp"
#include "textplane/features/fast.hpp"

namespace fast_kernels_test {

using namespace textplane_test;
using textplane::Corner;
using textplane::ImageView8;

// Strokes of a few grey levels with noise on them: arcs of all lengths occur, and equal scores beside each other.
std::vector<std::uint8_t> picture(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&random](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width * height), static_cast<std::uint8_t>(draw(256)));
  for (int k = 0; k < 2 + width * height / 60; ++k) {
    const int x0 = draw(width), y0 = draw(height), w = 1 + draw(12), h = 1 + draw(9), level = draw(4) * 85;
    for (int y = y0; y < std::min(y0 + h, height); ++y)
      for (int x = x0; x < std::min(x0 + w, width); ++x)
        pixels[static_cast<std::size_t>(y * width + x)] = static_cast<std::uint8_t>(level);
  }
  if (seed % 3 != 0)
    for (std::uint8_t& p : pixels) p = static_cast<std::uint8_t>(std::min(std::max(p + draw(31) - 15, 0), 255));
  return pixels;
}

// The largest d for which 9 consecutive pixels of the circle are all >= I(p) + d or all <= I(p) - d.
int strength(const std::uint8_t* p, std::ptrdiff_t stride) {
  constexpr int dx[16] = {0, 1, 2, 3, 3, 3, 2, 1, 0, -1, -2, -3, -3, -3, -2, -1};
  constexpr int dy[16] = {3, 3, 2, 1, 0, -1, -2, -3, -3, -3, -2, -1, 0, 1, 2, 3};
  int best = 0;
  for (int first = 0; first < 16; ++first) {
    int brighter = 255, darker = 255;
    for (int k = first; k < first + 9; ++k) {
      const int d = p[dx[k % 16] + dy[k % 16] * stride] - *p;
      brighter = std::min(brighter, d);
      darker = std::min(darker, -d);
    }
    best = std::max({best, brighter, darker});
  }
  return best;
}

TEST(FastKernel, GivesTheStrengthsOfTheDefinition) {
  int corners = 0;
  for (int width = 7; width <= 150; width += width < 80 ? 1 : 7) {
    const int height = 7;
    const auto size = static_cast<std::size_t>(width * height), row = static_cast<std::size_t>(width);
    const Guarded<std::uint8_t> image(size), scores(row);  // a read or write beyond the rows would end the test
    const auto pixels = picture(width, height, static_cast<unsigned>(width));
    for (const bool low : {false, true}) {
      std::uint8_t* const data = low ? image.front() : image.data();
      std::uint8_t* const out = low ? scores.front() : scores.data();
      std::copy(pixels.begin(), pixels.end(), data);
      for (const int threshold : {0, 1, 20, 150, 254, 255})
        for (const int less : {0, 1}) {
          std::vector<std::uint8_t> expected(row, 9);  // the three at either end stay
          bool any = false;
          for (int x = 3; x < width - 3; ++x) {
            const int s = strength(data + 3 * width + x, width);
            expected[static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(s > threshold ? s - less : 0);
            any = any || expected[static_cast<std::size_t>(x)] != 0;
            corners += s > threshold ? 1 : 0;
          }
          for (const simd::Target target : testable_targets()) {
            const TargetScope scope(target);
            std::fill(out, out + width, std::uint8_t{9});
            ASSERT_EQ(simd::fast_row({data + 3 * width, width, width, threshold, less, out}), any);
            ASSERT_TRUE(std::equal(expected.begin(), expected.end(), out))
                << simd::to_string(target) << ", width " << width << ", threshold " << threshold;
          }
        }
    }
  }
  EXPECT_GT(corners, 1000);
}

TEST(FastKernel, FindsTheMaximaOfTheDefinition) {
  std::mt19937 random(5);
  int total = 0;
  for (int width = 7; width <= 150; ++width) {
    const std::size_t pitch = static_cast<std::size_t>(width + simd::kFastRowPadding);
    std::vector<std::uint8_t> rows(3 * pitch, 200);  // what lies behind a row is nobody's business
    for (std::size_t y = 0; y < 3; ++y)
      for (int x = 0; x < width; ++x) {
        const bool inside = x >= 3 && x < width - 3 && random() % 3 != 0;
        const auto s = width % 4 == 0 ? 252 + random() % 3 : random() % 40;  // the largest score there is: 254
        rows[y * pitch + static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(inside ? s : 0);
      }
    const std::uint8_t* const above = rows.data();
    const std::uint8_t* const row = above + pitch;
    const std::uint8_t* const below = row + pitch;
    for (const bool suppress : {false, true})
      for (const int first : {3, 3 + width / 3})
        for (const int last : {std::max(first, width - 3 - width / 5), width - 3}) {
          if (last < first) continue;
          std::vector<int> expected;
          for (int x = first; x < last; ++x) {
            bool most = row[x] != 0;
            for (int i = -1; most && suppress && i <= 1; ++i)
              most = row[x] > above[x + i] && row[x] > below[x + i] && (i == 0 || row[x] > row[x + i]);
            if (most) expected.push_back(x);
          }
          total += static_cast<int>(expected.size());
          for (const simd::Target target : testable_targets()) {
            const TargetScope scope(target);
            std::vector<int> found(static_cast<std::size_t>(last - first) + 1, -1);
            const int n = simd::fast_maxima({above, row, below, first, last, suppress, found.data()});
            ASSERT_EQ(found[static_cast<std::size_t>(last - first)], -1);
            found.resize(static_cast<std::size_t>(n));
            ASSERT_EQ(found, expected) << simd::to_string(target) << ", width " << width << ", from " << first;
          }
        }
  }
  EXPECT_GT(total, 1000);
}

// Through the detector: sizes around those of vectors and of the parts that rows are judged in, sub-images at odd
// addresses.
TEST(FastKernel, TheDetectorAgreesOnAllTargets) {
  std::size_t total = 0;
  for (const int width : {7, 8, 20, 39, 70, 133, 517, 518, 519, 1040}) {
    const int height = 23;
    const auto pixels = picture(width, height, static_cast<unsigned>(width) + 1);
    for (const int crop : {0, 1}) {
      if (width - crop < 7) continue;
      const ImageView8 image(pixels.data() + crop, width - crop, height, width);
      for (const int threshold : {-5, 0, 12, 60, 300})
        for (const bool suppress : {false, true}) {
          std::vector<Corner> expected, found;
          {
            const TargetScope scope(simd::Target::scalar);
            ASSERT_EQ(detect_fast(image, threshold, suppress, expected), textplane::Status::ok);
          }
          total += expected.size();
          for (const simd::Target target : testable_targets()) {
            const TargetScope scope(target);
            ASSERT_EQ(detect_fast(image, threshold, suppress, found), textplane::Status::ok);
            ASSERT_EQ(found.size(), expected.size()) << simd::to_string(target);
            for (std::size_t i = 0; i < found.size(); ++i) {
              ASSERT_EQ(found[i].x, expected[i].x);
              ASSERT_EQ(found[i].y, expected[i].y);
              ASSERT_EQ(found[i].score, expected[i].score);
            }
          }
        }
    }
  }
  EXPECT_GT(total, 1000U);
}

}  // namespace fast_kernels_test
