#include "renderer/texture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace textslam {

namespace {

constexpr int kMaxProbes = 12;

textplane::Image<std::uint8_t> halved(const textplane::Image<std::uint8_t>& from) {
  textplane::Image<std::uint8_t> to(std::max(1, from.width() / 2), std::max(1, from.height() / 2));
  for (int y = 0; y < to.height(); ++y) {
    const std::uint8_t* a = from.row(2 * y);
    const std::uint8_t* b = from.row(std::min(2 * y + 1, from.height() - 1));
    for (int x = 0; x < to.width(); ++x) {
      const int left = 2 * x, right = std::min(left + 1, from.width() - 1);
      to(x, y) = static_cast<std::uint8_t>((a[left] + a[right] + b[left] + b[right] + 2) >> 2);
    }
  }
  return to;
}

double bilinear(const textplane::Image<std::uint8_t>& image, double x, double y) noexcept {
  x = std::clamp(x, 0.0, static_cast<double>(image.width() - 1));
  y = std::clamp(y, 0.0, static_cast<double>(image.height() - 1));
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, image.width() - 1), y1 = std::min(y0 + 1, image.height() - 1);
  const double a = x - x0, b = y - y0;
  const std::uint8_t* top = image.row(y0);
  const std::uint8_t* bottom = image.row(y1);
  const double upper = top[x0] + a * (top[x1] - top[x0]);
  const double lower = bottom[x0] + a * (bottom[x1] - bottom[x0]);
  return upper + b * (lower - upper);
}

}  // namespace

Texture::Texture(textplane::Image<std::uint8_t> base) {
  levels_.push_back(std::move(base));
  while (levels_.back().width() > 1 || levels_.back().height() > 1) levels_.push_back(halved(levels_.back()));
}

double Texture::lookup(const textplane::Vector2<double>& p, const textplane::Vector2<double>& side_x,
                       const textplane::Vector2<double>& side_y) const noexcept {
  const double x2 = side_x.squaredNorm(), y2 = side_y.squaredNorm();
  const textplane::Vector2<double>& axis = x2 > y2 ? side_x : side_y;
  const double longer = std::sqrt(std::max(x2, y2));
  if (longer <= 1.0) return bilinear(levels_.front(), p[0], p[1]);
  const double area = std::abs(side_x[0] * side_y[1] - side_x[1] * side_y[0]);
  const double shorter = std::max(1.0, area / longer);
  const double wanted = longer / shorter - 0.25;  // rounded up; without SSE4.1 std::ceil is a call
  int probes = kMaxProbes;
  if (wanted <= kMaxProbes) probes = static_cast<int>(wanted) + (wanted > static_cast<int>(wanted) ? 1 : 0);

  // The same two levels for all probes.
  const double width = longer / probes;
  const double level = width > 1.0 ? std::min(std::log2(width), static_cast<double>(levels_.size() - 1)) : 0.0;
  const int l = static_cast<int>(level);
  const double part = level - l, scale = 1.0 / static_cast<double>(1 << l);
  const textplane::Image<std::uint8_t>& fine = levels_[static_cast<std::size_t>(l)];
  const textplane::Image<std::uint8_t>* coarse = part > 0.0 ? &levels_[static_cast<std::size_t>(l) + 1] : nullptr;
  double sum = 0.0;
  for (int i = 0; i < probes; ++i) {
    const double along = (i + 0.5) / probes - 0.5;
    const double x = p[0] + along * axis[0], y = p[1] + along * axis[1];
    const double near = bilinear(fine, (x + 0.5) * scale - 0.5, (y + 0.5) * scale - 0.5);
    if (coarse) {
      const double far = bilinear(*coarse, (x + 0.5) * 0.5 * scale - 0.5, (y + 0.5) * 0.5 * scale - 0.5);
      sum += near + part * (far - near);
    } else {
      sum += near;
    }
  }
  return sum / probes;
}

}  // namespace textslam
