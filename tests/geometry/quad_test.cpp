#include "textplane/geometry/quad.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/quad_support.hpp"

namespace tp = textplane;
using textplane_test::Dual;

#define TEXTPLANE_INSTANTIATE(S)                                                                               \
  template struct tp::Quad<S>;                                                                                 \
  template class tp::ConvexPolygon<S>;                                                                         \
  template struct tp::Bounds<S>;                                                                               \
  template bool tp::all_finite<S>(const tp::Quad<S>&);                                                         \
  template S tp::area<S>(const tp::Quad<S>&);                                                                  \
  template S tp::area<S>(const tp::ConvexPolygon<S>&);                                                         \
  template bool tp::is_convex<S>(const tp::Quad<S>&);                                                          \
  template bool tp::contains<S>(const tp::Quad<S>&, const tp::Vector2<S>&);                                    \
  template bool tp::contains<S>(const tp::ConvexPolygon<S>&, const tp::Vector2<S>&);                           \
  template tp::Vector2<S> tp::centroid<S>(const tp::Quad<S>&);                                                 \
  template tp::Bounds<S> tp::bounds<S>(const tp::Quad<S>&);                                                    \
  template bool tp::inside_image<S>(const tp::Quad<S>&, int, int, const S&);                                   \
  template tp::ConvexPolygon<S> tp::convex_hull<S>(const tp::Quad<S>&);                                        \
  template tp::ConvexPolygon<S> tp::intersection<S>(const tp::ConvexPolygon<S>&, const tp::ConvexPolygon<S>&); \
  template tp::ConvexPolygon<S> tp::intersection<S>(const tp::Quad<S>&, const tp::Quad<S>&);                   \
  template tp::ConvexPolygon<S> tp::clip_to_image<S>(const tp::Quad<S>&, int, int);                            \
  template S tp::iou<S>(const tp::Quad<S>&, const tp::Quad<S>&);                                               \
  template tp::Vector2<S> tp::point_to_level<S>(const tp::Vector2<S>&, int);                                   \
  template tp::Vector2<S> tp::point_from_level<S>(const tp::Vector2<S>&, int);                                 \
  template tp::Quad<S> tp::quad_to_level<S>(const tp::Quad<S>&, int);                                          \
  template tp::Status tp::transform<S>(const tp::Quad<S>&, const tp::Matrix3<S>&, tp::Quad<S>*);               \
  template tp::Status tp::project_quad<S>(const tp::Quad<S>&, const tp::Pinhole<S>&, const tp::Vector3<S>&,    \
                                          const tp::SE3<S>&, const tp::Pinhole<S>&, tp::Quad<S>*);             \
  template tp::Status tp::quad_points<S>(const tp::Quad<S>&, const tp::Pinhole<S>&, const tp::Vector3<S>&,     \
                                         std::array<tp::Vector3<S>, 4>*);
TEXTPLANE_INSTANTIATE(float)
TEXTPLANE_INSTANTIATE(double)
TEXTPLANE_INSTANTIATE(Dual<2>)
#undef TEXTPLANE_INSTANTIATE

namespace quad_test {

using Polygon = tp::ConvexPolygon<double>;

Quad reversed(const Quad& q) { return make_quad(q.corner[0], q.corner[3], q.corner[2], q.corner[1]); }
Quad rotated(const Quad& q, std::size_t by) {
  return make_quad(q.corner[by % 4], q.corner[(by + 1) % 4], q.corner[(by + 2) % 4], q.corner[(by + 3) % 4]);
}

// The part of both quads by counting a fine grid: knows nothing of clipping. Inside by the winding of angles.
bool inside_by_angles(const Quad& q, const Vector2d& p) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d a = q.corner[i] - p, b = q.corner[(i + 1) % 4] - p;
    sum += std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
  }
  return std::abs(sum) > 3.14;
}

TYPED_TEST(Quads, AreaIsPositiveClockwiseOnTheScreen) {
  using S = TypeParam;
  const Quad q = make_quad({10, 20}, {70, 25}, {65, 50}, {12, 44});
  // Shoelace by hand.
  const double twice = (10 * 25 - 70 * 20) + (70 * 50 - 65 * 25) + (65 * 44 - 12 * 50) + (12 * 20 - 10 * 44);
  EXPECT_NEAR(value(tp::area(q.cast<S>())), twice / 2, tolerance<S>(1e-3, 1e-11));
  EXPECT_GT(value(tp::area(q.cast<S>())), 0);
  EXPECT_EQ(value(tp::area(reversed(q).cast<S>())), -value(tp::area(q.cast<S>())));
  EXPECT_EQ(value(tp::area(rectangle(1, 2, 5, 4).cast<S>())), 8);
  EXPECT_EQ(value(tp::area(Quad().cast<S>())), 0);
  EXPECT_EQ(value(tp::area(make_quad({0, 0}, {1, 1}, {2, 2}, {3, 3}).cast<S>())), 0);
}

TEST(QuadTest, AreaCarriesDerivatives) {
  tp::Quad<Dual<2>> q = rectangle(0, 0, 4, 2).cast<Dual<2>>();
  q.corner[2] = {Dual<2>(4, 0), Dual<2>(2, 1)};
  const Dual<2> a = tp::area(q);
  EXPECT_EQ(a.v[0], 1);  // half of the diagonal's height
  EXPECT_EQ(a.v[1], 2);
}

TYPED_TEST(Quads, ConvexityOfEitherOrientation) {
  using S = TypeParam;
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Quad q = random_convex(random, {100, 80}, random.uniform(1, 60));
    EXPECT_TRUE(tp::is_convex(q.cast<S>()));
    EXPECT_TRUE(tp::is_convex(reversed(q).cast<S>()));
    Quad bow = q;
    std::swap(bow.corner[1], bow.corner[2]);
    EXPECT_FALSE(tp::is_convex(bow.cast<S>()));
    Quad dented = q;
    dented.corner[2] = 0.35 * (q.corner[1] + q.corner[3]) + 0.3 * q.corner[0];  // this side of the diagonal
    EXPECT_FALSE(tp::is_convex(dented.cast<S>()));
    Quad flat = q;
    flat.corner[1] = 0.5 * (q.corner[0] + q.corner[2]);
    EXPECT_FALSE(tp::is_convex(flat.cast<S>())) << "three corners on a line";
    Quad twice = q;
    twice.corner[1] = q.corner[0];
    EXPECT_FALSE(tp::is_convex(twice.cast<S>())) << "two equal corners";
  }
  EXPECT_FALSE(tp::is_convex(Quad().cast<S>()));
}

TYPED_TEST(Quads, ContainsInsideAndEdge) {
  using S = TypeParam;
  const auto q = rectangle(1, 2, 5, 4).cast<S>(), back = reversed(rectangle(1, 2, 5, 4)).cast<S>();
  for (const auto& quad : {q, back}) {
    EXPECT_TRUE(tp::contains(quad, tp::Vector2<S>(S(3), S(3))));
    EXPECT_TRUE(tp::contains(quad, tp::Vector2<S>(S(1), S(2)))) << "corner";
    EXPECT_TRUE(tp::contains(quad, tp::Vector2<S>(S(5), S(3)))) << "edge";
    EXPECT_FALSE(tp::contains(quad, tp::Vector2<S>(S(5.001), S(3))));
    EXPECT_FALSE(tp::contains(quad, tp::Vector2<S>(S(3), S(1.999))));
    EXPECT_FALSE(tp::contains(quad, tp::Vector2<S>(S(static_cast<float>(kNan)), S(3))));
    EXPECT_FALSE(tp::contains(quad, tp::Vector2<S>(S(3), S(static_cast<float>(kInf)))));
  }
  EXPECT_FALSE(tp::contains(Quad().cast<S>(), tp::Vector2<S>(S(0), S(0)))) << "no area holds nothing";
}

TEST(QuadTest, ContainsAgreesWithTheWindingAngle) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const Quad q = random_convex(random, {0, 0}, 10);
    const Polygon hull = tp::convex_hull(q);
    for (int k = 0; k < 100; ++k) {
      const Vector2d p = random.vector<2>(12);
      EXPECT_EQ(tp::contains(q, p), inside_by_angles(q, p));
      EXPECT_EQ(tp::contains(hull, p), inside_by_angles(q, p));
      EXPECT_EQ(tp::contains(reversed(q), p), inside_by_angles(q, p));
    }
  }
}

TEST(QuadTest, CentroidAndBounds) {
  EXPECT_EQ(tp::centroid(rectangle(1, 2, 5, 4)), Vector2d(3, 3));
  // A trapezium: top 2, bottom 4, height 3 has its centre 3 (2 + 2*4) / (3 (2 + 4)) below the top.
  const Quad trapezium = make_quad({1, 0}, {3, 0}, {4, 3}, {0, 3});
  EXPECT_LT((tp::centroid(trapezium) - Vector2d(2, 3.0 * 10 / 18)).norm(), 1e-14);
  EXPECT_LT((tp::centroid(reversed(trapezium)) - Vector2d(2, 3.0 * 10 / 18)).norm(), 1e-14);
  EXPECT_EQ(tp::centroid(make_quad({0, 0}, {2, 0}, {4, 0}, {6, 0})), Vector2d(3, 0)) << "no area: mean of the corners";
  const auto box = tp::bounds(make_quad({3, -1}, {7, 2}, {5, 9}, {-2, 4}));
  EXPECT_EQ(box.min, Vector2d(-2, -1));
  EXPECT_EQ(box.max, Vector2d(7, 9));
}

TEST(QuadTest, InsideImage) {
  EXPECT_TRUE(tp::inside_image(rectangle(0, 0, 639, 479), 640, 480));
  EXPECT_FALSE(tp::inside_image(rectangle(0, 0, 639.01, 479), 640, 480));
  EXPECT_FALSE(tp::inside_image(rectangle(-0.01, 0, 100, 100), 640, 480));
  EXPECT_TRUE(tp::inside_image(rectangle(5, 5, 634, 474), 640, 480, 5.0));
  EXPECT_FALSE(tp::inside_image(rectangle(4, 5, 634, 474), 640, 480, 5.0));
  EXPECT_FALSE(tp::inside_image(rectangle(kNan, 5, 634, 474), 640, 480));
}

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
