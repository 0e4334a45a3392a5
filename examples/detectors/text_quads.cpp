#include "detectors/text_quads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "textslam/common/algorithms.hpp"
#include "textslam/common/geometry.hpp"

namespace textslam {
namespace {

using Point = Vector2<double>;

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
  rule.offset = median(rest);
  for (double& r : rest) r = std::abs(r - rule.offset);
  rule.residual = median(rest);
}

/// Median slope of the pairs that are far apart (Theil and Sen): ascenders and descenders do not bend it.
Rule fit_rule(const std::vector<Point>& points, double min_distance) {
  const double reach = points.back()[0] - points.front()[0];
  std::vector<double> slopes;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j)
      if (points[j][0] - points[i][0] >= min_distance * reach && points[j][0] > points[i][0])
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

Layout lay_out(const std::vector<Letter>& letters, const std::vector<int>& line, const Point& along,
               const ClassicalParameters& parameters) {
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
  layout.top = fit_rule(tops, parameters.slope_distance);
  layout.bottom = fit_rule(bottoms, parameters.slope_distance);
  // Where one side is ragged (small letters among capitals), it runs along the other.
  const double ragged = parameters.ragged * layout.height;
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
double lean_of(const std::vector<Letter>& letters, const std::vector<int>& line, const Layout& layout,
               const ClassicalParameters& parameters) {
  double best = 0, narrowest = 0;
  for (int step = 0; step <= parameters.lean_steps; ++step) {
    const double lean = parameters.lean_step * (step % 2 == 0 ? step / 2 : -(step + 1) / 2);  // from upright outwards
    const Point axis = layout.along - lean * layout.across;
    double sum = 0;
    for (const int i : line) sum += extent(letters[at(i)], axis).length();
    sum *= 1.0 + parameters.lean_penalty * lean * lean;
    if (step == 0 || sum < narrowest) {
      narrowest = sum;
      best = lean;
    }
  }
  return best;
}

/// Mere bars, or all the same: books, railings, windows, tiles.
bool is_pattern(const Layout& layout, const ClassicalParameters& parameters) {
  std::vector<double> widths, fills;
  int bars = 0;
  for (const Box& box : layout.boxes) {
    widths.push_back(box.u.length() / box.v.length());
    fills.push_back(box.fill);
    bars += box.fill > parameters.bar_fill ? 1 : 0;
  }
  return bars > parameters.max_bars * static_cast<double>(layout.boxes.size()) ||
         std::max(deviation(widths), deviation(fills)) < parameters.min_variety;
}

/// Standard deviation of the letters' inks or papers (the larger one), over the contrast.
double tone_spread(const std::vector<Letter>& letters, const std::vector<int>& line) {
  std::vector<double> inks, papers, contrasts;
  for (const int i : line) {
    inks.push_back(letters[at(i)].ink);
    papers.push_back(letters[at(i)].paper);
    contrasts.push_back(letters[at(i)].contrast());
  }
  return std::max(deviation(inks), deviation(papers)) / median(contrasts);
}

/// The ink in a quad's shape, all sides in the line's frame: v from top to bottom, u - lean v from left to right.
struct LineFrame {
  double top, bottom, left, right, lean;

  double height_at(double u, const Layout& layout) const {
    return bottom - top + (layout.bottom.slope - layout.top.slope) * u;
  }
};

/// The closest frame around the letters whose sides have the directions given.
LineFrame enclose(const std::vector<Letter>& letters, const std::vector<int>& line, const Layout& layout, double lean) {
  LineFrame frame{layout.top.offset, layout.bottom.offset, 0, 0, lean};
  frame.left = std::numeric_limits<double>::infinity();
  frame.right = -frame.left;
  const Point leaning = layout.along - lean * layout.across;
  for (const int i : line)
    for (const Point& p : letters[at(i)].outline) {
      const double u = p.dot(layout.along), v = p.dot(layout.across);
      frame.top = std::min(frame.top, v - layout.top.slope * u);
      frame.bottom = std::max(frame.bottom, v - layout.bottom.slope * u);
      frame.left = std::min(frame.left, p.dot(leaning));
      frame.right = std::max(frame.right, p.dot(leaning));
    }
  return frame;
}

/// Gaps, overlaps, ink and heights are those of print.
bool is_filled_like_text(const std::vector<Letter>& letters, const std::vector<int>& line, const Layout& layout,
                         const LineFrame& frame, const ClassicalParameters& parameters) {
  double ink = 0, covered = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    ink += letters[at(line[i])].area;
    covered += layout.boxes[i].u.length();
  }
  const double width = frame.right - frame.left;
  const double height = frame.height_at(0.5 * (frame.left + frame.right), layout);
  const double cover = covered / width, share = ink / (width * height);
  return layout.height >= parameters.min_height && height <= parameters.max_quad_height * layout.height &&
         cover >= parameters.min_cover && cover <= parameters.max_cover &&  //
         share >= parameters.min_ink && share <= parameters.max_ink;
}

/// In [0, 1]: many letters of equal height on common lines, upright and in even tones, make it 1.
double score_of(const Layout& layout, double residual, double taper, double lean, double spread,
                const ClassicalParameters& parameters) {
  std::vector<double> heights;
  for (const Box& box : layout.boxes) heights.push_back(box.v.length() / layout.height);
  const double letters = static_cast<double>(layout.boxes.size());
  return (1.0 - std::exp(-parameters.score_letters * letters)) * std::max(0.0, 1.0 - parameters.score_tones * spread) *
         std::max(0.0, 1.0 + parameters.score_taper - parameters.score_taper * taper) * (1.0 - lean * lean) *
         std::max(0.0, 1.0 - deviation(heights)) * std::max(0.0, 1.0 - parameters.score_residual * residual);
}

/// Where a rule meets the side u = side + lean v.
Point corner(const Rule& rule, double side, double lean) {
  const double v = (rule.offset + rule.slope * side) / (1.0 - rule.slope * lean);
  return {side + lean * v, v};
}

}  // namespace

TextQuad fit_quad(const std::vector<Letter>& letters, const std::vector<int>& line,
                  const ClassicalParameters& parameters) {
  TextQuad result;
  if (line.size() < 2) return result;
  Point along = letters[at(line.back())].centre - letters[at(line.front())].centre;
  along.normalize();
  Layout layout = lay_out(letters, line, along, parameters);
  // Once more along the text's own lines: extents across a tilted frame are blurred by the letters' widths.
  const double slope = layout.top.residual < layout.bottom.residual ? layout.top.slope : layout.bottom.slope;
  layout = lay_out(letters, line, Point(layout.along + slope * layout.across).normalized(), parameters);

  if (std::abs(std::atan2(layout.along[1], layout.along[0])) >
      radians(parameters.max_angle + parameters.angle_tolerance))
    return result;
  const double residual = std::min(layout.top.residual, layout.bottom.residual) / layout.height;
  if (residual > parameters.max_residual || is_pattern(layout, parameters)) return result;
  const double spread = tone_spread(letters, line);
  if (spread > parameters.max_line_tone_spread) return result;
  const double lean = lean_of(letters, line, layout, parameters);
  if (std::abs(lean) > parameters.max_lean) return result;

  LineFrame frame = enclose(letters, line, layout, lean);
  const double first = frame.height_at(frame.left, layout), last = frame.height_at(frame.right, layout);
  if (!(std::min(first, last) > 0)) return result;
  const double taper = std::max(first, last) / std::min(first, last);
  if (taper > parameters.max_taper || !is_filled_like_text(letters, line, layout, frame, parameters)) return result;

  const double margin = parameters.margin * layout.height;
  frame = {frame.top - margin, frame.bottom + margin, frame.left - margin, frame.right + margin, lean};
  const Rule upper{layout.top.slope, frame.top, 0}, lower{layout.bottom.slope, frame.bottom, 0};
  const std::array<Point, 4> corners{corner(upper, frame.left, lean), corner(upper, frame.right, lean),
                                     corner(lower, frame.right, lean), corner(lower, frame.left, lean)};
  for (std::size_t k = 0; k < 4; ++k)
    result.quad.corner[k] = corners[k][0] * layout.along + corners[k][1] * layout.across;
  if (!textplane::is_convex(result.quad) || !(textplane::area(result.quad) > 0)) return result;
  const double score = score_of(layout, residual, taper, lean, spread, parameters);
  result.score = score >= parameters.min_score ? score : 0.0;
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
