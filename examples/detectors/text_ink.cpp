#include "detectors/text_ink.hpp"

#include <algorithm>
#include <cstddef>

namespace textslam {
namespace {

void add_row(const std::uint8_t* row, int width, std::uint32_t sign, InkScratch& scratch) {
  std::uint32_t* sum = scratch.column.data();
  std::uint32_t* squares = scratch.column_squares.data();
  for (int x = 0; x < width; ++x) {
    const std::uint32_t v = row[x];
    sum[x] += sign * v;
    squares[x] += sign * v * v;
  }
}

}  // namespace

void mark_ink(const ImageView8& image, const ClassicalParameters& parameters, InkScratch& scratch,
              Image<std::uint8_t>& out) {
  const int width = image.width(), height = image.height(), radius = parameters.window_radius;
  const auto columns = static_cast<std::size_t>(width);
  if (out.width() != width || out.height() != height) out.resize(width, height);
  scratch.column.assign(columns, 0);
  scratch.column_squares.assign(columns, 0);
  scratch.prefix.assign(columns + 1, 0);
  scratch.prefix_squares.assign(columns + 1, 0);
  const float sigmas2 = static_cast<float>(parameters.ink_sigmas * parameters.ink_sigmas);
  const float floor = static_cast<float>(parameters.ink_floor);

  for (int y = 0; y < std::min(radius, height); ++y) add_row(image.row(y), width, 1u, scratch);
  for (int y = 0; y < height; ++y) {
    if (y + radius < height) add_row(image.row(y + radius), width, 1u, scratch);
    if (y - radius - 1 >= 0) add_row(image.row(y - radius - 1), width, ~0u, scratch);
    // Unsigned sums may wrap in very wide images; the difference of two of them is right all the same.
    std::uint32_t* prefix = scratch.prefix.data();
    std::uint32_t* squares = scratch.prefix_squares.data();
    for (std::size_t x = 0; x < columns; ++x) {
      prefix[x + 1] = prefix[x] + scratch.column[x];
      squares[x + 1] = squares[x] + scratch.column_squares[x];
    }
    const int rows = std::min(y + radius, height - 1) - std::max(y - radius, 0) + 1;
    const std::uint8_t* in = image.row(y);
    std::uint8_t* mark = out.row(y);
    for (int x = 0; x < width; ++x) {
      const int left = std::max(x - radius, 0), right = std::min(x + radius, width - 1) + 1;
      const float n = static_cast<float>(rows * (right - left));
      const float mean = static_cast<float>(prefix[right] - prefix[left]) / n;
      const float variance = static_cast<float>(squares[right] - squares[left]) / n - mean * mean;
      const float difference = static_cast<float>(in[x]) - mean;
      const bool ink = difference * difference > sigmas2 * variance && (difference > floor || difference < -floor);
      mark[x] = !ink ? kPaper : difference < 0 ? kDarkInk : kLightInk;
    }
  }
}

}  // namespace textslam
