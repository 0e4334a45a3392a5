// Hull, intersection, clipping and overlap of quads.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "geometry/quad_support.hpp"
#include "textplane/geometry/quad.hpp"

namespace quad_test {

using Polygon = tp::ConvexPolygon<double>;

TYPED_TEST(Quads, HullOfAConvexQuadIsTheQuad) {
  using S = TypeParam;
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Quad q = random_convex(random, {100, 80}, 40);
    for (std::size_t turn = 0; turn < 4; ++turn)
      for (const Quad& form : {rotated(q, turn), reversed(rotated(q, turn))}) {
        const auto hull = tp::convex_hull(form.cast<S>());
        ASSERT_EQ(hull.size(), 4);
        EXPECT_NEAR(value(tp::area(hull)), tp::area(q), tolerance<S>(2e-3, 1e-11));
      }
  }
}

TEST(QuadTest, HullMakesConcaveAndCrossedQuadsUsable) {
  const Quad dented = make_quad({0, 0}, {10, 0}, {2, 2}, {0, 10});
  EXPECT_EQ(tp::convex_hull(dented).size(), 3);
  EXPECT_DOUBLE_EQ(tp::area(tp::convex_hull(dented)), 50);
  const Quad bow = make_quad({0, 0}, {10, 6}, {10, 0}, {0, 6});
  EXPECT_EQ(tp::convex_hull(bow).size(), 4);
  EXPECT_DOUBLE_EQ(tp::area(tp::convex_hull(bow)), 60);
  const Quad twice = make_quad({0, 0}, {10, 0}, {10, 0}, {0, 6});
  EXPECT_EQ(tp::convex_hull(twice).size(), 3);
  EXPECT_DOUBLE_EQ(tp::area(tp::convex_hull(twice)), 30);
}

TEST(QuadTest, IntersectionOfRectangles) {
  const Quad a = rectangle(0, 0, 10, 6);
  EXPECT_DOUBLE_EQ(tp::area(tp::intersection(a, rectangle(4, 2, 20, 20))), 24);
  EXPECT_DOUBLE_EQ(tp::area(tp::intersection(a, reversed(rectangle(4, 2, 20, 20)))), 24);
  EXPECT_DOUBLE_EQ(tp::area(tp::intersection(a, a)), 60);
  EXPECT_DOUBLE_EQ(tp::area(tp::intersection(a, rectangle(2, 2, 3, 3))), 1);
  EXPECT_DOUBLE_EQ(tp::area(tp::intersection(rectangle(2, 2, 3, 3), a)), 1);
  EXPECT_TRUE(tp::intersection(a, rectangle(11, 0, 20, 6)).empty());
  EXPECT_TRUE(tp::intersection(a, rectangle(10, 0, 20, 6)).empty()) << "a shared edge is no area";
  EXPECT_TRUE(tp::intersection(a, rectangle(10, 6, 20, 20)).empty()) << "a shared corner is no area";
}

TEST(QuadTest, IntersectionHasEightCornersAtMost) {
  // A square and the same square turned by 45 degrees: the octagon of area 8 (sqrt 2 - 1) for a half side of 1.
  const double r = std::sqrt(2.0);
  const Polygon octagon = tp::intersection(rectangle(-1, -1, 1, 1), make_quad({0, -r}, {r, 0}, {0, r}, {-r, 0}));
  EXPECT_EQ(octagon.size(), 8);
  EXPECT_NEAR(tp::area(octagon), 8 * (r - 1), 1e-14);
}

TYPED_TEST(Quads, IntersectionAreaAgreesWithCounting) {
  using S = TypeParam;
  Random random(4);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Quad a = random_convex(random, {0, 0}, 10), b = random_convex(random, random.vector<2>(8), 10);
    constexpr int kGrid = 250;
    int both = 0, either = 0;
    for (int y = 0; y < kGrid; ++y)
      for (int x = 0; x < kGrid; ++x) {
        const Vector2d p(-20 + 40 * (x + 0.5) / kGrid, -20 + 40 * (y + 0.5) / kGrid);
        const bool in_a = inside_by_angles(a, p), in_b = inside_by_angles(b, p);
        both += in_a && in_b ? 1 : 0;
        either += in_a || in_b ? 1 : 0;
      }
    const double cell = 1600.0 / (kGrid * kGrid);
    const auto common = tp::intersection(a.cast<S>(), b.cast<S>());
    EXPECT_NEAR(value(tp::area(common)), both * cell,
                0.6);  // 40 px of outline, of which each cell of 0.16 px errs by half
    EXPECT_NEAR(value(tp::area(tp::intersection(b.cast<S>(), a.cast<S>()))), value(tp::area(common)),
                tolerance<S>(1e-3, 1e-11));
    EXPECT_NEAR(value(tp::iou(a.cast<S>(), b.cast<S>())), static_cast<double>(both) / either, 0.01);
    // Each vertex, moved a little inwards, lies in both.
    Vector2d mean = Vector2d::Zero();
    for (int i = 0; i < common.size(); ++i) mean += values(common[i]) / common.size();
    for (int i = 0; i < common.size() && both * cell > 1; ++i) {
      const Vector2d inwards = values(common[i]) + 1e-3 * (mean - values(common[i]));
      EXPECT_TRUE(inside_by_angles(a, inwards) && inside_by_angles(b, inwards));
    }
  }
}

TEST(QuadTest, IouEnds) {
  const Quad a = rectangle(0, 0, 10, 6);
  EXPECT_DOUBLE_EQ(tp::iou(a, a), 1);
  EXPECT_DOUBLE_EQ(tp::iou(a, reversed(a)), 1);
  EXPECT_DOUBLE_EQ(tp::iou(a, rectangle(0, 0, 5, 6)), 0.5);
  EXPECT_EQ(tp::iou(a, rectangle(20, 0, 25, 6)), 0);
  EXPECT_EQ(tp::iou(a, Quad()), 0);
  EXPECT_EQ(tp::iou(Quad(), Quad()), 0);
}

TEST(QuadTest, OverlapEnds) {
  const Quad a = rectangle(0, 0, 10, 6);
  EXPECT_DOUBLE_EQ(tp::overlap(a, rectangle(0, 0, 5, 6)), 1) << "the smaller one lies in the other";
  EXPECT_DOUBLE_EQ(tp::overlap(rectangle(0, 0, 5, 6), reversed(a)), 1);
  EXPECT_DOUBLE_EQ(tp::overlap(a, rectangle(8, 0, 12, 6)), 0.5);
  EXPECT_EQ(tp::overlap(a, rectangle(20, 0, 25, 6)), 0);
  EXPECT_EQ(tp::overlap(a, Quad()), 0);
}

TYPED_TEST(Quads, ClipToTheImage) {
  using S = TypeParam;
  const auto clipped = [](const Quad& q) { return value(tp::area(tp::clip_to_image(q.cast<S>(), 101, 51))); };
  EXPECT_EQ(clipped(rectangle(10, 10, 20, 20)), 100);
  EXPECT_EQ(clipped(rectangle(-10, -10, 20, 20)), 400);
  EXPECT_NEAR(clipped(rectangle(-10, -10, 200, 200)), 5000, tolerance<S>(2e-3, 1e-11))
      << "the sampling domain is [0, w-1] x [0, h-1]";
  EXPECT_EQ(clipped(rectangle(101, 0, 120, 20)), 0);
  EXPECT_EQ(clipped(rectangle(-30, -30, 0, 0)), 0);
  // A diamond over the left edge loses half, over the corner three quarters.
  EXPECT_EQ(clipped(make_quad({0, 10}, {10, 20}, {0, 30}, {-10, 20})), 100);
  EXPECT_EQ(clipped(make_quad({0, -10}, {10, 0}, {0, 10}, {-10, 0})), 50);
  EXPECT_TRUE(tp::clip_to_image(rectangle(0, 0, 9, 9).cast<S>(), 0, 5).empty());
  EXPECT_TRUE(tp::clip_to_image(rectangle(0, 0, 9, 9).cast<S>(), -3, 5).empty());
  EXPECT_TRUE(tp::clip_to_image(rectangle(0, 0, 9, 9).cast<S>(), 1, 5).empty()) << "one column has no area";
}

TEST(QuadTest, ClippedToEightCorners) {
  const Quad big_diamond = make_quad({50, -20}, {130, 25}, {50, 70}, {-30, 25});
  const Polygon part = tp::clip_to_image(big_diamond, 101, 51);
  EXPECT_EQ(part.size(), 8);
  EXPECT_LE(tp::area(part), 5000);
  for (int i = 0; i < part.size(); ++i) {
    EXPECT_GE(part[i].minCoeff(), -1e-12);
    EXPECT_LE(part[i][0], 100 + 1e-12);
    EXPECT_LE(part[i][1], 50 + 1e-12);
  }
}

TEST(QuadTest, DegenerateAndBrokenQuadsAreHarmless) {
  const Quad good = rectangle(0, 0, 10, 6);
  std::vector<Quad> bad = {Quad(), make_quad({1, 1}, {1, 1}, {1, 1}, {1, 1}), make_quad({0, 0}, {1, 1}, {2, 2}, {3, 3}),
                           make_quad({0, 0}, {10, 0}, {0, 0}, {10, 0}),
                           make_quad({1e-300, 0}, {0, 0}, {0, 1e-300}, {0, 0}),
                           // Thirds are not exact: a line up to rounding.
                           make_quad({0, 0}, {1. / 3, 1. / 7}, {2. / 3, 2. / 7}, {4. / 3, 4. / 7}),
                           make_quad({1e300, 0}, {-1e300, 1e300}, {0, 1e308}, {1e308, -1e308})};
  for (const double value_ : {kNan, kInf, -kInf})
    for (std::size_t i = 0; i < 4; ++i)
      for (int k = 0; k < 2; ++k) {
        bad.push_back(good);
        bad.back().corner[i][k] = value_;
        EXPECT_EQ(tp::area(bad.back()), 0);
        EXPECT_FALSE(tp::contains(bad.back(), Vector2d(5, 3)));
      }
  for (const Quad& q : bad) {
    EXPECT_FALSE(tp::is_convex(q));
    EXPECT_TRUE(tp::convex_hull(q).empty());
    EXPECT_TRUE(tp::intersection(q, good).empty());
    EXPECT_TRUE(tp::intersection(good, q).empty());
    EXPECT_TRUE(tp::clip_to_image(q, 640, 480).empty());
    EXPECT_EQ(tp::iou(q, good), 0);
    EXPECT_EQ(tp::iou(good, q), 0);
  }
}

TEST(QuadTest, ThinAndTinyQuadsKeepTheirArea) {
  // A hair of 1e-6 px, and quads far from the origin: relative accuracy of the clip, not luck.
  const Quad hair = make_quad({0, 0}, {100, 0}, {100, 1e-6}, {0, 1e-6});
  EXPECT_NEAR(tp::area(tp::intersection(hair, rectangle(50, -1, 200, 1))), 5e-5, 1e-12);
  const Quad far = rectangle(1e6, 1e6, 1e6 + 2, 1e6 + 2);
  EXPECT_NEAR(tp::area(tp::intersection(far, rectangle(1e6 + 1, 0, 2e6, 2e6))), 2, 1e-9);
}

TEST(ConvexPolygonTest, NeverOverflows) {
  Polygon p;
  for (int i = 0; i < 20; ++i) p.push({static_cast<double>(i), 0});
  EXPECT_EQ(p.size(), Polygon::kCapacity);
  p.clear();
  EXPECT_TRUE(p.empty());
  EXPECT_FALSE(tp::contains(p, Vector2d(0, 0)));
  EXPECT_EQ(tp::area(p), 0);
}

}  // namespace quad_test
