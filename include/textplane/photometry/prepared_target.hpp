// PreparedTarget: a form of an 8-bit target image from which the kernels sample faster than from its rows.
//
// Every pixel lies beside the one below it, pairs(x, y) = I(x, y) | I(x, y + 1) << 8, so that the four pixels of a
// bilinear cell are one load. Preparing costs about what a copy of the image does, and pays where a frame is sampled
// often: see docs/benchmarks.md.
#ifndef TEXTPLANE_PHOTOMETRY_PREPARED_TARGET_HPP
#define TEXTPLANE_PHOTOMETRY_PREPARED_TARGET_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/core/image_view.hpp"
#include "textplane/core/status.hpp"
#include "textplane/simd/sample.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Pairs that somebody else owns; `stride` counts pairs. Empty where width is 0.
struct PairView {
  const std::uint16_t* data = nullptr;  ///< Rows of pairs.
  std::ptrdiff_t stride = 0;            ///< Pairs from a row to the next.
  int width = 0;                        ///< px, of the image they were made of.
  int height = 0;                       ///< Likewise.
};

/// Owns the pairs of one image after the other.
class PreparedTarget {
 public:
  PreparedTarget() = default;
  explicit PreparedTarget(const ImageView8& image) { prepare(image); }  ///< As prepare().

  /// Fills the pairs of `image`. invalid_argument, and none afterwards, for an image that is not valid() or that the
  /// kernels cannot read (below 2 x 2). Allocates where the image is larger than any before.
  Status prepare(const ImageView8& image) {
    width_ = height_ = 0;
    const simd::Image8 raw = {image.data(), image.stride(), image.width(), image.height()};
    if (!image.valid() || !simd::readable(raw)) return Status::invalid_argument;
    // Rows of a power of two bytes would keep falling on the same lines of a cache.
    stride_ = (static_cast<std::ptrdiff_t>(raw.width) + 31) / 32 * 32 + 32;
    const std::size_t size = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(raw.height);
    if (pairs_.size() < size) pairs_.resize(size);
    simd::prepare_pair16(raw, pairs_.data(), stride_);
    width_ = raw.width;
    height_ = raw.height;
    return Status::ok;
  }

  /// Valid until the next prepare().
  PairView view() const noexcept { return {pairs_.data(), stride_, width_, height_}; }

 private:
  std::vector<std::uint16_t> pairs_;
  std::ptrdiff_t stride_ = 0;
  int width_ = 0, height_ = 0;
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_PREPARED_TARGET_HPP
