#include "detectors/db_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "detectors/pieces.hpp"

namespace textslam {
namespace {

using Point = Vector2<double>;

constexpr double kTall = 1.5;  // height over width of a text that runs downwards

/// A rectangle whose sides run along `along` and across it, half their lengths in `half`.
struct Rectangle {
  Point along = Point::UnitX(), centre = Point::Zero(), half = Point::Zero();
};

/// Of least area around a convex outline: one of its sides runs along a side of the outline.
Rectangle least_rectangle(const std::vector<Point>& outline) {
  Rectangle least;
  double least_area = -1;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point side = outline[(i + 1) % outline.size()] - outline[i];
    if (!(side.squaredNorm() > 0)) continue;
    const Point along = side.normalized(), across(-along.y(), along.x());
    Point low(along.dot(outline[0]), across.dot(outline[0])), high = low;
    for (const Point& p : outline) {
      const Point q(along.dot(p), across.dot(p));
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    }
    const Point size = high - low, middle = 0.5 * (low + high);
    if (least_area >= 0 && size.x() * size.y() >= least_area) continue;
    least_area = size.x() * size.y();
    least = {along, middle.x() * along + middle.y() * across, 0.5 * size};
  }
  return least;
}

double mean_inside(const DbMap& map, const Piece& core) {
  double sum = 0;
  for (int i = 0; i < core.count; ++i) {
    const float* row = map.probability + static_cast<std::ptrdiff_t>(core[i].y) * map.columns;
    for (int x = core[i].x0; x <= core[i].x1; ++x) sum += static_cast<double>(row[x]);
  }
  return sum / core.area;
}

// Corners from the text's top left. The text runs along the axis nearest to the horizontal, or downwards if the box is
// tall.
Quad<double> oriented(const Rectangle& rectangle, double grow) {
  Point along = rectangle.along, down(-along.y(), along.x());
  double half_along = rectangle.half.x() + grow, half_down = rectangle.half.y() + grow;
  while (std::abs(along.x()) < std::abs(along.y()) || along.x() < 0) {
    const Point old = along;
    along = -down;
    down = old;
    std::swap(half_along, half_down);
  }
  if (half_down > kTall * half_along) {
    const Point old = along;
    along = down;
    down = -old;
    std::swap(half_along, half_down);
  }
  const Point a = half_along * along, d = half_down * down, &centre = rectangle.centre;
  Quad<double> quad;
  quad.corner = {centre - a - d, centre + a - d, centre + a + d, centre - a + d};
  return quad;
}

}  // namespace

std::vector<Detection> decode_db(const DbMap& map, const DbParameters& parameters) {
  Image<std::uint8_t> core(map.columns, map.rows);
  for (int y = 0; y < map.rows; ++y) {
    const float* row = map.probability + static_cast<std::ptrdiff_t>(y) * map.columns;
    for (int x = 0; x < map.columns; ++x)
      core(x, y) = std::isfinite(row[x]) && static_cast<double>(row[x]) > parameters.min_probability ? 1 : 0;
  }
  Pieces cores;
  cores.find(core.view(), Touch::corners);
  std::vector<Detection> boxes;
  std::vector<Point> outline;
  for (int i = 0; i < cores.size(); ++i) {
    const Piece piece = cores[i];
    trace_outline(piece, 0, outline);
    const Rectangle rectangle = least_rectangle(outline);
    const Point size = 2 * rectangle.half;
    if (size.minCoeff() < parameters.min_side) continue;
    Detection box;
    box.score = mean_inside(map, piece);
    if (box.score < parameters.min_score) continue;
    box.quad = oriented(rectangle, parameters.unclip * size.prod() / (2 * size.sum()));
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace textslam
