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
  template tp::Quad<S> tp::quad_to_level<S>(const tp::Quad<S>&, int);
TEXTPLANE_INSTANTIATE(float)
TEXTPLANE_INSTANTIATE(double)
TEXTPLANE_INSTANTIATE(Dual<2>)
#undef TEXTPLANE_INSTANTIATE

namespace quad_test {

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
    const tp::ConvexPolygon<double> hull = tp::convex_hull(q);
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

}  // namespace quad_test
