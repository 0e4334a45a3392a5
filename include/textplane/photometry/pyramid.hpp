// Pyramid: an image and its repeated halves.
//
// Pixel x of level l lies at (x + 0.5) * 2^l - 0.5 of level 0: each level is the mean of 2 x 2 pixels of the one
// before, so its pixel centres are the centres of those blocks. Pinhole::at_level() gives the camera that fits.
#ifndef TEXTPLANE_PHOTOMETRY_PYRAMID_HPP
#define TEXTPLANE_PHOTOMETRY_PYRAMID_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "textplane/core/image_view.hpp"
#include "textplane/core/status.hpp"
#include "textplane/simd/halve.hpp"

TEXTPLANE_BEGIN_NAMESPACE

constexpr int kMaxPyramidLevels = 8;  ///< Levels at most, the finest included.

/// The levels of a pyramid that somebody else owns, finest first. Levels from `levels` on are empty views.
struct PyramidView {
  std::array<ImageView8, kMaxPyramidLevels> level;  ///< Finest first; each half the size of the one before.
  int levels = 0;                                   ///< How many of them there are.
};

/// dst(x, y) = (a + b + c + d + 2) / 4, rounded down, over the 2 x 2 block of src that begins at (2 x, 2 y). An odd
/// last row or column of src is dropped.
///
/// dst must be (src.width() / 2) x (src.height() / 2) and must not overlap src; otherwise, or where one of the views is
/// not valid(), Status::invalid_argument and nothing is written.
inline Status halve(const ImageView8& src, const ImageView<std::uint8_t>& dst) noexcept {
  if (!src.valid() || !dst.valid() || dst.width() != src.width() / 2 || dst.height() != src.height() / 2)
    return Status::invalid_argument;
  simd::halve({src.data(), src.stride(), dst.data(), dst.stride(), dst.width(), dst.height()});
  return Status::ok;
}

/// A pyramid that owns all its levels, level 0 being a copy of the image: the source may go after build().
class Pyramid {
 public:
  Pyramid() = default;
  /// As build(); a pyramid of an invalid image has no levels.
  explicit Pyramid(const ImageView8& image, int levels = 4) { build(image, levels); }

  /// Fills the pyramid anew. Allocates only where the memory of the last build is too small. Fewer than `levels` levels
  /// result where the next one would be empty; levels() tells. Status::invalid_argument for an image that is not
  /// valid() or `levels` outside [1, kMaxPyramidLevels]: the pyramid then has no levels.
  Status build(const ImageView8& image, int levels) {
    count_ = 0;
    if (!image.valid() || levels < 1 || levels > kMaxPyramidLevels) return Status::invalid_argument;
    std::size_t total = 0;
    int width = image.width(), height = image.height(), count = 0;
    for (; count < levels && width > 0 && height > 0; ++count, width /= 2, height /= 2) {
      const auto l = static_cast<std::size_t>(count);
      offset_[l] = total;
      width_[l] = width;
      height_[l] = height;
      total += static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    if (pixels_.size() < total) pixels_.resize(total);

    for (int y = 0; y < image.height(); ++y)
      std::memcpy(pixels_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()), image.row(y),
                  static_cast<std::size_t>(image.width()));
    for (int l = 1; l < count; ++l) {
      const auto i = static_cast<std::size_t>(l);
      halve(ImageView8(pixels_.data() + offset_[i - 1], width_[i - 1], height_[i - 1]),
            ImageView<std::uint8_t>(pixels_.data() + offset_[i], width_[i], height_[i]));
    }
    count_ = count;
    return Status::ok;
  }

  int levels() const noexcept { return count_; }  ///< How many levels it has; 0 before it is built.

  /// Level l, an empty view for l outside [0, levels()). It lives as long as the pyramid is neither built anew nor
  /// moved.
  ImageView8 level(int l) const noexcept {
    if (l < 0 || l >= count_) return {};
    const auto i = static_cast<std::size_t>(l);
    return {pixels_.data() + offset_[i], width_[i], height_[i]};
  }

  /// All levels; they live as long as those of level().
  PyramidView view() const noexcept {
    PyramidView v;
    for (int l = 0; l < count_; ++l) v.level[static_cast<std::size_t>(l)] = level(l);
    v.levels = count_;
    return v;
  }
  /// As view().
  operator PyramidView() const noexcept { return view(); }

 private:
  std::vector<std::uint8_t> pixels_;
  std::array<std::size_t, kMaxPyramidLevels> offset_{};
  std::array<int, kMaxPyramidLevels> width_{}, height_{};
  int count_ = 0;
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_PYRAMID_HPP
