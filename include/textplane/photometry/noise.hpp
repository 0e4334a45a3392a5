// Noise: how much of it an image has, and what ZNCC two noisy views of the same thing can have.
//
// A limit of the ZNCC that suits clear images keeps out what is seen well enough in a dark room: noise alone lowers the
// correlation of two views that agree. How far follows from the noise and from the contrast.
#ifndef TEXTPLANE_PHOTOMETRY_NOISE_HPP
#define TEXTPLANE_PHOTOMETRY_NOISE_HPP

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// How estimate_noise() looks at an image.
struct NoiseOptions {
  int block = 32;         ///< px: side of the blocks, in [8, kMaxBlock].
  double quantile = 0.2;  ///< Of the blocks' estimates, that counts: texture raises the others. In (0, 1).
  double clipped = 0.06;  ///< Share of black and white pixels above which a block does not count, in [0, 1].
  static constexpr int kMaxBlock = 64;  ///< px, of the largest block.

  /// Whether the numbers make sense.
  bool valid() const noexcept {
    return block >= 8 && block <= kMaxBlock && quantile > 0 && quantile < 1 && clipped >= 0 && clipped <= 1;
  }
};

/// What estimate_noise() found.
struct NoiseEstimate {
  double sigma = 0.0;                        ///< Standard deviation of a pixel's noise, grey levels.
  int blocks = 0;                            ///< How many blocks counted.
  Status status = Status::invalid_argument;  ///< Whether sigma means something.
};

namespace detail {

// Of a square block whose neighbours of one pixel are in the image: sum of the absolute values of the high-pass
// [1 -2 1] x [1 -2 1], and how many pixels are black or white.
struct HighPass {
  std::int32_t sum = 0, clipped = 0;
};

inline HighPass high_pass(const ImageView8& image, int x0, int y0, int side) noexcept {
  HighPass out;
  std::int32_t column[NoiseOptions::kMaxBlock + 2];
  for (int y = y0; y < y0 + side; ++y) {
    const std::uint8_t *above = image.row(y - 1) + x0 - 1, *row = image.row(y) + x0 - 1,
                       *below = image.row(y + 1) + x0 - 1;
    for (int i = 0; i < side + 2; ++i) column[i] = above[i] - 2 * row[i] + below[i];
    for (int i = 1; i <= side; ++i) {
      out.sum += std::abs(column[i - 1] - 2 * column[i] + column[i + 1]);
      out.clipped += row[i] == 0 || row[i] == 255 ? 1 : 0;
    }
  }
  return out;
}

}  // namespace detail

/// The noise of an image, where it is white: neighbouring pixels err independently. What a camera or a codec has
/// smoothed shows less of it.
///
/// In each block sigma = sqrt(pi / 2) mean |h| / 6 with the high-pass h = [1 -2 1] x [1 -2 1], whose variance is 36
/// times the noise's (Immerkaer, "Fast noise variance estimation", CVIU 1996); a low quantile over the blocks leaves
/// texture out. White noise is estimated up to 5 % too low by it. Blocks that are cut off at black or white do not
/// count; too_few, with sigma 0, where that leaves none. invalid_argument for an invalid view or options. No
/// allocation.
template <class S = double>  // instantiated where it is called: including the header costs little
NoiseEstimate estimate_noise(const ImageView8& image, const NoiseOptions& options = {}) noexcept {
  NoiseEstimate out;
  if (!image.valid() || !options.valid()) return out;
  // A histogram of the blocks' sigmas; the last bin has all that are larger.
  constexpr int kBins = 2048;
  constexpr S kBin = 1.0 / 16;         // grey levels
  constexpr S kScale = 0.20888568955;  // sqrt(pi / 2) / 6
  int bins[kBins] = {};
  const int side = options.block;
  const S pixels = static_cast<S>(side) * side;
  for (int y = 1; y < image.height() - side; y += side)
    for (int x = 1; x < image.width() - side; x += side) {
      const detail::HighPass block = detail::high_pass(image, x, y, side);
      if (block.clipped > options.clipped * pixels) continue;
      const int bin = static_cast<int>(kScale * block.sum / pixels / kBin);
      ++bins[bin < kBins ? bin : kBins - 1];
      ++out.blocks;
    }
  out.status = out.blocks > 0 ? Status::ok : Status::too_few;
  const S wanted = options.quantile * out.blocks;
  int below = 0;
  for (int i = 0; i < kBins && out.blocks > 0; ++i) {
    if (below + bins[i] < wanted) {
      below += bins[i];
      continue;
    }
    out.sigma = kBin * (i + (wanted - below) / bins[i]);
    break;
  }
  return out;
}

/// The ZNCC to expect of two views of the same thing: with contrasts c (standard deviations of the intensities, noise
/// included) and standard deviations n of their noise, independent of each other and of the intensities,
///
///     sqrt((1 - n_a^2 / c_a^2) (1 - n_b^2 / c_b^2))
///
/// (Spearman, "The proof and measurement of association between two things", 1904). In [0, 1]; 0 where either contrast
/// is noise alone, or an argument is not a number.
inline double expected_zncc(double contrast_a, double noise_a, double contrast_b, double noise_b) noexcept {
  const auto reliability = [](double contrast, double noise) {
    if (!(contrast > 0)) return 0.0;
    const double share = noise / contrast;
    return share * share < 1 ? 1 - share * share : 0.0;
  };
  return std::sqrt(reliability(contrast_a, noise_a) * reliability(contrast_b, noise_b));
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_NOISE_HPP
