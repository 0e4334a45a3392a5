#include "textslam/map/text_zncc.hpp"

#include <cmath>
#include <vector>

#include "textplane/geometry/homography.hpp"
#include "textplane/photometry/sample.hpp"
#include "textplane/photometry/zncc.hpp"
#include "textslam/input/noise_filter.hpp"

namespace textslam {
namespace {

double contrast_of(const std::vector<float>& intensities) {
  const auto stats = textplane::intensity_stats(intensities.data(), nullptr, static_cast<int>(intensities.size()));
  return textplane::is_ok(stats.status) ? stats.s / std::sqrt(stats.n) : 0;
}

}  // namespace

double text_zncc_limit(const Parameters& parameters, double limit, const textplane::TextPatch& patch, int level,
                       const Vec3& theta, const Frame& host, const Frame& frame, const SE3d& T_t_h,
                       const Pinhole<double>& camera) {
  if (!is_noisy(parameters, host, frame)) return limit;
  const textplane::PatchLevel& pixels = patch.levels[static_cast<std::size_t>(level)];
  const Pinhole<double> at_level = camera.at_level(level);
  const Eigen::Matrix3d H =
      textplane::pixel_homography<double>(textplane::plane_homography(theta, T_t_h), at_level, at_level);
  std::vector<float> seen;
  for (std::size_t i = 0; i < pixels.x.size(); ++i) {
    const Vec3 q = H * Vec3(static_cast<double>(pixels.x[i]), static_cast<double>(pixels.y[i]), 1);
    float value = 0;
    if (q.z() > 1e-6 && textplane::sample_bilinear(frame.image->level(level), static_cast<float>(q.x() / q.z()),
                                                   static_cast<float>(q.y() / q.z()), &value))
      seen.push_back(value);
  }
  return zncc_limit(parameters, limit, level, host, contrast_of(pixels.intensity), frame, contrast_of(seen));
}

}  // namespace textslam
