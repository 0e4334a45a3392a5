// The texts of the map as a camera at T_c_w (world to camera) sees them, and the map's points as the library asks for
// them. How a text looks is the library's (textplane/landmarks/text_view.hpp), which knows no map.
#ifndef TEXTSLAM_MAP_TEXT_VIEWS_HPP
#define TEXTSLAM_MAP_TEXT_VIEWS_HPP

#include "textplane/landmarks/text_view.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// World positions of the corners of a text that has a plane.
inline std::array<Vec3, 4> world_corners(const Map& map, const TextObject& text) {
  std::array<Vec3, 4> corners = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  textplane::text_corners(text, &corners);
  const SE3d& T_w_h = map.keyframe(text.host).T_w_c;
  for (Vec3& corner : corners) corner = T_w_h * corner;
  return corners;
}

/// The text's quad as seen by the camera; false where a corner is behind it, or beyond what its lens sees.
inline bool project_text(const Map& map, const TextObject& text, const SE3d& T_c_w, Quad<double>* quad) {
  return textplane::project_text(text, map.T_c_h(T_c_w, text.host), map.camera, quad);
}

/// The text's quad in its host's image.
inline Quad<double> host_quad(const Map& map, const TextObject& text) {
  if (!map.camera.lens) return text.patch.quad;
  Quad<double> quad;
  for (std::size_t i = 0; i < 4; ++i)
    quad.corner[i] = map.camera.pixel(text.patch.camera.unproject(text.patch.quad.corner[i]).head<2>());
  return quad;
}

/// Cosine of the angle between the text's normal and the ray to its centre; positive where the camera sees its front.
inline double facing(const Map& map, const TextObject& text, const SE3d& T_c_w) {
  return textplane::facing(text, map.T_c_h(T_c_w, text.host));
}

/// The map points for the surface of a text (textplane/landmarks/text_surface.hpp), seen to `sigma` px.
struct SurfacePoints {
  const Map& map;
  double sigma;

  int text_point_count() const { return static_cast<int>(map.points.size()); }
  bool text_point(int i, Vec3* p_w) const {
    *p_w = map.point(i).p_w;
    return !map.point(i).bad;
  }
  /// By the point's observations; not positive where they do not tell.
  double text_point_variance(int i, const Vec3& direction_w) const {
    const MapPoint& point = map.point(i);
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (const PointObservation& o : point.observations) {
      const KeyFrame& keyframe = map.keyframe(o.keyframe);
      if (keyframe.culled) continue;
      const SE3d T_c_w = keyframe.T_w_c.inverse();
      const Vec3 p = T_c_w * point.p_w;
      if (!map.camera.in_domain(p)) continue;
      Eigen::Matrix<double, 2, 3> J;
      map.camera.project(p, &J);
      const Eigen::Matrix<double, 2, 3> J_w = J * T_c_w.R / sigma;
      information += J_w.transpose() * J_w;
    }
    const textplane::Ldlt<double, 3> factors(information);
    return factors.ok() ? direction_w.dot(factors.solve(direction_w)) : 0;
  }
};

}  // namespace textslam

#endif  // TEXTSLAM_MAP_TEXT_VIEWS_HPP
