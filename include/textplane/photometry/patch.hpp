// TextPatch: the pixels of a text object in its host image, on every pyramid level.
#ifndef TEXTPLANE_PHOTOMETRY_PATCH_HPP
#define TEXTPLANE_PHOTOMETRY_PATCH_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/core/camera.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/photometry/pyramid.hpp"
#include "textplane/photometry/sample.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// n host pixels of one pyramid level, as arrays that somebody else owns: positions in px of that level, intensities there,
/// and optionally a byte each that is zero for pixels to be left out (null: all count).
struct PatchView {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* intensity = nullptr;
  const std::uint8_t* mask = nullptr;
  int n = 0;
};

/// The host pixels of one pyramid level. The three arrays have one length.
struct PatchLevel {
  std::vector<float> x, y, intensity;

  /// Valid until the vectors change.
  PatchView view() const noexcept {
    return {x.data(), y.data(), intensity.data(), nullptr, static_cast<int>(x.size())};
  }
};

/// The host side of a text object. It holds all that a target image is compared with: the host image may go.
struct TextPatch {
  std::vector<PatchLevel> levels;            ///< Finest first.
  Quad<double> quad;                         ///< px of level 0, clockwise from the text's top left.
  Pinhole<double> camera;                    ///< Of the host, level 0.
  Status status = Status::invalid_argument;  ///< Of its making.

  int level_count() const noexcept { return static_cast<int>(levels.size()); }
  /// Pixels of the level that has most.
  int max_pixels() const noexcept {
    std::size_t most = 0;
    for (const PatchLevel& level : levels) most = level.x.size() > most ? level.x.size() : most;
    return static_cast<int>(most);
  }
};

/// The patch of given pixels: pixels[l] holds positions in px of level l, integer or not, where the host is sampled
/// bilinearly. Positions outside the image and NaN are dropped. Levels beyond those of `host` are ignored.
///
/// Status::too_few where no level has `min_pixels` (the paper's 15) left, non_finite for a NaN quad, invalid_argument for an
/// empty pyramid, no pixel lists or a camera that is not valid(). Allocates.
inline TextPatch patch_from_pixels(const PyramidView& host, const Pinhole<double>& camera, const Quad<double>& quad,
                                   const std::vector<std::vector<Vector2<float>>>& pixels, int min_pixels = 15) {
  TextPatch patch;
  patch.quad = quad;
  patch.camera = camera;
  const int levels = std::min({host.levels, kMaxPyramidLevels, static_cast<int>(pixels.size())});
  if (levels < 1 || !camera.valid()) return patch;
  if (!all_finite(quad)) {
    patch.status = Status::non_finite;
    return patch;
  }

  patch.levels.resize(static_cast<std::size_t>(levels));
  std::size_t most = 0;
  for (std::size_t l = 0; l < patch.levels.size(); ++l) {
    PatchLevel& level = patch.levels[l];
    level.x.reserve(pixels[l].size());
    level.y.reserve(pixels[l].size());
    level.intensity.reserve(pixels[l].size());
    for (const Vector2<float>& px : pixels[l]) {
      float value;
      if (!sample_bilinear(host.level[l], px[0], px[1], &value)) continue;
      level.x.push_back(px[0]);
      level.y.push_back(px[1]);
      level.intensity.push_back(value);
    }
    most = std::max(most, level.x.size());
  }
  patch.status = static_cast<int>(most) < std::max(min_pixels, 1) ? Status::too_few : Status::ok;
  return patch;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_PATCH_HPP
