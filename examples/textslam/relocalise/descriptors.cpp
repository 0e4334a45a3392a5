#include "textslam/relocalise/descriptors.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/geometry/quad.hpp"

namespace textslam {
namespace {

constexpr int kRadius = 13;        // of the pattern
constexpr int kMomentRadius = 15;  // of the disc whose centroid gives the direction

struct Pattern {
  std::array<float, 2 * kDescriptorBits> x, y;
};

// Places around the centre, denser in the middle: sums of three even draws. The generator is seeded by a constant, so
// that the pattern is the same for ever.
Pattern draw_pattern() {
  std::uint32_t state = 2463534242U;
  const auto draw = [&state] {
    state = state * 1664525U + 1013904223U;
    return static_cast<float>(state >> 8) / 16777216.0F;
  };
  const auto spread = [&draw] {
    const float sum = draw() + draw() + draw();
    return (2 * sum - 3) / 3 * static_cast<float>(kRadius);
  };
  Pattern pattern;
  for (std::size_t i = 0; i < pattern.x.size();) {
    pattern.x[i] = spread();
    pattern.y[i] = spread();
    const bool inside = std::hypot(pattern.x[i], pattern.y[i]) <= static_cast<float>(kRadius);
    const bool apart = i % 2 == 0 || std::hypot(pattern.x[i] - pattern.x[i - 1], pattern.y[i] - pattern.y[i - 1]) > 2;
    i += inside && apart ? 1 : 0;
  }
  return pattern;
}

const Pattern& pattern() {
  static const Pattern drawn = draw_pattern();
  return drawn;
}

// Binomial of five taps, twice along each axis: first the columns of a row's neighbourhood, then the row.
textplane::Image<std::uint8_t> smoothed(const textplane::ImageView8& image) {
  const int width = image.width(), height = image.height();
  textplane::Image<std::uint8_t> out(width, height);
  std::vector<int> column(static_cast<std::size_t>(width) + 4);
  for (int y = 0; y < height; ++y) {
    const auto row = [&](int dy) { return image.row(std::clamp(y + dy, 0, height - 1)); };
    const std::uint8_t *a = row(-2), *b = row(-1), *c = row(0), *d = row(1), *e = row(2);
    int* const sum = column.data() + 2;
    for (int x = 0; x < width; ++x) sum[x] = a[x] + e[x] + 4 * (b[x] + d[x]) + 6 * c[x];
    sum[-2] = sum[-1] = sum[0];
    sum[width] = sum[width + 1] = sum[width - 1];
    for (int x = 0; x < width; ++x)
      out(x, y) =
          static_cast<std::uint8_t>((sum[x - 2] + sum[x + 2] + 4 * (sum[x - 1] + sum[x + 1]) + 6 * sum[x] + 128) / 256);
  }
  return out;
}

// Direction to the centroid of the brightness in a disc.
Vec2f direction(const textplane::ImageView8& image, int x, int y, int radius) {
  float mx = 0, my = 0;
  for (int dy = -radius; dy <= radius; ++dy) {
    const int half = static_cast<int>(std::sqrt(static_cast<float>(radius * radius - dy * dy)));
    const std::uint8_t* const row = image.row(y + dy) + x;
    int sum = 0, moment = 0;
    for (int dx = -half; dx <= half; ++dx) {
      sum += row[dx];
      moment += dx * row[dx];
    }
    mx += static_cast<float>(moment);
    my += static_cast<float>(dy * sum);
  }
  const float norm = std::hypot(mx, my);
  return norm > 0 ? Vec2f(mx / norm, my / norm) : Vec2f(1, 0);
}

// Bits set, in each byte.
std::uint64_t bits_of_bytes(std::uint64_t v) {
  v -= (v >> 1) & 0x5555555555555555U;
  v = (v & 0x3333333333333333U) + ((v >> 2) & 0x3333333333333333U);
  return (v + (v >> 4)) & 0x0F0F0F0F0F0F0F0FU;
}

}  // namespace

int bits_apart(const Descriptor& a, const Descriptor& b) {
  const std::uint64_t low = bits_of_bytes(a.bits[0] ^ b.bits[0]) + bits_of_bytes(a.bits[1] ^ b.bits[1]);
  const std::uint64_t high = bits_of_bytes(a.bits[2] ^ b.bits[2]) + bits_of_bytes(a.bits[3] ^ b.bits[3]);
  // Sums of bytes: at most 32 each, and 256 in all, so that the last sum takes 16 bits.
  const std::uint64_t sum = low + high;
  const std::uint64_t pairs = (sum & 0x00FF00FF00FF00FFU) + ((sum >> 8) & 0x00FF00FF00FF00FFU);
  return static_cast<int>((pairs * 0x0001000100010001U) >> 48);
}

SmoothedLevels::SmoothedLevels(const Pyramid& image, int levels) {
  for (int l = 0; l < std::min(levels, image.levels()); ++l) levels_.push_back(smoothed(image.level(l)));
}

bool SmoothedLevels::describe(const Vec2f& px, double size, Descriptor* out) const {
  constexpr double kAlmost = 1e-6;
  const int level = static_cast<int>(std::log2(size) + kAlmost);
  if (!(size >= 1) || level >= levels()) return false;
  const auto& image = levels_[static_cast<std::size_t>(level)];
  const Vec2f at = textplane::point_to_level(px, level);
  const auto stretch = static_cast<float>(std::ldexp(size, -level));
  const int radius = static_cast<int>(std::ceil(static_cast<float>(kMomentRadius) * stretch));
  // Written so that NaN is outside.
  const auto reach = static_cast<float>(radius + 1);
  if (!(at.x() >= reach && at.y() >= reach && at.x() < static_cast<float>(image.width()) - reach &&
        at.y() < static_cast<float>(image.height()) - reach))
    return false;
  const int x = static_cast<int>(std::lround(at.x())), y = static_cast<int>(std::lround(at.y()));
  const textplane::ImageView8 view = image.view();
  const Vec2f towards = direction(view, x, y, radius), turned = stretch * towards;
  const Pattern& places = pattern();
  std::array<std::uint8_t, 2 * kDescriptorBits> values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float u = turned.x() * places.x[i] - turned.y() * places.y[i];
    const float v = turned.y() * places.x[i] + turned.x() * places.y[i];
    // Rounded by hand: all arguments are above -1000.
    const int dx = static_cast<int>(u + 1000.5F) - 1000, dy = static_cast<int>(v + 1000.5F) - 1000;
    values[i] = view.row(y + dy)[x + dx];
  }
  *out = {{}, std::atan2(towards.y(), towards.x())};
  for (std::size_t i = 0; i < kDescriptorBits; ++i)
    out->bits[i / 64] |= static_cast<std::uint64_t>(values[2 * i] < values[2 * i + 1]) << (i % 64);
  return true;
}

}  // namespace textslam
