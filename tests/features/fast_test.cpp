#include "textplane/features/fast.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "features/synthetic.hpp"

namespace fast_test {

using namespace textplane;
using namespace textplane_test;

// The definition, read out: 9 consecutive pixels of the circle all brighter or all darker.
bool corner_by_definition(const Image<std::uint8_t>& image, int x, int y, int threshold) {
  constexpr int dx[16] = {0, 1, 2, 3, 3, 3, 2, 1, 0, -1, -2, -3, -3, -3, -2, -1};
  constexpr int dy[16] = {-3, -3, -2, -1, 0, 1, 2, 3, 3, 3, 2, 1, 0, -1, -2, -3};
  for (int start = 0; start < 16; ++start) {
    bool brighter = true, darker = true;
    for (int k = 0; k < 9; ++k) {
      const int i = (start + k) % 16, v = image(x + dx[i], y + dy[i]);
      brighter = brighter && v > image(x, y) + threshold;
      darker = darker && v < image(x, y) - threshold;
    }
    if (brighter || darker) return true;
  }
  return false;
}

int score_by_definition(const Image<std::uint8_t>& image, int x, int y) {
  int score = -1;
  while (score < 255 && corner_by_definition(image, x, y, score + 1)) ++score;
  return score;
}

Image<std::uint8_t> random_image(std::uint32_t seed, int width, int height, int levels) {
  Random random(seed);
  Image<std::uint8_t> image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image(x, y) = static_cast<std::uint8_t>(random.integer(0, levels - 1) * 255 / (levels - 1));
  return image;
}

TEST(Fast, FollowsItsDefinition) {
  std::size_t total = 0;
  for (const int levels : {2, 3, 6}) {
    const Image<std::uint8_t> image = random_image(static_cast<std::uint32_t>(levels), 61, 47, levels);
    Image<int> score(61, 47, 0);
    for (int y = 3; y < 44; ++y)
      for (int x = 3; x < 58; ++x)
        if (corner_by_definition(image, x, y, 30)) score(x, y) = score_by_definition(image, x, y);
    std::vector<Corner> all, best, found;
    for (int y = 3; y < 44; ++y)
      for (int x = 3; x < 58; ++x) {
        if (score(x, y) == 0) continue;
        all.push_back({static_cast<float>(x), static_cast<float>(y), 0});
        bool largest = true;
        for (int j = -1; j <= 1; ++j)
          for (int i = -1; i <= 1; ++i) largest = largest && ((i == 0 && j == 0) || score(x, y) > score(x + i, y + j));
        if (largest) best.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(score(x, y))});
      }
    for (const bool suppress : {false, true}) {
      const std::vector<Corner>& expected = suppress ? best : all;
      ASSERT_EQ(detect_fast(image.view(), 30, suppress, found), Status::ok);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].x, expected[i].x);
        EXPECT_EQ(found[i].y, expected[i].y);
        EXPECT_EQ(found[i].score, expected[i].score);
      }
      total += found.size();
    }
  }
  EXPECT_GT(total, 100U);
}

TEST(Fast, CallerBuffersGiveTheSameCorners) {
  const Image<std::uint8_t> image = random_image(5, 80, 60, 4);
  std::vector<Corner> expected;
  ASSERT_EQ(detect_fast(image.view(), 20, true, expected), Status::ok);
  ASSERT_GT(expected.size(), 20U);
  std::vector<std::uint8_t> scratch(fast_scratch_size(80));
  const int n = static_cast<int>(expected.size());
  for (const int capacity : {0, 7, n, n + 10}) {
    std::vector<Corner> out(static_cast<std::size_t>(capacity) + 1, Corner{-1, -1, -1});
    int found = -1;
    ASSERT_EQ(detect_fast(image.view(), 20, true, scratch.data(), out.data(), capacity, &found), Status::ok);
    EXPECT_EQ(found, n);
    for (int i = 0; i < std::min(capacity, n); ++i) {
      const auto k = static_cast<std::size_t>(i);
      EXPECT_EQ(out[k].x, expected[k].x);
      EXPECT_EQ(out[k].y, expected[k].y);
      EXPECT_EQ(out[k].score, expected[k].score);
    }
    EXPECT_EQ(out[static_cast<std::size_t>(capacity)].x, -1) << "written past the capacity";
  }
}

TEST(Fast, ThresholdsAreClamped) {
  const Image<std::uint8_t> image = random_image(6, 40, 40, 50);
  std::vector<Corner> at_zero, below, above;
  detect_fast(image.view(), 0, false, at_zero);
  detect_fast(image.view(), -50, false, below);
  detect_fast(image.view(), 1000, false, above);
  EXPECT_GT(at_zero.size(), 0U);
  EXPECT_EQ(below.size(), at_zero.size());
  EXPECT_TRUE(above.empty());
}

TEST(Fast, InvalidInputIsAStatus) {
  std::vector<Corner> found{Corner{1, 1, 1}};
  EXPECT_EQ(detect_fast(ImageView8(), 20, true, found), Status::invalid_argument);
  EXPECT_TRUE(found.empty());
  const Image<std::uint8_t> image(20, 20);
  EXPECT_EQ(detect_fast(ImageView8(image.data(), 20, 20, 10), 20, true, found), Status::invalid_argument);
  int n = 5;
  Corner corner;
  EXPECT_EQ(detect_fast(image.view(), 20, true, nullptr, &corner, 1, &n), Status::invalid_argument);
  EXPECT_EQ(n, 0);
  EXPECT_EQ(detect_fast(image.view(), 20, false, nullptr, nullptr, 1, &n), Status::invalid_argument);
}

}  // namespace fast_test
