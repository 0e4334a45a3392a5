#include "textslam/map/text_geometry.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/geometry/homography.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/photometry/photometric_input.hpp"

namespace textslam {

bool project_text(const Map& map, const TextObject& text, const SE3d& T_c_w, Quad<double>* quad) {
  const Eigen::Matrix3d H = textplane::plane_homography(text.theta, map.T_c_h(T_c_w, text.host));
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 q = H * map.camera.unproject(text.patch.quad.corner[i]);
    if (!(q.z() > 1e-6)) return false;
    quad->corner[i] = map.camera.pixel(Vec2(q.x() / q.z(), q.y() / q.z()));
  }
  return true;
}

double facing(const Map& map, const TextObject& text, const SE3d& T_c_w) {
  const SE3d T_c_h = map.T_c_h(T_c_w, text.host);
  const Vec3 centre_px = map.camera.unproject(textplane::centroid(text.patch.quad));
  const Vec3 centre = T_c_h * textplane::plane_point(text.theta, centre_px);
  const Vec3 normal = T_c_h.R * textplane::plane_normal(text.theta);
  return -normal.dot(centre.normalized());
}

bool is_too_slanted(const Parameters& parameters, double facing) {
  return facing < std::cos(radians(parameters.text_max_slant));
}

bool is_in_view(const Map& map, const Parameters& parameters, const TextObject& text, const SE3d& T_c_w,
                double min_area, double min_share, Quad<double>* quad) {
  if (!project_text(map, text, T_c_w, quad) || is_too_slanted(parameters, facing(map, text, T_c_w))) return false;
  const double whole = std::abs(textplane::area(*quad));
  if (whole < min_area) return false;
  if (min_share >= 1) return textplane::inside_image(*quad, map.width, map.height, parameters.text_seen_border);
  return textplane::area(textplane::clip_to_image(*quad, map.width, map.height)) >= min_share * whole;
}

bool text_in_view(const Map& map, const Parameters& parameters, const TextObject& text, const SE3d& T_c_w,
                  Quad<double>* quad) {
  return is_in_view(map, parameters, text, T_c_w, parameters.text_min_area, parameters.text_min_share, quad);
}

bool is_plausible_plane(const Map& map, const Parameters& parameters, const Quad<double>& quad, const Vec3& theta) {
  const Vec3 ray = map.camera.unproject(textplane::centroid(quad)).normalized();
  if (is_too_slanted(parameters, -textplane::plane_normal(theta).dot(ray))) return false;
  return std::all_of(quad.corner.begin(), quad.corner.end(), [&](const Vec2& corner) {
    return textplane::inverse_depth(theta, map.camera.unproject(corner)) > 0;
  });
}

int scale_shift(const TextObject& text, const Quad<double>& quad) {
  return textplane::scale_shift(std::abs(textplane::area(text.patch.quad)), std::abs(textplane::area(quad)));
}

double normal_sigma(const TextObject& text) {
  const Vec3 n = textplane::plane_normal(text.theta);
  const Eigen::Matrix3d J = (Eigen::Matrix3d::Identity() - n * n.transpose()) / text.theta.norm();
  const Eigen::Matrix3d covariance = J * text.covariance * J.transpose();
  return std::sqrt(std::max(0.0, textplane::symmetric_eigen<double, 3>(covariance).values[2]));
}

}  // namespace textslam
