#include "textslam/adjust/readout.hpp"

#include "textplane/core/robust.hpp"
#include "textslam/map/observations.hpp"

namespace textslam {

ReadoutSlope readout_slope(const Map& map, const Parameters& parameters) {
  const textplane::Robust robust{textplane::RobustKind::huber, std::sqrt(parameters.outlier_chi2)};
  const double information = 1 / (parameters.window_point_sigma * parameters.window_point_sigma);
  ReadoutSlope out;
  for (const int id : map.keyframe_ids()) {
    const auto& rows = map.keyframe(id).frame.rows;
    if (!rows) continue;
    const Vec3 v = rows->velocity.head<3>(), omega = rows->velocity.tail<3>();
    for (const int point : map.keyframe(id).points) {
      const Vec2* const seen = observed_in(map.point(point).observations, id);
      if (!seen) continue;
      const Vec3 p = map.T_c_w_at(id, *seen) * map.point(point).p_w;
      if (!map.camera.in_domain(p)) continue;
      Eigen::Matrix<double, 2, 3> J;
      const Vec2 e = map.camera.project(p, &J) - *seen;
      const double share = (seen->y() - map.shutter.row0) / (map.shutter.rows - 1);
      const Vec2 d = share * (J * (v + omega.cross(p)));
      const double chi2 = information * e.squaredNorm(), weight = information * robust.weight(chi2);
      out.slope += weight * e.dot(d);
      // The cost of an outlier does not bend: a wrong point close to the camera would have nearly all of the curvature.
      if (chi2 <= parameters.outlier_chi2) out.curvature += weight * d.squaredNorm();
    }
  }
  return out;
}

}  // namespace textslam
