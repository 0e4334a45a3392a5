#include "textslam/text/text_centre.hpp"

#include <algorithm>
#include <cmath>

#include "textslam/map/text_views.hpp"

namespace textslam {
namespace {

// A box's corner errs by a pixel or two, and by a share of the letters' height: detectors differ in where a letter
// ends.
constexpr double kCornerPx = 1.5, kCornerShare = 0.06;

Vec3 centre_in_host(const TextObject& text) {
  const Vec3 ray = text.patch.camera.unproject(textplane::centroid(text.patch.quad));
  return ray / text.theta.dot(ray);
}

}  // namespace

double distance_sigma(const TextObject& text) {
  const Vec3 p = centre_in_host(text);  // dp = -p (p . dtheta)
  return std::sqrt(std::max(0.0, p.dot(text.covariance * p)));
}

TextCentre text_centre(const Map& map, const TextObject& text) {
  TextCentre centre;
  const std::array<Vec3, 4> c = world_corners(map, text);
  centre.at = (c[0] + c[1] + c[2] + c[3]) / 4;
  const Vec3 p = centre.in_host = centre_in_host(text);
  const auto& q = text.patch.quad.corner;
  centre.corner_px = std::max(kCornerPx, kCornerShare * 0.5 * (q[2] + q[3] - q[0] - q[1]).norm());
  const double aside = centre.corner_px / text.patch.camera.fx * p.z(), ahead = distance_sigma(text) * p.norm();
  const Eigen::Matrix3d& R_w_h = map.keyframe(text.host).T_w_c.R;
  const Vec3 to = p.normalized();
  const Eigen::Matrix3d along = to * to.transpose();
  centre.covariance =
      R_w_h * (ahead * ahead * along + aside * aside * (Eigen::Matrix3d::Identity() - along)) * R_w_h.transpose();
  return centre;
}

}  // namespace textslam
