// Pieces of the classical detector: ink, letters, quads.
#include "detectors/text_letters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "detectors/classical_detector.hpp"

namespace textslam {
namespace text_letters_test {

using Point = Vector2<double>;

TEST(TextInk, AgreesWithTheWindowsMeanAndDeviation) {
  Image<std::uint8_t> image(41, 29), marks;
  std::uint32_t state = 12345;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      image(x, y) = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
  const ClassicalParameters parameters;
  InkScratch scratch;
  mark_ink(image.view(), parameters, scratch, marks);
  const int r = parameters.window_radius;
  int marked = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      double n = 0, sum = 0, squares = 0;
      for (int v = std::max(0, y - r); v <= std::min(image.height() - 1, y + r); ++v)
        for (int u = std::max(0, x - r); u <= std::min(image.width() - 1, x + r); ++u) {
          n += 1;
          sum += image(u, v);
          squares += image(u, v) * image(u, v);
        }
      const double difference = image(x, y) - sum / n, deviation = std::sqrt(squares / n - sum * sum / (n * n));
      const double threshold = std::max(parameters.ink_sigmas * deviation, parameters.ink_floor);
      if (std::abs(std::abs(difference) - threshold) < 1e-2) continue;  // rounding decides
      const int expected = std::abs(difference) < threshold ? kPaper : difference < 0 ? kDarkInk : kLightInk;
      EXPECT_EQ(marks(x, y), expected) << x << ' ' << y;
      marked += expected != kPaper;
    }
  EXPECT_GT(marked, 100);
}

TEST(TextLetters, MeasuresARing) {
  Image<std::uint8_t> image(60, 50, 200), marks(60, 50, kPaper);
  for (int y = 10; y < 40; ++y)
    for (int x = 20; x < 40; ++x)
      if (x < 24 || x >= 36 || y < 14 || y >= 36) {
        image(x, y) = 50;
        marks(x, y) = kDarkInk;
      }
  LetterScratch scratch;
  std::vector<Letter> letters;
  find_letters(image.view(), marks, {}, scratch, letters);
  ASSERT_EQ(letters.size(), 1u);
  const Letter& ring = letters[0];
  EXPECT_EQ(ring.area, 30 * 20 - 22 * 12);
  EXPECT_EQ(ring.centre, Point(29.5, 24.5));
  EXPECT_EQ(ring.size, 30);
  EXPECT_NEAR(ring.stroke, 4.0, 0.5);
  EXPECT_EQ(ring.ink, 50);
  EXPECT_EQ(ring.paper, 200);
  EXPECT_FALSE(ring.light);
  const Extent across = extent(ring, {1, 0}), down = extent(ring, {0, 1});
  EXPECT_EQ(across.low, 19.5);
  EXPECT_EQ(across.high, 39.5);
  EXPECT_EQ(down.low, 9.5);
  EXPECT_EQ(down.high, 39.5);
}

TEST(TextLetters, OutlineIsTheConvexHull) {
  // An X: both sides recede, so that the chains of the hull must drop points.
  Image<std::uint8_t> image(40, 40, 200), marks(40, 40, kPaper);
  for (int i = 0; i < 21; ++i)
    for (int w = 0; w < 4; ++w)
      for (const int x : {8 + i + w, 28 - i + w}) {
        image(x, 9 + i) = 50;
        marks(x, 9 + i) = kDarkInk;
      }
  LetterScratch scratch;
  std::vector<Letter> letters;
  find_letters(image.view(), marks, {}, scratch, letters);
  ASSERT_EQ(letters.size(), 1u);
  for (int k = 0; k < 16; ++k) {
    const Point direction(std::cos(0.3927 * k), std::sin(0.3927 * k));
    Extent expected{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x)
        for (int c = 0; c < 4 && marks(x, y) != kPaper; ++c) {
          const double s = Point(x + (c % 2) - 0.5, y + (c / 2) - 0.5).dot(direction);
          expected = {std::min(expected.low, s), std::max(expected.high, s)};
        }
    EXPECT_NEAR(extent(letters[0], direction).low, expected.low, 1e-12);
    EXPECT_NEAR(extent(letters[0], direction).high, expected.high, 1e-12);
  }
}

TEST(TextQuads, TheBetterOfTwoThatOverlapStays) {
  const auto box = [](double x, double score) {
    TextQuad q;
    q.quad.corner = {Point(x, 0), Point(x + 40, 0), Point(x + 40, 10), Point(x, 10)};
    q.score = score;
    return q;
  };
  std::vector<TextQuad> quads{box(0, 0.5), box(10, 0.8), box(60, 0.6), box(95, 0.4)};
  suppress_overlaps(quads, {});
  ASSERT_EQ(quads.size(), 3u);  // the last shares an eighth with its neighbour, which is allowed
  EXPECT_EQ(quads[0].score, 0.8);
  EXPECT_EQ(quads[1].score, 0.6);
  EXPECT_EQ(quads[2].score, 0.4);
}

}  // namespace text_letters_test
}  // namespace textslam
