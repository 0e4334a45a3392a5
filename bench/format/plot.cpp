#include "format/plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace textplane_bench {

namespace {

constexpr double kWidth = 720, kHeight = 400, kLeft = 70, kRight = 20, kTop = 40, kBottom = 55;
const char* const kColours[] = {"#1b6ca8", "#c8553d", "#588157", "#6d597a"};

std::string text(double x, double y, const std::string& s, const char* anchor, const char* extra = "") {
  char head[160];
  std::snprintf(head, sizeof head, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"%s>", x, y, anchor, extra);
  return head + s + "</text>\n";
}

std::string line(double x0, double y0, double x1, double y1, const char* colour) {
  char out[200];
  std::snprintf(out, sizeof out, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n", x0, y0, x1,
                y1, colour);
  return out;
}

std::string number(double v) {
  char out[32];
  std::snprintf(out, sizeof out, v >= 1000 ? "%.0f" : "%g", v);
  return out;
}

}  // namespace

std::string plot(const std::string& title, const std::string& x_label, const std::string& y_label,
                 const std::vector<Line>& lines) {
  double x_low = 1e300, x_high = 0, y_low = 1e300, y_high = 0;
  for (const Line& l : lines)
    for (const auto& [x, y] : l.points) {
      x_low = std::min(x_low, x);
      x_high = std::max(x_high, x);
      y_low = std::min(y_low, y);
      y_high = std::max(y_high, y);
    }
  if (!(x_high > x_low)) return "";
  const double left = std::floor(std::log10(x_low)), right = std::ceil(std::log10(x_high));
  const double bottom = std::floor(std::log10(y_low)), top = std::ceil(std::log10(y_high) + 1e-9);
  const auto px = [&](double x) { return kLeft + (std::log10(x) - left) / (right - left) * (kWidth - kLeft - kRight); };
  const auto py = [&](double y) {
    return kHeight - kBottom - (std::log10(y) - bottom) / (top - bottom) * (kHeight - kTop - kBottom);
  };

  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 720 400\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"720\" height=\"400\" fill=\"#ffffff\"/>\n";
  for (double e = left; e <= right; ++e) {
    const double x = px(std::pow(10, e));
    svg += line(x, kTop, x, kHeight - kBottom, "#dddddd") +
           text(x, kHeight - kBottom + 18, number(std::pow(10, e)), "middle");
  }
  for (double e = bottom; e <= top; ++e)
    for (const double m : {1.0, 2.0, 5.0}) {
      const double v = m * std::pow(10, e);
      if (std::log10(v) > top + 1e-9) continue;
      svg += line(kLeft, py(v), kWidth - kRight, py(v), "#dddddd") + text(kLeft - 6, py(v) + 4, number(v), "end");
    }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::string points;
    for (const auto& [x, y] : lines[i].points) {
      char p[48];
      std::snprintf(p, sizeof p, "%.1f,%.1f ", px(x), py(y));
      points += p;
    }
    const std::string colour = kColours[i % 4];
    svg += "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" + colour + "\" points=\"" + points + "\"/>\n";
    const double y = kTop + 16 + 18 * static_cast<double>(i);
    svg +=
        line(kWidth - 150, y - 4, kWidth - 125, y - 4, colour.c_str()) + text(kWidth - 118, y, lines[i].label, "start");
  }
  svg += text(kWidth / 2, 22, title, "middle", " font-size=\"14\"");
  svg += text(kWidth / 2, kHeight - 12, x_label, "middle");
  svg += text(16, kHeight / 2, y_label, "middle", " transform=\"rotate(-90 16 200)\"");
  return svg + "</svg>\n";
}

}  // namespace textplane_bench
