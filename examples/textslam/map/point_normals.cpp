#include "textslam/map/point_normals.hpp"

#include <vector>

#include "textslam/common/wide_view.hpp"
#include "textslam/map/observations.hpp"

namespace textslam {
namespace {

struct Seen {
  int point;
  Vec2 px;
  Vec3 direction;  // unit, in the camera
  double inverse_distance;
};

// Normal in the camera, away from it. The plane is n . p = n . p_at; with t = direction of `at` + B a, where B spans
// the plane across it, t . d is the inverse distance along d as a multiple of that of `at`: linear in a.
Vec3 fit_normal(const Seen& at, const std::vector<const Seen*>& neighbours, const Parameters& parameters) {
  constexpr int kRounds = 4;
  constexpr double kTukey2 = 20;  // squared: beyond 4.5 sigma a neighbour has no weight
  const Vec3 across = at.direction.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> B;
  B << across, at.direction.cross(across);
  const double information = 1 / (parameters.normal_relief * parameters.normal_relief);
  Vec2 a = Vec2::Zero();
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix2d H = Eigen::Matrix2d::Identity() / (parameters.normal_slope * parameters.normal_slope);
    Vec2 b = Vec2::Zero();
    for (const Seen* n : neighbours) {
      const Vec2 row = B.transpose() * n->direction;
      const double facing = n->inverse_distance / at.inverse_distance - at.direction.dot(n->direction);
      const double r2 = information * (facing - row.dot(a)) * (facing - row.dot(a)), left = 1 - r2 / kTukey2;
      // In the first round a is a guess, which many may be far from.
      const double weight = information * (round == 0 ? 1 / (1 + r2) : left > 0 ? left * left : 0);
      H += weight * row * row.transpose();
      b += weight * facing * row;
    }
    const double det = H(0, 0) * H(1, 1) - H(0, 1) * H(1, 0);
    a = {(H(1, 1) * b[0] - H(0, 1) * b[1]) / det, (H(0, 0) * b[1] - H(1, 0) * b[0]) / det};
  }
  return (at.direction + B * a).normalized();
}

}  // namespace

void fit_point_normals(Map& map, const Parameters& parameters, int keyframe) {
  if (!is_wide(map.camera, map.width, map.height, parameters)) return;
  const KeyFrame& view = map.keyframe(keyframe);
  const SE3d T_c_w = view.T_w_c.inverse();
  std::vector<Seen> all;
  for (const int id : view.points) {
    const Vec2* const px = observed_in(map.point(id).observations, keyframe);
    const Vec3 p = T_c_w * map.point(id).p_w;
    if (px && map.camera.in_domain(p)) all.push_back({id, *px, p.normalized(), 1 / p.norm()});
  }
  std::vector<const Seen*> neighbours;
  for (const Seen& at : all) {
    neighbours.clear();
    for (const Seen& other : all)
      if (other.point != at.point && (other.px - at.px).norm() <= parameters.normal_reach) neighbours.push_back(&other);
    map.point(at.point).normal_w = view.T_w_c.R * fit_normal(at, neighbours, parameters);
  }
}

}  // namespace textslam
