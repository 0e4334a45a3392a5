// Descriptors: what a corner looks like, in 256 bits that hardly depend on roll and brightness.
//
// Rotated BRIEF (Calonder et al., ECCV 2010; Rublee et al., ICCV 2011): each bit compares two pixels of a smoothed
// image, at places drawn once around the corner and turned with it; its direction is that to the centroid of the
// brightness around it. Sizes between two pyramid levels are reached by stretching the pattern.
#ifndef TEXTSLAM_RELOCALISE_DESCRIPTORS_HPP
#define TEXTSLAM_RELOCALISE_DESCRIPTORS_HPP

#include <array>
#include <cstdint>
#include <vector>

#include "textslam/common/geometry.hpp"
#include "textslam/input/frame.hpp"

namespace textslam {

constexpr int kDescriptorBits = 256;

struct Descriptor {
  std::array<std::uint64_t, kDescriptorBits / 64> bits{};
  float angle = 0;  ///< Of its direction, radians.
};

/// Bits that differ.
int bits_apart(const Descriptor& a, const Descriptor& b);

/// The levels of a pyramid, smoothed: what descriptors are read from.
class SmoothedLevels {
 public:
  /// At most `levels` of them.
  SmoothedLevels(const Pyramid& image, int levels);

  int levels() const { return static_cast<int>(levels_.size()); }

  /// Describes what is around `px` (level 0) at `size` px of level 0 a pixel of the pattern, at least 1. False where
  /// the pattern leaves the image, or no level is so coarse.
  bool describe(const Vec2f& px, double size, Descriptor* out) const;

 private:
  std::vector<textplane::Image<std::uint8_t>> levels_;
};

}  // namespace textslam

#endif  // TEXTSLAM_RELOCALISE_DESCRIPTORS_HPP
