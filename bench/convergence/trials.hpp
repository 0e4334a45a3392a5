// Trials of convergence: a 100 x 40 patch in rendered scenes, and starts of an exact mean corner error, the same for
// every method.
#ifndef TEXTPLANE_BENCH_CONVERGENCE_TRIALS_HPP
#define TEXTPLANE_BENCH_CONVERGENCE_TRIALS_HPP

#include <vector>

#include "kernels/align.hpp"
#include "textplane/photometry/template_patch.hpp"

namespace textplane_bench {

/// Small print, large print, smooth blobs, and small print at a slant of 55 degrees and 0.8 of the host's scale.
enum class Kind { print, large_print, blobs, slanted_print };
constexpr Kind kKinds[] = {Kind::print, Kind::large_print, Kind::blobs, Kind::slanted_print};
inline const char* to_string(Kind kind) {
  constexpr const char* kNames[] = {"print", "large print", "blobs", "slanted print"};
  return kNames[static_cast<int>(kind)];
}

/// Two 640 x 480 images of a plane. Its texture is a formula, so no image is resampled. The target has another gain,
/// bias and noise. The patch is all pixels of a rectangle, on three levels.
struct Trials {
  static constexpr int kLevels = 3, kLeft = 270, kTop = 220, kColumns = 100, kRows = 40;

  explicit Trials(Kind kind);

  /// Host px to target px, level 0.
  tp::Matrix3<double> homography(const Start& s) const;
  /// Mean distance of the rectangle's corners under H from where they truly are, px.
  double corner_error(const tp::Matrix3<double>& H) const;
  /// A start with this corner error, in a random direction from the truth: of the pose, and with `tilt` of the plane
  /// too.
  Start start(double px, unsigned trial, bool tilt) const;

  tp::Image<std::uint8_t> host, target;
  tp::Pyramid host_pyramid, target_pyramid;
  tp::Pinhole<double> camera{500, 500, 320, 240};
  Start truth;
  tp::TextPatch patch;
  std::vector<tp::TemplatePatch> prepared;  ///< One for each level.
};

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_CONVERGENCE_TRIALS_HPP
