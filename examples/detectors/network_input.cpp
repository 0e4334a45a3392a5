#include "detectors/network_input.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace textslam {
namespace {

constexpr int kStep = 32;  // px

int in_steps(double side) { return kStep * std::max(1, static_cast<int>(std::lround(side / kStep))); }

/// Where the pixels of one axis of the input come from: between `low` and `high`, `share` of the way.
struct Tap {
  int low, high;
  float share;
};

std::vector<Tap> taps(int from, int to) {
  std::vector<Tap> out;
  for (int i = 0; i < to; ++i) {
    const double at = std::clamp((i + 0.5) * from / to - 0.5, 0.0, from - 1.0);
    const int low = static_cast<int>(at);
    out.push_back({low, std::min(low + 1, from - 1), static_cast<float>(at - low)});
  }
  return out;
}

}  // namespace

const NetworkColours kDbColours{
    false,
    {{{1 / (255 * 0.229), -0.485 / 0.229}, {1 / (255 * 0.224), -0.456 / 0.224}, {1 / (255 * 0.225), -0.406 / 0.225}}}};
const NetworkColours kEastColours{true, {{{1, -123.68}, {1, -116.78}, {1, -103.94}}}};

NetworkSize network_size(int width, int height, int long_side) {
  const double scale = static_cast<double>(long_side) / std::max(width, height);
  return {in_steps(scale * width), in_steps(scale * height)};
}

void network_input(const ColourView& image, const NetworkColours& colours, const NetworkSize& size, float* out) {
  const std::vector<Tap> columns = taps(image.width, size.width), rows = taps(image.height, size.height);
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(image.width) * image.bytes;
  for (int c = 0; c < 3; ++c) {
    const NetworkColours::Channel& channel = colours.channels[static_cast<std::size_t>(c)];
    const auto scale = static_cast<float>(channel.scale), shift = static_cast<float>(channel.shift);
    const std::uint8_t* plane = image.data + (image.red_first == colours.red_first ? c : 2 - c);
    for (const Tap& row : rows) {
      const std::uint8_t *above = plane + row.low * stride, *below = plane + row.high * stride;
      const auto down = [&](int x) {
        const float a = above[x * image.bytes], b = below[x * image.bytes];
        return a + row.share * (b - a);
      };
      for (const Tap& column : columns) {
        const float left = down(column.low), right = down(column.high);
        *out++ = scale * (left + column.share * (right - left)) + shift;
      }
    }
  }
}

void to_image(const NetworkSize& size, int width, int height, Quad<double>* quad) {
  const Vector2<double> step(static_cast<double>(width) / size.width, static_cast<double>(height) / size.height);
  for (Vector2<double>& corner : quad->corner) corner = (corner.array() + 0.5) * step.array() - 0.5;
}

}  // namespace textslam
