#include "textslam/map/map.hpp"

#include <cmath>

#include "textplane/geometry/homography.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/photometry/residual_types.hpp"
#include "textslam/text/text_words.hpp"

namespace textslam {

std::string TextObject::word() const { return consensus(votes); }

double degrees(const Eigen::Matrix3d& R) { return textplane::so3_log<double>(R).norm() * 180 / M_PI; }

double degrees_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI; }

std::vector<int> spread(const std::vector<int>& ids, std::size_t count) {
  if (ids.size() <= count || count < 2) return ids;
  std::vector<int> picked;
  for (std::size_t i = 0; i < count; ++i) picked.push_back(ids[i * (ids.size() - 1) / (count - 1)]);
  return picked;
}

bool project_text(const Map& map, const TextObject& text, const SE3d& T_c_w, Quad<double>* quad) {
  const Eigen::Matrix3d H = textplane::plane_homography(text.theta, map.T_c_h(T_c_w, text.host));
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 q = H * map.camera.unproject(text.patch.quad.corner[i]);
    if (!(q.z() > 1e-6)) return false;
    quad->corner[i] = map.camera.pixel(Vec2(q.x() / q.z(), q.y() / q.z()));
  }
  return true;
}

bool text_in_view(const Map& map, const Parameters& parameters, const TextObject& text, const SE3d& T_c_w,
                  Quad<double>* quad) {
  if (!project_text(map, text, T_c_w, quad)) return false;
  if (facing(map, text, T_c_w) < std::cos(parameters.text_max_slant * M_PI / 180)) return false;
  const double whole = std::abs(textplane::area(*quad));
  const double seen = textplane::area(textplane::clip_to_image(*quad, map.width, map.height));
  return !(whole < parameters.text_min_area || seen < parameters.text_min_share * whole);
}

int scale_shift(const TextObject& text, const Quad<double>& quad) {
  return textplane::scale_shift(std::abs(textplane::area(text.patch.quad)), std::abs(textplane::area(quad)));
}

double facing(const Map& map, const TextObject& text, const SE3d& T_c_w) {
  const SE3d T_c_h = map.T_c_h(T_c_w, text.host);
  const Vec3 centre_px = map.camera.unproject(textplane::centroid(text.patch.quad));
  const Vec3 centre = T_c_h * textplane::plane_point(text.theta, centre_px);
  const Vec3 normal = T_c_h.R * textplane::plane_normal(text.theta);
  return -normal.dot(centre.normalized());
}

double normal_sigma(const TextObject& text) {
  const Vec3 n = textplane::plane_normal(text.theta);
  const Eigen::Matrix3d J = (Eigen::Matrix3d::Identity() - n * n.transpose()) / text.theta.norm();
  const Eigen::Matrix3d covariance = J * text.covariance * J.transpose();
  return std::sqrt(std::max(0.0, textplane::symmetric_eigen<double, 3>(covariance).values[2]));
}

void drop(TextObject& text) {
  text.state = TextState::dropped;
  text.patch = textplane::TextPatch();
  std::vector<int>().swap(text.targets);
  text.votes.clear();
}

}  // namespace textslam
