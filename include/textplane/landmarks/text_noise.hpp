// What ZNCC a view has to reach, by the noise of the images: limits are for clear ones.
#ifndef TEXTPLANE_LANDMARKS_TEXT_NOISE_HPP
#define TEXTPLANE_LANDMARKS_TEXT_NOISE_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "textplane/geometry/homography.hpp"
#include "textplane/landmarks/keyframe.hpp"
#include "textplane/landmarks/text_options.hpp"
#include "textplane/photometry/noise.hpp"
#include "textplane/photometry/patch.hpp"
#include "textplane/photometry/sample.hpp"
#include "textplane/photometry/zncc.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// The standard deviation of a pixel's noise on a pyramid level: halving takes half of white noise, and less of noise
/// that was smoothed.
inline double noise_on_level(const ImageNoise& image, int level) noexcept {
  constexpr double kFourPi = 12.566370614359172;
  // A Gaussian of variance v leaves 1 / (4 pi v) of the variance of white noise, the mean of n pixels 1 / n; one after
  // the other about the inverse of the sum.
  const double left = (std::max)(1.0, kFourPi * image.smoothing);
  return image.noise * std::sqrt(left / (left + std::ldexp(1.0, 2 * level) - 1));
}

/// Whether either image has more than clear_noise.
inline bool is_noisy(const TextOptions& options, const ImageNoise& a, const ImageNoise& b) noexcept {
  return (std::max)(a.noise, b.noise) > options.clear_noise;
}

/// The limit of the ZNCC for two images of one thing, with the standard deviations of its intensities in both: `limit`
/// times the ZNCC that noise beyond clear_noise leaves (expected_zncc()), at least least_expected_zncc of it.
inline double zncc_limit(const TextOptions& options, double limit, int level, const ImageNoise& a, double contrast_a,
                         const ImageNoise& b, double contrast_b) noexcept {
  if (!is_noisy(options, a, b)) return limit;
  const auto excess = [&](const ImageNoise& image) {
    const double noise = noise_on_level(image, level), clear = std::ldexp(options.clear_noise, -level);
    return std::sqrt((std::max)(0.0, noise * noise - clear * clear));
  };
  const double expected = expected_zncc(contrast_a, excess(a), contrast_b, excess(b));
  return limit * (std::max)(options.least_expected_zncc, expected);
}

/// The same for one level of a text's patch, by the contrasts that its pixels have in host and target.
TEXTPLANE_DEFERRED
double text_zncc_limit(const TextOptions& options, double limit, const TextPatch& patch, int level,
                       const Vector3<double>& theta, const TextImage& host, const TextImage& target,
                       const SE3d& T_t_h) {
  if (!is_noisy(options, host, target)) return limit;
  const auto contrast_of = [](const std::vector<float>& intensities) {
    const auto stats = intensity_stats(intensities.data(), nullptr, static_cast<int>(intensities.size()));
    return is_ok(stats.status) ? stats.s / std::sqrt(stats.n) : 0;
  };
  const PatchLevel& pixels = patch.levels[static_cast<std::size_t>(level)];
  const Matrix3<Real> H = plane_homography(theta, T_t_h);
  const Pinhole<Real> from = patch.camera.at_level(level);
  const CameraView to = target.camera.at_level(level);
  std::vector<float> seen;
  for (std::size_t i = 0; i < pixels.x.size(); ++i) {
    const Vector3<Real> q = H * from.unproject({static_cast<double>(pixels.x[i]), static_cast<double>(pixels.y[i])});
    if (!(q.z() > 1e-6) || !to.in_domain(q)) continue;
    const Vector2<Real> px = to.pixel({q.x() / q.z(), q.y() / q.z()});
    float value = 0;
    if (sample_bilinear(target.pyramid.level[static_cast<std::size_t>(level)], static_cast<float>(px.x()),
                        static_cast<float>(px.y()), &value))
      seen.push_back(value);
  }
  return zncc_limit(options, limit, level, host, contrast_of(pixels.intensity), target, contrast_of(seen));
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_NOISE_HPP
