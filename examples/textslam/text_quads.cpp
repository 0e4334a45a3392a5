#include "textslam/text_quads.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace textslam {
namespace {

using Point = Vector2<double>;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Not empty. Changes the order.
double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double deviation(const std::vector<double>& values) {
  double sum = 0, squares = 0;
  for (const double v : values) sum += v;
  const double mean = sum / static_cast<double>(values.size());
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

/// One letter in the line's frame: u along the line, v across it, down.
struct Box {
  Extent u, v;
  double fill;  ///< area over u x v
  double middle() const { return 0.5 * (u.low + u.high); }
};

/// v = offset + slope u, through one point of each letter.
struct Rule {
  double slope = 0, offset = 0;
  double residual = 0;  ///< median distance
};

void settle(const std::vector<Point>& points, Rule& rule) {
  std::vector<double> rest;
  for (const Point& p : points) rest.push_back(p[1] - rule.slope * p[0]);
  std::vector<double> sorted = rest;
  rule.offset = median(sorted);
  for (double& r : rest) r = std::abs(r - rule.offset);
  rule.residual = median(rest);
}

/// Median slope of the pairs that are far apart (Theil and Sen): ascenders and descenders do not bend it.
Rule fit_rule(const std::vector<Point>& points) {
  const double reach = points.back()[0] - points.front()[0];
  std::vector<double> slopes;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j)
      if (points[j][0] - points[i][0] >= 0.4 * reach && points[j][0] > points[i][0])
        slopes.push_back((points[j][1] - points[i][1]) / (points[j][0] - points[i][0]));
  Rule rule;
  if (!slopes.empty()) rule.slope = median(slopes);
  settle(points, rule);
  return rule;
}

/// A line's letters in its frame, and the rules through their tops and bottoms.
struct Layout {
  Point along, across;
  std::vector<Box> boxes;
  Rule top, bottom;
  double height = 0;  ///< of the letters, median
};

Layout lay_out(const std::vector<Letter>& letters, const std::vector<int>& line, const Point& along) {
  Layout layout;
  layout.along = along;
  layout.across = {-along[1], along[0]};
  std::vector<Point> tops, bottoms;
  std::vector<double> heights;
  for (const int i : line) {
    const Letter& letter = letters[at(i)];
    Box box{extent(letter, layout.along), extent(letter, layout.across), 0.0};
    box.fill = letter.area / (box.u.length() * box.v.length());
    layout.boxes.push_back(box);
    tops.push_back({box.middle(), box.v.low});
    bottoms.push_back({box.middle(), box.v.high});
    heights.push_back(box.v.length());
  }
  layout.height = median(heights);
  layout.top = fit_rule(tops);
  layout.bottom = fit_rule(bottoms);
  // Where one side is ragged (small letters among capitals), it runs along the other.
  const double ragged = 0.08 * layout.height;
  if (layout.top.residual > ragged && layout.top.residual > layout.bottom.residual) {
    layout.top.slope = layout.bottom.slope;
    settle(tops, layout.top);
  } else if (layout.bottom.residual > ragged) {
    layout.bottom.slope = layout.top.slope;
    settle(bottoms, layout.bottom);
  }
  return layout;
}

/// How far the letters lean: the shear u' = u - lean v that makes them narrowest.
double lean_of(const std::vector<Letter>& letters, const std::vector<int>& line, const Layout& layout) {
  double best = 0, narrowest = 0;
  for (int step = 0; step <= 24; ++step) {
    const double lean = 0.05 * (step % 2 == 0 ? step / 2 : -(step + 1) / 2);  // from upright outwards
    const Point axis = layout.along - lean * layout.across;
    double sum = 0;
    for (const int i : line) sum += extent(letters[at(i)], axis).length();
    sum *= 1.0 + 0.1 * lean * lean;
    if (step == 0 || sum < narrowest) {
      narrowest = sum;
      best = lean;
    }
  }
  return best;
}

/// Letters that are no mere bars, and not all the same; tones that are even.
bool looks_like_print(const std::vector<Letter>& letters, const std::vector<int>& line, const Layout& layout,
                      const ClassicalParameters& parameters, double* tone_spread) {
  std::vector<double> inks, papers, contrasts, widths, fills;
  int bars = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Letter& letter = letters[at(line[i])];
    inks.push_back(letter.ink);
    papers.push_back(letter.paper);
    contrasts.push_back(letter.contrast());
    widths.push_back(layout.boxes[i].u.length() / layout.boxes[i].v.length());
    fills.push_back(layout.boxes[i].fill);
    bars += layout.boxes[i].fill > parameters.bar_fill ? 1 : 0;
  }
  if (bars > parameters.max_bars * static_cast<double>(line.size())) return false;
  if (std::max(deviation(widths), deviation(fills)) < parameters.min_variety) return false;
  *tone_spread = std::max(deviation(inks), deviation(papers)) / median(contrasts);
  return *tone_spread <= parameters.max_line_tone_spread;
}

/// Intersection of v = offset + slope u with u = side + lean v.
Point corner(double offset, double slope, double side, double lean) {
  const double v = (offset + slope * side) / (1.0 - slope * lean);
  return {side + lean * v, v};
}

}  // namespace

TextQuad fit_quad(const std::vector<Letter>& letters, const std::vector<int>& line, const ClassicalParameters& parameters) {
  TextQuad result;
  if (line.size() < 2) return result;
  Point along = letters[at(line.back())].centre - letters[at(line.front())].centre;
  along.normalize();
  Layout layout = lay_out(letters, line, along);
  // Once more along the text's own lines: extents across a tilted frame are blurred by the letters' widths.
  const double slope = layout.top.residual < layout.bottom.residual ? layout.top.slope : layout.bottom.slope;
  layout = lay_out(letters, line, Point(layout.along + slope * layout.across).normalized());

  const double residual = std::min(layout.top.residual, layout.bottom.residual) / layout.height;
  double tone_spread = 0;
  if (residual > parameters.max_residual) return result;
  if (!looks_like_print(letters, line, layout, parameters, &tone_spread)) return result;

  // Top and bottom move out until all ink is inside, and the margin with it.
  const double lean = lean_of(letters, line, layout), margin = parameters.margin * layout.height;
  const Point leaning = layout.along - lean * layout.across;
  double top = layout.top.offset, bottom = layout.bottom.offset, left = 1e30, right = -1e30;
  for (const int i : line)
    for (const Point& p : letters[at(i)].outline) {
      const double u = p.dot(layout.along), v = p.dot(layout.across);
      top = std::min(top, v - layout.top.slope * u);
      bottom = std::max(bottom, v - layout.bottom.slope * u);
      left = std::min(left, p.dot(leaning));
      right = std::max(right, p.dot(leaning));
    }
  top -= margin;
  bottom += margin;
  left -= margin;
  right += margin;

  const double first = bottom - top + (layout.bottom.slope - layout.top.slope) * left;
  const double last = bottom - top + (layout.bottom.slope - layout.top.slope) * right;
  if (!(std::min(first, last) > 0) || std::max(first, last) > parameters.max_taper * std::min(first, last)) return result;
  const std::array<Point, 4> corners{corner(top, layout.top.slope, left, lean), corner(top, layout.top.slope, right, lean),
                                     corner(bottom, layout.bottom.slope, right, lean),
                                     corner(bottom, layout.bottom.slope, left, lean)};
  for (std::size_t k = 0; k < 4; ++k) result.quad.corner[k] = corners[k][0] * layout.along + corners[k][1] * layout.across;
  if (!textplane::is_convex(result.quad) || !(textplane::area(result.quad) > 0)) return result;

  const double many = 1.0 - std::exp(-0.3 * static_cast<double>(line.size()));
  result.score = many * (1.0 - residual) * (1.0 - tone_spread);
  return result;
}

void suppress_overlaps(std::vector<TextQuad>& quads, const ClassicalParameters& parameters) {
  std::stable_sort(quads.begin(), quads.end(), [](const TextQuad& a, const TextQuad& b) { return a.score > b.score; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < quads.size(); ++i) {
    bool free = true;
    for (std::size_t j = 0; j < kept && free; ++j) {
      const double smaller = std::min(textplane::area(quads[i].quad), textplane::area(quads[j].quad));
      const double shared = textplane::area(textplane::intersection(quads[i].quad, quads[j].quad));
      free = shared <= parameters.max_shared_area * smaller;
    }
    if (free) quads[kept++] = quads[i];
  }
  quads.resize(kept);
}

}  // namespace textslam
