// Every option has a domain, and outside of it there is a status: no endless loop, no overflow, no value without
// meaning. At the ends of the domain the functions work.
#include <gtest/gtest.h>

#include <limits>
#include <utility>
#include <vector>

#include "features/synthetic.hpp"
#include "textplane/features/klt.hpp"
#include "textplane/features/select.hpp"

namespace options_test {

using namespace textplane;
using namespace textplane_test;

constexpr int kMost = std::numeric_limits<int>::max(), kLeast = std::numeric_limits<int>::min();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

Image<std::uint8_t> textured() { return TexturedPlane(3).render(Matrix3d::Identity(), 160, 120, {}, 1); }

Quad<double> quad() {
  Quad<double> quad;
  quad.corner = {Vector2d(20, 20), Vector2d(140, 20), Vector2d(140, 100), Vector2d(20, 100)};
  return quad;
}

const Pinhole<double> kCamera(150, 150, 80, 60);

TEST(SelectOptions, OutsideTheirDomainsAreInvalid) {
  const Image<std::uint8_t> image = textured();
  const auto refused = [&image](const char* what, const SelectOptions& options) {
    std::vector<Vector2f> pixels;
    EXPECT_FALSE(options.valid()) << what;
    EXPECT_EQ(select_pixels(image.view(), quad(), options, pixels), Status::invalid_argument) << what;
    EXPECT_EQ(make_patch(image.view(), kCamera, quad(), options).status, Status::invalid_argument) << what;
  };
  const std::pair<int SelectOptions::*, std::vector<int>> integers[] = {
      {&SelectOptions::min_pixels, {-1, kLeast}},
      {&SelectOptions::max_pixels, {0, -1, kLeast}},
      {&SelectOptions::levels, {0, -1, kLeast}},
      {&SelectOptions::fast_threshold, {-1, 256, kMost, kLeast}},
      {&SelectOptions::lowest_fast_threshold, {-1, 256, kMost, kLeast}}};
  for (const auto& [member, values] : integers)
    for (const int value : values) {
      SelectOptions options;
      options.*member = value;
      refused(std::to_string(value).c_str(), options);
    }
  for (const float value : {-1.0F, kNan, kInfinity, -kInfinity}) {
    SelectOptions options;
    options.min_gradient = value;
    refused("min_gradient", options);
  }
}

TEST(SelectOptions, WorkAtTheEndsOfTheirDomains) {
  const Image<std::uint8_t> image = textured();
  std::vector<Vector2f> pixels;
  SelectOptions options;
  options.max_pixels = kMost;  // every corner, and every other pixel of some gradient
  options.levels = kMost;
  options.lowest_fast_threshold = options.min_pixels = 0;
  options.min_gradient = 0;
  ASSERT_EQ(select_pixels(image.view(), quad(), options, pixels), Status::ok);
  EXPECT_GT(pixels.size(), 121U * 81U / 2);
  EXPECT_EQ(make_patch(image.view(), kCamera, quad(), options).level_count(), 7);  // the next one would be empty
  options.min_pixels = kMost;
  EXPECT_EQ(select_pixels(image.view(), quad(), options, pixels), Status::too_few);
  options = SelectOptions();
  options.min_gradient = std::numeric_limits<float>::max();
  options.fast_threshold = options.lowest_fast_threshold = 255;
  EXPECT_EQ(select_pixels(image.view(), quad(), options, pixels), Status::too_few);
  EXPECT_TRUE(pixels.empty());
}

// 0 * 3 / 4 is not below 0, whatever the lowest threshold is.
TEST(KeepEnough, EndsWhereTheThresholdIsNotLowered) {
  for (const int lowest : {-1, kLeast}) {
    std::vector<Corner> corners = {{1, 1, 3}, {2, 2, 9}};
    keep_enough(&corners, 20, lowest, 10, [](int t) { return t * 3 / 4; });
    EXPECT_EQ(corners.size(), 2U);
  }
  std::vector<Corner> corners = {{1, 1, 3}, {2, 2, 9}};
  keep_enough(&corners, 20, 5, 10, [](int t) { return t + 1; });
  ASSERT_EQ(corners.size(), 1U);
  EXPECT_EQ(corners[0].score, 9);
}

TEST(SelectSpread, ACellMayBeLargerThanAnyImage) {
  const std::vector<Corner> corners = {{5, 5, 10}, {29, 19, 30}, {15, 5, 20}};
  std::vector<Corner> out;
  for (const int cell : {30, 31, kMost - 1, kMost}) {
    select_spread(corners, 30, 20, cell, kMost, {}, out);
    ASSERT_EQ(out.size(), 1U) << cell;
    EXPECT_EQ(out[0].score, 30) << cell;
  }
}

// A width that is no multiple of the cell: the last column of cells, and row, is narrower.
TEST(SelectSpread, TheLastCellsEndWithTheImage) {
  const std::vector<Corner> corners = {{31, 5, 10}, {5, 21, 20}, {31, 21, 30}, {32, 5, 99}, {31, 23, 99}};
  std::vector<Corner> out;
  select_spread(corners, 32, 23, 10, 9, {}, out);  // (32, 5) and (31, 23) are outside, but inside a whole cell
  ASSERT_EQ(out.size(), 3U);
  EXPECT_EQ(out[0].score, 30);
  EXPECT_EQ(out[1].score, 20);
  EXPECT_EQ(out[2].score, 10);
  select_spread(corners, 32, 23, 10, 9, {Vector2f(32.5F, 5), Vector2f(5, 23)}, out);
  EXPECT_EQ(out.size(), 3U);
  select_spread(corners, 32, 23, 10, 9, {Vector2f(30.5F, 5), Vector2f(5, 22.5F)}, out);
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(out[0].score, 30);
}

TEST(KltOptions, OutsideTheirDomainsAreInvalid) {
  const Image<std::uint8_t> image = textured();
  const Pyramid pyramid(image.view(), 3);
  const Vector2f at(80, 60);
  PointPatch patch;
  patch.left = patch.top = 9;
  patch.columns = patch.rows = 19;
  ASSERT_EQ(detail::extract_upright_patch(image.view(), at[0], at[1], &patch), Status::ok);
  const auto refused = [&](const KltOptions& options, bool one_level) {
    KltResult result;
    track_klt(pyramid.view(), pyramid.view(), &at, nullptr, 1, options, &result);
    EXPECT_EQ(result.status, Status::invalid_argument);
    EXPECT_EQ(result.px, at);
    if (one_level) {
      EXPECT_EQ(align_point_patch(patch, image.view(), at, options).status, Status::invalid_argument);
    }
  };
  for (const auto& [member, values] : std::vector<std::pair<int KltOptions::*, std::vector<int>>>{
           {&KltOptions::radius, {0, kMaxPatchRadius + 1, kMost, kLeast}},
           {&KltOptions::levels, {0, kLeast}},
           {&KltOptions::max_iterations, {0, 10001, kMost, kLeast}}})
    for (const int value : values) {
      KltOptions options;
      options.*member = value;
      refused(options, member == &KltOptions::max_iterations);
    }
  for (float KltOptions::*member : {&KltOptions::epsilon, &KltOptions::min_contrast, &KltOptions::min_eigenvalue,
                                    &KltOptions::min_zncc, &KltOptions::max_forward_backward})
    for (const float value : {kNan, kInfinity}) {
      KltOptions options;
      options.*member = value;
      refused(options, member != &KltOptions::max_forward_backward);
    }
  KltOptions options;
  options.min_contrast = -5;
  refused(options, true);
  options = {};
  options.epsilon = 0;
  refused(options, true);
  options = {};
  options.levels = kMost;
  options.max_iterations = 10000;
  KltResult result;
  track_klt(pyramid.view(), pyramid.view(), &at, nullptr, 1, options, &result);
  EXPECT_EQ(result.status, Status::converged);
}

}  // namespace options_test
