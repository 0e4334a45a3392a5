#include "textslam/text/text_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/geometry/quad_projection.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/text_geometry.hpp"

namespace textslam {
namespace {

constexpr double kMinPivot = 1e-12;  // a plane known much better in one direction than in another is still known

// Of a point by its observations, along a direction in the world; not positive where they do not tell.
double variance_along(const Map& map, const MapPoint& point, const Vec3& direction, double sigma_px) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const PointObservation& o : point.observations) {
    const KeyFrame& keyframe = map.keyframe(o.keyframe);
    if (keyframe.culled) continue;
    const SE3d T_c_w = keyframe.T_w_c.inverse();
    const Vec3 p = T_c_w * point.p_w;
    if (!(p.z() > 0)) continue;
    Eigen::Matrix<double, 2, 3> J;
    map.camera.project(p, &J);
    const Eigen::Matrix<double, 2, 3> J_w = J * T_c_w.R / sigma_px;
    information += J_w.transpose() * J_w;
  }
  const textplane::Ldlt<double, 3> factors(information);
  return factors.ok() ? direction.dot(factors.solve(direction)) : 0;
}

// Covariance of theta where the plane goes through a point and its normal is known to sigma, radians.
Eigen::Matrix3d turned_about(const Vec3& theta, const Vec3& point, double sigma) {
  const Vec3 n = textplane::plane_normal(theta), side = n.unitOrthogonal(), other = n.cross(side);
  const double distance = n.dot(point);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Vec3& turn : {side, other}) {
    const Vec3 d = sigma / distance * (turn - turn.dot(point) / distance * n);  // theta = n / (n^T point)
    covariance += d * d.transpose();
  }
  return covariance;
}

// Where a plane is known by a guess alone: its slant in radians, its distance as a share.
Eigen::Matrix3d guessed(const Vec3& theta, const Vec3& centre, double turn, double distance) {
  return turned_about(theta, centre, turn) + distance * distance * theta * theta.transpose();
}

// Is the surface beside a text the one that it is on? Then the surface, fitted without the text, goes through the
// text's centre and has its slant, as far as its points tell that. A sign that stands off its wall is likely to be
// turned, too.
bool lies_on(std::vector<SurfacePoint> points, const Vec3& centre, double length, const Parameters& parameters,
             const TextObject& text) {
  erase_if(points, [](const SurfacePoint& p) { return !(p.beside > 0); });
  Vec3 theta = text.theta;
  const double distance = 1 / theta.norm();
  Eigen::Matrix3d covariance = text.covariance + guessed(theta, centre, radians(parameters.surface_most_turn),
                                                         parameters.surface_near * length / distance);
  if (!fit_to_surface(points, centre, parameters, &theta, &covariance)) return false;
  const double gap = std::abs(theta.dot(centre) - 1) / theta.norm();
  const double gap_sigma = std::sqrt(centre.dot(text.covariance * centre)) / theta.norm();
  const double turn = degrees_between(textplane::plane_normal(theta), textplane::plane_normal(text.theta));
  TextObject surface;
  surface.theta = theta;
  surface.covariance = covariance;
  const double turn_sigma =
      std::hypot(normal_sigma(text) / radians(1), normal_sigma(surface) / radians(1), parameters.surface_bend);
  return gap <= parameters.surface_gap * length + parameters.surface_sigmas * gap_sigma &&
         turn <= parameters.surface_sigmas * turn_sigma;
}

}  // namespace

std::vector<SurfacePoint> points_beside(const Map& map, const Parameters& parameters, const TextObject& text) {
  std::vector<SurfacePoint> points;
  std::array<Vec3, 4> c;
  if (!textplane::is_ok(textplane::quad_points(text.patch.quad, map.camera, text.theta, &c))) return points;
  const Vec3 normal = textplane::plane_normal(text.theta), centre = 0.25 * (c[0] + c[1] + c[2] + c[3]);
  const Vec3 across = 0.5 * (c[1] - c[0] + c[2] - c[3]), down = 0.5 * (c[3] - c[0] + c[2] - c[1]);
  const Vec3 right = across.normalized(), below = normal.cross(right);
  const double reach = parameters.surface_reach * std::max(across.norm(), down.norm());

  const SE3d T_w_h = map.keyframe(text.host).T_w_c, T_h_w = T_w_h.inverse();
  for (const MapPoint& point : map.points) {
    if (point.bad) continue;
    const Vec3 p = T_h_w * point.p_w, offset = p - centre;
    const double beside = std::hypot(std::max(0.0, std::abs(right.dot(offset)) - 0.5 * across.norm()),
                                     std::max(0.0, std::abs(below.dot(offset)) - 0.5 * down.norm()));
    if (!(p.z() > 0) || !(beside <= reach) || !(std::abs(normal.dot(offset)) <= reach)) continue;
    const double variance = variance_along(map, point, T_w_h.R * normal, parameters.point_sigma);
    if (variance > 0)
      points.push_back({p, std::hypot(std::sqrt(variance), parameters.surface_relief * beside), beside});
  }
  return points;
}

bool fit_to_surface(const std::vector<SurfacePoint>& points, const Vec3& centre, const Parameters& parameters,
                    Vec3* theta, Eigen::Matrix3d* covariance) {
  const textplane::Ldlt<double, 3> prior(*covariance, kMinPivot);
  if (!prior.ok()) return false;
  const Eigen::Matrix3d known = prior.inverse();
  const Eigen::Matrix3d bend = turned_about(*theta, centre, radians(parameters.surface_bend));
  Vec3 x = *theta;
  Eigen::Matrix3d C = *covariance;
  const double sigmas = parameters.surface_sigmas;
  double used = 0;
  for (int round = 0; round < parameters.surface_rounds; ++round) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Vec3 gradient = Vec3::Zero();
    used = 0;
    for (const SurfacePoint& point : points) {
      const double error = 1 - x.dot(point.p), variance = x.squaredNorm() * point.sigma * point.sigma;
      const double squared = error * error / (sigmas * sigmas * (variance + point.p.dot(C * point.p)));
      if (!(squared < 1)) continue;
      const double weight = (1 - squared) * (1 - squared);
      information += weight / variance * point.p * point.p.transpose();
      gradient += weight / variance * error * point.p;
      used += weight;
    }
    // The bend is common to all points: (information^-1 + bend)^-1, in a form where neither need be regular.
    const Eigen::Matrix3d together = (Eigen::Matrix3d::Identity() + information * bend).inverse();
    const Eigen::Matrix3d both = known + together * information;
    const textplane::Ldlt<double, 3> system(0.5 * (both + both.transpose()), kMinPivot);
    if (!system.ok()) return false;
    x += system.solve(known * (*theta - x) + together * gradient);
    C = system.inverse();
  }
  if (!(used >= parameters.surface_min_points) || !textplane::all_finite(x) || !textplane::all_finite(C)) return false;
  *theta = x;
  *covariance = C;
  return true;
}

void fit_to_surface(const Map& map, const Parameters& parameters, TextObject& text) {
  const double sigma = normal_sigma(text);
  std::array<Vec3, 4> c;
  if (!(sigma <= radians(parameters.surface_text_sigma)) ||
      !textplane::is_ok(textplane::quad_points(text.patch.quad, map.camera, text.theta, &c)))
    return;
  const Vec3 centre = textplane::plane_point(text.theta, map.camera.unproject(textplane::centroid(text.patch.quad)));
  const double length = std::max((c[1] - c[0]).norm(), (c[3] - c[0]).norm());
  const std::vector<SurfacePoint> points = points_beside(map, parameters, text);
  Vec3 theta = text.theta;
  Eigen::Matrix3d covariance = text.covariance;
  if (!lies_on(points, centre, length, parameters, text) ||
      !fit_to_surface(points, centre, parameters, &theta, &covariance))
    return;
  const double turn = radians(degrees_between(textplane::plane_normal(theta), textplane::plane_normal(text.theta)));
  if (turn > parameters.surface_sigmas * std::hypot(sigma, radians(parameters.surface_bend))) return;
  text.theta = theta;
  text.covariance = covariance;
}

bool plane_from_surface(const Map& map, const Parameters& parameters, TextObject& text) {
  const auto& c = text.patch.quad.corner;
  const Vec2 middle = textplane::centroid(text.patch.quad);
  const double near = std::max((c[1] - c[0]).norm(), (c[3] - c[0]).norm());
  const SE3d T_h_w = map.keyframe(text.host).T_w_c.inverse();
  std::vector<double> depths;
  for (const int id : map.keyframe(text.host).points) {
    const Vec3 p = T_h_w * map.point(id).p_w;
    if (!map.point(id).bad && p.z() > 0 && (map.camera.project(p) - middle).norm() <= near) depths.push_back(p.z());
  }
  if (static_cast<double>(depths.size()) < parameters.surface_min_points) return false;

  // A guess: across the ray to the text, at the depth of what is seen there.
  const Vec3 ray = map.camera.unproject(middle), centre = median(depths) * ray;
  TextObject guess;
  guess.host = text.host;
  guess.patch.quad = text.patch.quad;
  guess.theta = centre / centre.squaredNorm();
  guess.covariance = guessed(guess.theta, centre, parameters.surface_guess_turn, parameters.surface_guess_depth);
  if (!fit_to_surface(points_beside(map, parameters, guess), centre, parameters, &guess.theta, &guess.covariance) ||
      !(normal_sigma(guess) <= radians(parameters.surface_max_sigma)))
    return false;
  text.theta = guess.theta;
  text.covariance = guess.covariance;
  return true;
}

}  // namespace textslam
