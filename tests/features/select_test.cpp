#include "textplane/features/select.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <utility>

#include "features/synthetic.hpp"

namespace select_test {

using namespace textplane;
using namespace textplane_test;

Quad<double> quad_of(double x0, double y0, double x1, double y1, double x2, double y2, double x3, double y3) {
  Quad<double> quad;
  quad.corner = {Vector2d(x0, y0), Vector2d(x1, y1), Vector2d(x2, y2), Vector2d(x3, y3)};
  return quad;
}

Image<std::uint8_t> textured() { return TexturedPlane(3).render(Matrix3d::Identity(), 320, 240, {}, 1); }

void expect_distinct_integers_inside(const std::vector<Vector2f>& pixels, const Quad<double>& quad, int width,
                                     int height) {
  std::set<std::pair<float, float>> seen;
  for (const Vector2f& p : pixels) {
    EXPECT_EQ(p[0], std::floor(p[0]));
    EXPECT_EQ(p[1], std::floor(p[1]));
    EXPECT_TRUE(contains(quad, Vector2d(p.cast<double>())));
    EXPECT_TRUE(p[0] >= 0 && p[1] >= 0 && p[0] <= static_cast<float>(width - 1) &&
                p[1] <= static_cast<float>(height - 1));
    EXPECT_TRUE(seen.insert({p[0], p[1]}).second) << "taken twice: " << p.transpose();
  }
}

TEST(SelectPixels, FillsATexturedQuadEvenly) {
  const Image<std::uint8_t> image = textured();
  const Quad<double> quad = quad_of(60.3, 40.2, 250.7, 60.9, 245.1, 160.4, 70.8, 150.6);
  std::vector<Vector2f> pixels;
  ASSERT_EQ(select_pixels(image.view(), quad, SelectOptions(), pixels), Status::ok);
  EXPECT_EQ(pixels.size(), 300U);
  expect_distinct_integers_inside(pixels, quad, 320, 240);
  const Vector2d centre = centroid(quad);
  int quarter[4] = {};
  for (const Vector2f& p : pixels)
    ++quarter[(static_cast<double>(p[0]) > centre[0] ? 1 : 0) + (static_cast<double>(p[1]) > centre[1] ? 2 : 0)];
  for (const int n : quarter) EXPECT_GT(n, 300 / 8);
}

TEST(SelectPixels, StrongestCornersOfEveryCellComeFirst) {
  const Image<std::uint8_t> image = textured();
  const Quad<double> quad = quad_of(20, 20, 300, 20, 300, 220, 20, 220);
  std::vector<Corner> corners;
  detect_fast(image.view(), 20, true, corners);
  const Corner* strongest = nullptr;
  for (const Corner& c : corners)
    if (contains(quad, Vector2d(c.x, c.y)) && (!strongest || c.score > strongest->score)) strongest = &c;
  ASSERT_NE(strongest, nullptr);
  SelectOptions options;
  options.max_pixels = 20;
  std::vector<Vector2f> pixels;
  ASSERT_EQ(select_pixels(image.view(), quad, options, pixels), Status::ok);
  ASSERT_EQ(pixels.size(), 20U);
  EXPECT_EQ(pixels[0], Vector2f(strongest->x, strongest->y));
}

TEST(SelectPixels, TopsUpWithGradientsWhereThereAreNoCorners) {
  Image<std::uint8_t> image(100, 100, 50);  // a straight edge: gradient but no corner
  for (int y = 0; y < 100; ++y)
    for (int x = 50; x < 100; ++x) image(x, y) = 200;
  std::vector<Vector2f> pixels;
  const Quad<double> quad = quad_of(10, 10, 90, 10, 90, 90, 10, 90);
  ASSERT_EQ(select_pixels(image.view(), quad, SelectOptions(), pixels), Status::ok);
  for (const Vector2f& p : pixels) EXPECT_TRUE(p[0] == 49 || p[0] == 50);
}

// The columns and rows at the borders of the image, whose neighbours on one side are the last, and of the quad.
TEST(SelectPixels, TakesTheBordersToo) {
  const Quad<double> round = quad_of(-50, -50, 150, -50, 150, 150, -50, 150),
                     inner = quad_of(20, 20, 70, 20, 70, 70, 20, 70);
  struct Case {
    const Quad<double>& quad;
    int edge, expected;  // a step between edge and edge + 1; the column or row that shows it
  };
  for (const Case& c : {Case{round, 98, 98}, Case{round, 0, 1}, Case{inner, 70, 70}, Case{inner, 19, 20}})
    for (const int axis : {0, 1}) {
      Image<std::uint8_t> image(100, 100, 50);
      for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x) image(x, y) = (axis == 0 ? x : y) > c.edge ? 200 : 50;
      std::vector<Vector2f> pixels;
      ASSERT_EQ(select_pixels(image.view(), c.quad, SelectOptions(), pixels), Status::ok) << c.edge << ' ' << axis;
      for (const Vector2f& p : pixels) EXPECT_EQ(p[axis], static_cast<float>(c.expected)) << c.edge << ' ' << axis;
    }
}

// A quad that is higher than the image is wide to its right, and the last row of it.
TEST(SelectPixels, TakesTheLastRowOfAHighQuad) {
  Image<std::uint8_t> image(60, 100, 50);
  for (int y = 81; y < 100; ++y)
    for (int x = 0; x < 60; ++x) image(x, y) = 200;
  std::vector<Vector2f> pixels;
  ASSERT_EQ(select_pixels(image.view(), quad_of(5, 20, 55, 20, 55, 80, 5, 80), SelectOptions(), pixels), Status::ok);
  for (const Vector2f& p : pixels) EXPECT_EQ(p[1], 80);
}

// The gradient of a step is half of its height, on both sides of it.
TEST(SelectPixels, TakesGradientsFromTheLeastOn) {
  const Quad<double> quad = quad_of(10, 10, 90, 10, 90, 90, 10, 90);
  SelectOptions options;
  options.lowest_fast_threshold = options.fast_threshold = 255;  // no corners
  std::vector<Vector2f> pixels;
  for (const int step : {9, 10, 11, 39, 40, 41}) {
    Image<std::uint8_t> image(100, 100, 50);
    for (int y = 0; y < 100; ++y)
      for (int x = 50; x < 100; ++x) image(x, y) = static_cast<std::uint8_t>(50 + step);
    for (const float least : {5.0F, 20.0F}) {
      options.min_gradient = least;
      EXPECT_EQ(select_pixels(image.view(), quad, options, pixels),
                0.5F * static_cast<float>(step) >= least ? Status::ok : Status::too_few)
          << step << ' ' << least;
    }
  }
}

// The paper takes no object of fewer than 15 pixels.
TEST(SelectPixels, FifteenPixelsAreEnough) {
  const Image<std::uint8_t> image = textured();
  const Quad<double> quad = quad_of(60, 40, 250, 60, 245, 160, 70, 150);
  SelectOptions options;
  std::vector<Vector2f> pixels;
  options.max_pixels = 15;
  EXPECT_EQ(select_pixels(image.view(), quad, options, pixels), Status::ok);
  options.max_pixels = 14;
  EXPECT_EQ(select_pixels(image.view(), quad, options, pixels), Status::too_few);
}

TEST(SelectPixels, HandlesQuadsAtAndBeyondTheBorder) {
  const Image<std::uint8_t> image = textured();
  std::vector<Vector2f> pixels;
  const Quad<double> partly = quad_of(-50, -30, 120, -30, 120, 90, -50, 90);
  ASSERT_EQ(select_pixels(image.view(), partly, SelectOptions(), pixels), Status::ok);
  expect_distinct_integers_inside(pixels, partly, 320, 240);
  const Quad<double> round = quad_of(-500, -500, 900, -500, 900, 900, -500, 900);
  ASSERT_EQ(select_pixels(image.view(), round, SelectOptions(), pixels), Status::ok);
  expect_distinct_integers_inside(pixels, round, 320, 240);
  EXPECT_EQ(select_pixels(image.view(), quad_of(400, 10, 500, 10, 500, 90, 400, 90), SelectOptions(), pixels),
            Status::too_few);
  EXPECT_TRUE(pixels.empty());
}

TEST(SelectPixels, BadInputIsAStatus) {
  const Image<std::uint8_t> flat(100, 100, 77);
  const Quad<double> quad = quad_of(10, 10, 90, 10, 90, 90, 10, 90);
  std::vector<Vector2f> pixels{Vector2f(1, 1)};
  EXPECT_EQ(select_pixels(flat.view(), quad, SelectOptions(), pixels), Status::too_few);
  EXPECT_TRUE(pixels.empty());
  EXPECT_EQ(select_pixels(ImageView8(), quad, SelectOptions(), pixels), Status::invalid_argument);
  EXPECT_EQ(select_pixels(flat.view(), quad_of(10, 10, 20, 20, 30, 30, 40, 40), SelectOptions(), pixels),
            Status::degenerate);
  Quad<double> bad = quad;
  bad.corner[2][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(select_pixels(flat.view(), bad, SelectOptions(), pixels), Status::non_finite);
}

TEST(SelectSpread, StrongestOfEveryFreeCell) {
  const std::vector<Corner> corners = {{5, 5, 10}, {8, 8, 30}, {15, 5, 20}, {25, 5, 40}, {5, 15, 30}, {95, 95, 99}};
  std::vector<Corner> out;
  select_spread(corners, 30, 20, 10, 100, {Vector2f(29.5F, 9.5F), Vector2f(500, 3), Vector2f(-1, -1)}, out);
  ASSERT_EQ(out.size(), 3U);  // the cell of (25, 5) is occupied, (95, 95) is outside
  EXPECT_EQ(out[0].x, 8);     // equal scores in raster order
  EXPECT_EQ(out[1].y, 15);
  EXPECT_EQ(out[2].x, 15);
  select_spread(corners, 30, 20, 10, 2, {}, out);
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out[0].score, 40);
  select_spread(corners, 30, 20, 0, 2, {}, out);
  EXPECT_TRUE(out.empty());
}

// One pixel more than a whole number of cells: the last column and row are cells of their own.
TEST(SelectSpread, TheLastColumnAndRowAreCells) {
  const std::vector<Corner> corners = {{5, 5, 10}, {20, 5, 20}, {5, 20, 30}, {20, 20, 40}, {19, 19, 50}, {20, 19, 5}};
  std::vector<Corner> out;
  select_spread(corners, 21, 21, 10, 100, {}, out);
  std::vector<float> scores;
  for (const Corner& c : out) scores.push_back(c.score);
  EXPECT_EQ(scores, (std::vector<float>{50, 40, 30, 20, 10, 5}));
}

TEST(SelectSpread, IgnoresPointsThatAreNotNumbers) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<Corner> out;
  select_spread({{nan, 5, 10}, {5, 5, 3}}, 30, 20, 10, 5, {Vector2f(nan, nan)}, out);
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(out[0].x, 5);
}

TEST(MakePatch, HoldsIntensitiesOfEveryLevel) {
  const Image<std::uint8_t> image = textured();
  const Quad<double> quad = quad_of(60, 40, 250, 60, 245, 160, 70, 150);
  const Pinhole<double> camera(300, 300, 160, 120);
  const Pyramid pyramid(image.view(), 3);
  const TextPatch patch = make_patch(pyramid.view(), camera, quad);
  ASSERT_EQ(patch.status, Status::ok);
  ASSERT_EQ(patch.level_count(), 3);
  for (int l = 0; l < 3; ++l) {
    const PatchView v = patch.levels[static_cast<std::size_t>(l)].view();
    EXPECT_GE(v.n, 150);
    const Quad<double> level_quad = quad_to_level(quad, l);
    for (int i = 0; i < v.n; ++i) {
      EXPECT_EQ(v.intensity[i], pyramid.level(l)(static_cast<int>(v.x[i]), static_cast<int>(v.y[i])));
      EXPECT_TRUE(contains(level_quad, Vector2d(v.x[i], v.y[i])));
    }
  }
  const TextPatch same = make_patch(image.view(), camera, quad);
  ASSERT_EQ(same.level_count(), 3);
  for (std::size_t l = 0; l < 3; ++l) EXPECT_EQ(same.levels[l].x, patch.levels[l].x);
}

TEST(MakePatch, FailsWithAStatus) {
  const Image<std::uint8_t> flat(100, 100, 77), image = textured();
  const Quad<double> quad = quad_of(10, 10, 90, 10, 90, 90, 10, 90);
  const Pinhole<double> camera(300, 300, 160, 120);
  EXPECT_EQ(make_patch(flat.view(), camera, quad).status, Status::too_few);
  EXPECT_EQ(make_patch(ImageView8(), camera, quad).status, Status::invalid_argument);
  EXPECT_EQ(make_patch(image.view(), Pinhole<double>(-1, 1, 0, 0), quad).status, Status::invalid_argument);
  SelectOptions options;
  options.levels = 0;
  EXPECT_EQ(make_patch(image.view(), camera, quad, options).status, Status::invalid_argument);
}

}  // namespace select_test
