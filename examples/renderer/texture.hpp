// Texture: an 8-bit image with its mip levels, and the filtered lookup under a footprint that may be long and thin. It
// may be painted when it is first seen: much of a scene never is.
#ifndef TEXTSLAM_RENDERER_TEXTURE_HPP
#define TEXTSLAM_RENDERER_TEXTURE_HPP

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"

namespace textslam {

class Texture {
 public:
  explicit Texture(textplane::Image<std::uint8_t> base);
  explicit Texture(std::function<textplane::Image<std::uint8_t>()> paint);

  /// Paints it, the first time; from any number of threads. Before all else.
  void be_seen() const {
    if (!painted_.load(std::memory_order_acquire)) paint();
  }

  int width() const noexcept { return levels_.front().width(); }
  int height() const noexcept { return levels_.front().height(); }

  /// Intensity at the texel position `p` (centre of the first texel at (0, 0), clamped at the edges), averaged over the
  /// parallelogram of the two footprint sides (texels): trilinear probes along the longer side, each as wide as the
  /// shorter. Where the footprint is no larger than a texel this is plain bilinear interpolation, in double, so that a
  /// linear ramp comes back exactly.
  double lookup(const textplane::Vector2<double>& p, const textplane::Vector2<double>& side_x,
                const textplane::Vector2<double>& side_y) const noexcept;

 private:
  void paint() const;

  std::function<textplane::Image<std::uint8_t>()> painter_;
  mutable std::atomic<bool> painted_{false};
  mutable std::once_flag once_;
  mutable std::vector<textplane::Image<std::uint8_t>> levels_;
};

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_TEXTURE_HPP
