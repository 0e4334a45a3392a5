#include "renderer/canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/random.hpp"

namespace textslam {

namespace {

int texels(double metres, double density) { return std::max(1, static_cast<int>(std::lround(metres * density))); }

double smooth(double a) noexcept { return a * a * (3.0 - 2.0 * a); }

// Rounded down; without SSE4.1 std::floor is a call.
std::int64_t below(double x) noexcept {
  const std::int64_t i = static_cast<std::int64_t>(x);
  return x < static_cast<double>(i) ? i - 1 : i;
}

double lattice(std::int64_t x, std::int64_t y, std::uint64_t seed) noexcept {
  return 2.0 * unit(mix(seed + static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL +
                        static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fULL)) -
         1.0;
}

// The four numbers about a place. Neighbouring texels lie in one cell, of each octave: the last ones are kept by seed.
struct Cell {
  std::int64_t i = INT64_MIN, j = INT64_MIN;
  std::uint64_t seed = 0;
  double n00 = 0, n10 = 0, n01 = 0, n11 = 0;
};

const Cell& cell_at(std::int64_t i, std::int64_t j, std::uint64_t seed) noexcept {
  thread_local std::array<Cell, 64> kept;
  Cell& cell = kept[(seed * 0x9e3779b97f4a7c15ULL) >> 58];
  if (cell.i != i || cell.j != j || cell.seed != seed)
    cell = {
        i, j, seed, lattice(i, j, seed), lattice(i + 1, j, seed), lattice(i, j + 1, seed), lattice(i + 1, j + 1, seed)};
  return cell;
}

}  // namespace

Canvas::Canvas(double width, double height, double density, double value)
    : width_(width),
      height_(height),
      pixels_(texels(width, density), texels(height, density), static_cast<float>(value)) {}

Canvas Canvas::columns(int first, int count) const {
  const textplane::Vector2<double> d = density();
  Canvas strip(count / d[0], height_, d[0]);
  strip.pixels_ = textplane::Image<float>(count, pixels_.height());
  for (int j = 0; j < pixels_.height(); ++j)
    for (int i = 0; i < count; ++i) strip.pixels_(i, j) = pixels_(first + i, j);
  return strip;
}

void Canvas::apply(const std::function<double(double, double, double)>& f) {
  const textplane::Vector2<double> d = density();
  for (int j = 0; j < pixels_.height(); ++j) {
    float* row = pixels_.row(j);
    for (int i = 0; i < pixels_.width(); ++i) {
      row[i] = static_cast<float>(f((i + 0.5) / d[0], (j + 0.5) / d[1], static_cast<double>(row[i])));
    }
  }
}

void Canvas::fill(double x0, double y0, double x1, double y1, double value, double opacity,
                  const std::function<double(double, double)>& distance) {
  const textplane::Vector2<double> d = density();
  const auto texel = [](double metres, double per_metre, int size) {
    return static_cast<int>(std::clamp(std::floor(metres * per_metre), 0.0, static_cast<double>(size)));
  };
  const int i1 = std::min(pixels_.width(), texel(x1, d[0], pixels_.width()) + 2);
  const int j1 = std::min(pixels_.height(), texel(y1, d[1], pixels_.height()) + 2);
  for (int j = std::max(0, texel(y0, d[1], pixels_.height()) - 1); j < j1; ++j) {
    float* row = pixels_.row(j);
    for (int i = std::max(0, texel(x0, d[0], pixels_.width()) - 1); i < i1; ++i) {
      const double inside = 0.5 - distance((i + 0.5) / d[0], (j + 0.5) / d[1]) * d[0];
      const double cover = opacity * std::clamp(inside, 0.0, 1.0);
      if (cover > 0.0) row[i] = static_cast<float>(row[i] + cover * (value - static_cast<double>(row[i])));
    }
  }
}

void Canvas::rectangle(double x, double y, double half_width, double half_height, double angle, double value,
                       double opacity) {
  const double c = std::cos(angle), s = std::sin(angle);
  const double rx = std::abs(c) * half_width + std::abs(s) * half_height;
  const double ry = std::abs(s) * half_width + std::abs(c) * half_height;
  fill(x - rx, y - ry, x + rx, y + ry, value, opacity, [=](double px, double py) {
    const double a = c * (px - x) + s * (py - y), b = c * (py - y) - s * (px - x);
    return std::max(std::abs(a) - half_width, std::abs(b) - half_height);
  });
}

void Canvas::ellipse(double x, double y, double radius_x, double radius_y, double angle, double value, double opacity) {
  const double c = std::cos(angle), s = std::sin(angle), r = std::max(radius_x, radius_y);
  fill(x - r, y - r, x + r, y + r, value, opacity, [=](double px, double py) {
    const double a = (c * (px - x) + s * (py - y)) / radius_x, b = (c * (py - y) - s * (px - x)) / radius_y;
    return (std::sqrt(a * a + b * b) - 1.0) * std::min(radius_x, radius_y);
  });
}

void Canvas::line(double x0, double y0, double x1, double y1, double thickness, double value, double opacity) {
  const double dx = x1 - x0, dy = y1 - y0, length2 = std::max(1e-12, dx * dx + dy * dy), r = 0.5 * thickness;
  fill(std::min(x0, x1) - r, std::min(y0, y1) - r, std::max(x0, x1) + r, std::max(y0, y1) + r, value, opacity,
       [=](double px, double py) {
         const double along = std::clamp(((px - x0) * dx + (py - y0) * dy) / length2, 0.0, 1.0);
         return std::hypot(px - x0 - along * dx, py - y0 - along * dy) - r;
       });
}

void Canvas::triangle(const textplane::Vector2<double> corner[3], double value, double opacity) {
  const textplane::Vector2<double> a = corner[0], b = corner[1], c = corner[2];
  const double area = (b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0];
  const double turn = area < 0.0 ? -1.0 : 1.0;
  const auto outside = [turn](const textplane::Vector2<double>& p, const textplane::Vector2<double>& q, double x,
                              double y) {
    const textplane::Vector2<double> e = q - p;
    return turn * (e[1] * (x - p[0]) - e[0] * (y - p[1])) / std::max(1e-9, e.norm());
  };
  const auto extremes = [](double p, double q, double r) { return std::minmax({p, q, r}); };
  const auto [x0, x1] = extremes(a[0], b[0], c[0]);
  const auto [y0, y1] = extremes(a[1], b[1], c[1]);
  fill(x0, y0, x1, y1, value, opacity, [=](double x, double y) {
    return std::max({outside(a, b, x, y), outside(b, c, x, y), outside(c, a, x, y)});
  });
}

double value_noise(double x, double y, std::uint64_t seed) noexcept {
  const std::int64_t i = below(x), j = below(y);
  const double a = smooth(x - static_cast<double>(i)), b = smooth(y - static_cast<double>(j));
  const Cell& cell = cell_at(i, j, seed);
  const double top = cell.n00 + a * (cell.n10 - cell.n00), bottom = cell.n01 + a * (cell.n11 - cell.n01);
  return top + b * (bottom - top);
}

double fractal_noise(double x, double y, std::uint64_t seed, int octaves, double gain) noexcept {
  double sum = 0.0, strength = 1.0, total = 0.0;
  for (int k = 0; k < octaves; ++k) {
    sum += strength * value_noise(x, y, seed + static_cast<std::uint64_t>(k) * 7919);
    total += strength;
    strength *= gain;
    x = 2.0 * x + 17.3;
    y = 2.0 * y + 5.9;
  }
  return sum / total * 1.5;
}

}  // namespace textslam
