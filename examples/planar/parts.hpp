// Parts: an object cut into parts of equally many pixels, each of which is compared with an image on its own.
//
// One number for a whole object does not tell a hidden half from a poor fit. Parts do: under a right pose those that
// are seen agree and those that are hidden do not; under a wrong one hardly any agrees.
#ifndef TEXTPLANE_EXAMPLES_PARTS_HPP
#define TEXTPLANE_EXAMPLES_PARTS_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/geometry/homography.hpp"
#include "textplane/photometry/patch.hpp"
#include "textplane/photometry/photometric_input.hpp"

namespace planar {

namespace tp = textplane;

/// What the parts say about a pose.
struct Agreement {
  double share = 0;  ///< Parts that agree, of all, those out of view included.
  double score = 0;  ///< Mean ZNCC of all parts, negative ones and those out of view as 0.
};

class Parts {
 public:
  Parts() = default;
  /// Cuts the pixels of `level` into columns of equal numbers, and those into rows.
  explicit Parts(const tp::PatchLevel& level) : part_(level.x.size()) {
    const std::size_t n = level.x.size();
    side_ = std::min(std::max<std::size_t>(static_cast<std::size_t>(std::sqrt(n / kPixels)), 1), kSide);
    std::vector<std::size_t> order(n);
    for (std::size_t i = 0; i < n; ++i) order[i] = i;
    const auto sort = [&order](const std::vector<float>& by, std::size_t from, std::size_t to) {
      std::sort(order.begin() + static_cast<std::ptrdiff_t>(from), order.begin() + static_cast<std::ptrdiff_t>(to),
                [&by](std::size_t a, std::size_t b) { return by[a] < by[b] || (by[a] == by[b] && a < b); });
    };
    sort(level.x, 0, n);
    for (std::size_t c = 0; c < side_; ++c) {
      const std::size_t first = n * c / side_, count = n * (c + 1) / side_ - first;
      sort(level.y, first, first + count);
      for (std::size_t i = 0; i < count; ++i)
        part_[order[first + i]] = static_cast<std::uint8_t>(c * side_ + i * side_ / count);
    }
  }

  /// Compares under H, normalised host to target coordinates; in.patch: the pixels that were cut. A part agrees where
  /// its ZNCC is at least `agree`. `mask`, unless null, receives 1 for the pixels of those parts and 0 for others.
  Agreement compare(const tp::PhotometricInput& in, const tp::Matrix3<double>& H, double agree,
                    std::vector<std::uint8_t>* mask) const {
    const tp::Matrix3<double> P = tp::pixel_homography(H, in.host_camera, in.target_camera);
    std::array<Sums, kSide * kSide> sums{};
    for (std::size_t i = 0; i < part_.size(); ++i) {
      Sums& s = sums[part_[i]];
      ++s.all;
      tp::Vector2<double> px;
      double seen = 0;
      const double host = in.patch.intensity[i];
      if (!tp::is_ok(tp::warp(P, tp::Vector3<double>(in.patch.x[i], in.patch.y[i], 1), &px)) ||
          !tp::sample_bilinear(in.target, px[0], px[1], &seen))
        continue;
      ++s.n;
      s.a += host, s.b += seen, s.aa += host * host, s.bb += seen * seen, s.ab += host * seen;
    }
    Agreement out;
    const double count = static_cast<double>(side_ * side_);
    std::array<bool, kSide * kSide> good{};
    for (std::size_t k = 0; k < side_ * side_; ++k) {
      const double zncc = sums[k].zncc();
      good[k] = zncc >= agree;
      out.share += good[k] / count;
      out.score += std::max(zncc, 0.0) / count;
    }
    if (mask) {
      mask->resize(part_.size());
      for (std::size_t i = 0; i < part_.size(); ++i) (*mask)[i] = good[part_[i]];
    }
    return out;
  }

 private:
  static constexpr std::size_t kSide = 4, kPixels = 20;

  struct Sums {
    int all = 0, n = 0;  // pixels, and those in view
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;

    // 0 where less than half is in view or contrast is missing.
    double zncc() const noexcept {
      if (2 * n <= all) return 0;
      const double va = aa - a * a / n, vb = bb - b * b / n;
      return va > n && vb > n ? (ab - a * b / n) / std::sqrt(va * vb) : 0;
    }
  };

  std::size_t side_ = 1;
  std::vector<std::uint8_t> part_;  // of every pixel
};

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_PARTS_HPP
