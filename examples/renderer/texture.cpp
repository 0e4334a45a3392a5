#include "renderer/texture.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace textslam {

namespace {

constexpr int kMaxProbes = 12;

/// Where so many probes lie along a side of length 1 about 0.
struct Places {
  constexpr Places() {
    for (int n = 1; n <= kMaxProbes; ++n)
      for (int i = 0; i < n; ++i) along[n - 1][i] = (i + 0.5) / n - 0.5;
  }
  double along[kMaxProbes][kMaxProbes]{};
};
constexpr Places kPlaces;

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

std::vector<textplane::Image<std::uint8_t>> mip_levels(textplane::Image<std::uint8_t> base) {
  std::vector<textplane::Image<std::uint8_t>> levels;
  levels.push_back(std::move(base));
  while (levels.back().width() > 1 || levels.back().height() > 1) levels.push_back(halved(levels.back()));
  return levels;
}

/// A level for many lookups: what they share is computed once.
class Level {
 public:
  Level(const textplane::Image<std::uint8_t>& image, double scale) noexcept
      : first_(image.row(0)),
        stride_(image.height() > 1 ? image.row(1) - image.row(0) : 0),
        last_x_(image.width() - 1),
        last_y_(image.height() - 1),
        scale_(scale) {}

  /// Bilinear, at a position in texels of the first level.
  double at(double x, double y) const noexcept { return at_texel((x + 0.5) * scale_ - 0.5, (y + 0.5) * scale_ - 0.5); }

  double at_texel(double x, double y) const noexcept {
    const double most_x = last_x_, most_y = last_y_;
    int right = 1;
    std::ptrdiff_t down = stride_;
    if (!(x >= 0.0 && y >= 0.0 && x < most_x && y < most_y)) {  // at an edge
      x = std::clamp(x, 0.0, most_x);
      y = std::clamp(y, 0.0, most_y);
      if (x >= most_x) right = 0;
      if (y >= most_y) down = 0;
    }
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const double a = x - x0, b = y - y0;
    const std::uint8_t* top = first_ + y0 * stride_ + x0;
    const std::uint8_t* bottom = top + down;
    const double upper = top[0] + a * (top[right] - top[0]);
    const double lower = bottom[0] + a * (bottom[right] - bottom[0]);
    return upper + b * (lower - upper);
  }

 private:
  const std::uint8_t* first_;
  std::ptrdiff_t stride_;
  int last_x_, last_y_;
  double scale_;
};

}  // namespace

Texture::Texture(textplane::Image<std::uint8_t> base) : levels_(mip_levels(std::move(base))) { painted_ = true; }

Texture::Texture(std::function<textplane::Image<std::uint8_t>()> paint) : painter_(std::move(paint)) {}

void Texture::paint() const {
  std::call_once(once_, [this] {
    levels_ = mip_levels(painter_());
    painted_.store(true, std::memory_order_release);
  });
}

double Texture::lookup(const textplane::Vector2<double>& p, const textplane::Vector2<double>& side_x,
                       const textplane::Vector2<double>& side_y) const noexcept {
  const double x2 = side_x.squaredNorm(), y2 = side_y.squaredNorm();
  const textplane::Vector2<double>& axis = x2 > y2 ? side_x : side_y;
  const double longer = std::sqrt(std::max(x2, y2));
  if (longer <= 1.0) return Level(levels_.front(), 1.0).at_texel(p[0], p[1]);
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
  const Level fine(levels_[static_cast<std::size_t>(l)], scale);
  const Level coarse(levels_[std::min(static_cast<std::size_t>(l) + 1, levels_.size() - 1)], 0.5 * scale);
  const double* along = kPlaces.along[probes - 1];
  double sum = 0.0;
  for (int i = 0; i < probes; ++i) {
    const double x = p[0] + along[i] * axis[0], y = p[1] + along[i] * axis[1];
    const double near = fine.at(x, y);
    sum += part > 0.0 ? near + part * (coarse.at(x, y) - near) : near;
  }
  return sum / probes;
}

}  // namespace textslam
