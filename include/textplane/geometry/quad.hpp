// Convex quadrilaterals in an image: area, inside, hull, intersection, clipping, overlap and pyramid levels.
//
// Corners run clockwise on the screen (x right, y down) from the top left of the text, in px unless said otherwise. No
// function allocates; NaN gives zero areas, empty polygons and `false`.
#ifndef TEXTPLANE_GEOMETRY_QUAD_HPP
#define TEXTPLANE_GEOMETRY_QUAD_HPP

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "textplane/core/numeric.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A quad in px or normalised coordinates.
template <class S>
struct Quad {
  /// Clockwise on the screen, from the text's top left.
  std::array<Vector2<S>, 4> corner{Vector2<S>::Zero(), Vector2<S>::Zero(), Vector2<S>::Zero(), Vector2<S>::Zero()};

  /// The same of another scalar.
  template <class U>
  Quad<U> cast() const noexcept {
    Quad<U> q;
    for (std::size_t i = 0; i < 4; ++i) q.corner[i] = corner[i].template cast<U>();
    return q;
  }
};

/// Whether no coordinate is infinite or NaN.
template <class S>
bool all_finite(const Quad<S>& quad) noexcept {
  for (const auto& c : quad.corner)
    if (!all_finite(c)) return false;
  return true;
}

/// A convex polygon of at most 16 vertices, clockwise on the screen, stored in place. Empty when size() is 0.
template <class S>
class ConvexPolygon {
 public:
  static constexpr int kCapacity = 16;  ///< Most vertices that it holds.

  int size() const noexcept { return size_; }         ///< Number of vertices.
  bool empty() const noexcept { return size_ == 0; }  ///< Whether it has no vertices.
  /// Vertex i, not checked.
  const Vector2<S>& operator[](int i) const noexcept { return vertex_[static_cast<std::size_t>(i)]; }
  void clear() noexcept { size_ = 0; }  ///< Removes all vertices.
  /// Appends a vertex; drops it where the polygon is full.
  void push(const Vector2<S>& p) noexcept {
    if (size_ < kCapacity) vertex_[static_cast<std::size_t>(size_++)] = p;
  }

 private:
  std::array<Vector2<S>, kCapacity> vertex_;
  int size_ = 0;
};

/// Axis-aligned bounding box.
template <class S>
struct Bounds {
  Vector2<S> min = Vector2<S>::Zero();  ///< Least x and least y, in the unit of the quad.
  Vector2<S> max = Vector2<S>::Zero();  ///< Greatest x and greatest y.
};

namespace detail {
/// (b - a) x (c - a): positive where a, b, c turn clockwise on the screen.
template <class S>
S turn(const Vector2<S>& a, const Vector2<S>& b, const Vector2<S>& c) noexcept {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}
/// turn(), or zero where it is within the rounding error of the coordinates.
template <class S>
S significant_turn(const Vector2<S>& a, const Vector2<S>& b, const Vector2<S>& c) noexcept {
  using std::abs;
  S size = S(0);
  for (const Vector2<S>* p : {&a, &b, &c})
    for (int k = 0; k < 2; ++k)
      if (S(abs((*p)[k])) > size) size = S(abs((*p)[k]));
  const S extent = S(abs(b[0] - a[0])) + S(abs(b[1] - a[1])) + S(abs(c[0] - a[0])) + S(abs(c[1] - a[1]));
  const S t = turn(a, b, c);
  return S(abs(t)) > S(4) * std::numeric_limits<S>::epsilon() * size * extent ? t : S(0);
}
}  // namespace detail

/// Signed area in px^2, positive for clockwise corners. 0 where a corner is not finite.
template <class S>
S area(const Quad<S>& quad) noexcept {
  const auto& c = quad.corner;
  const S twice = (c[2][0] - c[0][0]) * (c[3][1] - c[1][1]) - (c[2][1] - c[0][1]) * (c[3][0] - c[1][0]);
  return is_finite(twice) ? twice / S(2) : S(0);
}

/// Area of the polygon in px^2, never negative for a polygon that this library made.
template <class S>
S area(const ConvexPolygon<S>& polygon) noexcept {
  S twice = S(0);
  for (int i = 2; i < polygon.size(); ++i) twice += detail::turn(polygon[0], polygon[i - 1], polygon[i]);
  return twice / S(2);
}

/// Strictly convex (no three corners on a line beyond rounding), of either orientation. A bow tie is not; NaN is not.
template <class S>
bool is_convex(const Quad<S>& quad) noexcept {
  if (!all_finite(quad)) return false;
  int positive = 0, negative = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const S t = detail::significant_turn(quad.corner[i], quad.corner[(i + 1) % 4], quad.corner[(i + 2) % 4]);
    positive += t > S(0) ? 1 : 0;
    negative += t < S(0) ? 1 : 0;
  }
  return positive == 4 || negative == 4;
}

/// p lies in the convex quad or on its edge (either orientation). False for a quad without area and for NaN.
template <class S>
bool contains(const Quad<S>& quad, const Vector2<S>& p) noexcept {
  const S orientation = area(quad);
  if (!(orientation > S(0)) && !(orientation < S(0))) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    const S t = detail::turn(quad.corner[i], quad.corner[(i + 1) % 4], p);
    if (!is_finite(t) || !(orientation > S(0) ? t >= S(0) : t <= S(0))) return false;
  }
  return true;
}

/// p lies in the polygon or on its edge.
template <class S>
bool contains(const ConvexPolygon<S>& polygon, const Vector2<S>& p) noexcept {
  for (int i = 0; i < polygon.size(); ++i) {
    const S t = detail::turn(polygon[i], polygon[(i + 1) % polygon.size()], p);
    if (!is_finite(t) || !(t >= S(0))) return false;
  }
  return polygon.size() >= 3;
}

/// Centre of mass of the area; the mean of the corners where there is no area.
template <class S>
Vector2<S> centroid(const Quad<S>& quad) noexcept {
  const auto& c = quad.corner;
  const S first = detail::turn(c[0], c[1], c[2]), second = detail::turn(c[0], c[2], c[3]), sum = first + second;
  const Vector2<S> mean = (c[0] + c[1] + c[2] + c[3]) / S(4);
  if (!(sum > S(0)) && !(sum < S(0))) return mean;
  const Vector2<S> centre = ((c[0] + c[1] + c[2]) * first + (c[0] + c[2] + c[3]) * second) / (S(3) * sum);
  return all_finite(centre) ? centre : mean;
}

/// Smallest box around the corners.
template <class S>
Bounds<S> bounds(const Quad<S>& quad) noexcept {
  Bounds<S> b{quad.corner[0], quad.corner[0]};
  for (const auto& c : quad.corner)
    for (int k = 0; k < 2; ++k) {
      if (c[k] < b.min[k]) b.min[k] = c[k];
      if (c[k] > b.max[k]) b.max[k] = c[k];
    }
  return b;
}

/// All corners lie at least `margin` px inside [0, width - 1] x [0, height - 1]. False for NaN.
template <class S>
bool inside_image(const Quad<S>& quad, int width, int height, const S& margin = S(0)) noexcept {
  for (const auto& c : quad.corner)
    if (!all_finite(c) || !is_finite(margin) ||
        !(c[0] >= margin && c[1] >= margin && c[0] <= S(width - 1) - margin && c[1] <= S(height - 1) - margin))
      return false;
  return true;
}

/// Convex hull of the four corners, clockwise. It repairs a detector's quad that is slightly concave or crosses itself.
/// Empty where it has no area or a corner is not finite.
template <class S>
ConvexPolygon<S> convex_hull(const Quad<S>& quad) noexcept {
  ConvexPolygon<S> hull;
  if (!all_finite(quad)) return hull;
  std::array<Vector2<S>, 4> p = quad.corner;
  for (std::size_t i = 1; i < 4; ++i)
    for (std::size_t j = i; j > 0 && (p[j][0] < p[j - 1][0] || (p[j][0] == p[j - 1][0] && p[j][1] < p[j - 1][1]));
         --j) {
      const Vector2<S> swapped = p[j];
      p[j] = p[j - 1];
      p[j - 1] = swapped;
    }
  // Monotone chain: the upper edge left to right, the lower edge back.
  std::array<Vector2<S>, 9> chain;
  std::size_t n = 0;
  const auto extend = [&](const Vector2<S>& next, std::size_t base) {
    while (n >= base + 2 && !(detail::significant_turn(chain[n - 2], chain[n - 1], next) > S(0))) --n;
    chain[n++] = next;
  };
  for (std::size_t i = 0; i < 4; ++i) extend(p[i], 0);
  const std::size_t upper = n - 1;
  for (std::size_t i = 3; i-- > 0;) extend(p[i], upper);
  if (n < 4) return hull;  // a triangle is three corners and the first again
  for (std::size_t i = 0; i + 1 < n; ++i) hull.push(chain[i]);
  if (!(area(hull) > S(0)) || !is_finite(area(hull))) hull.clear();
  return hull;
}

namespace detail {
/// The part of the polygon on the clockwise side of the line from a to b (Sutherland and Hodgman). Adds at most one
/// vertex.
template <class S>
ConvexPolygon<S> clip_half_plane(const ConvexPolygon<S>& polygon, const Vector2<S>& a, const Vector2<S>& b) noexcept {
  ConvexPolygon<S> out;
  for (int i = 0; i < polygon.size(); ++i) {
    const Vector2<S>&p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const S sp = turn(a, b, p), sq = turn(a, b, q);
    if (sp >= S(0)) out.push(p);
    if ((sp > S(0) && sq < S(0)) || (sp < S(0) && sq > S(0))) out.push(p + (q - p) * (sp / (sp - sq)));
  }
  if (!(area(out) > S(0))) out.clear();
  return out;
}
}  // namespace detail

/// Common part of two convex polygons, empty where they share no area. Exact up to 16 vertices in sum.
template <class S>
ConvexPolygon<S> intersection(const ConvexPolygon<S>& a, const ConvexPolygon<S>& b) noexcept {
  ConvexPolygon<S> out = a;
  if (b.empty()) out.clear();
  for (int i = 0; i < b.size() && !out.empty(); ++i) out = detail::clip_half_plane(out, b[i], b[(i + 1) % b.size()]);
  return out;
}

/// Common part of (the convex hulls of) two quads: at most 8 vertices.
template <class S>
ConvexPolygon<S> intersection(const Quad<S>& a, const Quad<S>& b) noexcept {
  return intersection(convex_hull(a), convex_hull(b));
}

/// The part of (the convex hull of) the quad inside [0, width - 1] x [0, height - 1].
template <class S>
ConvexPolygon<S> clip_to_image(const Quad<S>& quad, int width, int height) noexcept {
  const S right = S(width - 1), bottom = S(height - 1);
  Quad<S> frame;
  frame.corner = {Vector2<S>(S(0), S(0)), Vector2<S>(right, S(0)), Vector2<S>(right, bottom), Vector2<S>(S(0), bottom)};
  if (!(right > S(0)) || !(bottom > S(0))) return {};
  return intersection(convex_hull(quad), convex_hull(frame));
}

/// Intersection over union of the (hulls of the) quads, in [0, 1]; 0 where either has no area.
template <class S>
S iou(const Quad<S>& a, const Quad<S>& b) noexcept {
  const ConvexPolygon<S> ha = convex_hull(a), hb = convex_hull(b);
  const S area_a = area(ha), area_b = area(hb), smaller = area_b < area_a ? area_b : area_a;
  S common = area(intersection(ha, hb));
  if (!(common > S(0))) return S(0);
  if (common > smaller) common = smaller;  // rounding of slivers
  return common / (area_a + area_b - common);
}

/// The area that two convex quads share, as a share of the smaller one's; 0 where either has no area.
template <class S>
S overlap(const Quad<S>& a, const Quad<S>& b) noexcept {
  using std::abs;
  const S area_a = abs(area(a)), area_b = abs(area(b)), smaller = area_b < area_a ? area_b : area_a;
  return smaller > S(0) ? area(intersection(a, b)) / smaller : S(0);
}

/// Pixel of level 0 in the pixels of pyramid level l: (x + 0.5) / 2^l - 0.5.
template <class S>
Vector2<S> point_to_level(const Vector2<S>& p, int level) noexcept {
  const S k = S(1) / S(1 << level);
  return {(p[0] + S(0.5)) * k - S(0.5), (p[1] + S(0.5)) * k - S(0.5)};
}

/// Inverse of point_to_level().
template <class S>
Vector2<S> point_from_level(const Vector2<S>& p, int level) noexcept {
  const S k = S(1 << level);
  return {(p[0] + S(0.5)) * k - S(0.5), (p[1] + S(0.5)) * k - S(0.5)};
}

/// The quad in the pixels of pyramid level l.
template <class S>
Quad<S> quad_to_level(const Quad<S>& quad, int level) noexcept {
  Quad<S> out;
  for (std::size_t i = 0; i < 4; ++i) out.corner[i] = point_to_level(quad.corner[i], level);
  return out;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_GEOMETRY_QUAD_HPP
